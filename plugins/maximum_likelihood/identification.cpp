#include "identification.hpp"

#include <cmath>

namespace bodeflow::maximum_likelihood {

namespace {

constexpr double kAsExpected = 0.01;  // probability of the cost below which the variances do not explain the residuals

Eigen::Index numerator_order(const Settings& settings, std::size_t output, Eigen::Index order) {
  if (settings.numerator_orders.empty()) return settings.domain == Domain::s ? std::max<Eigen::Index>(order - 1, 0) : order;
  const Eigen::Index asked =
      settings.numerator_orders.size() == 1 ? settings.numerator_orders.front() : settings.numerator_orders[output];
  // While an order is sought, a numerator of given order does not exceed it.
  return asked < 0 ? std::max<Eigen::Index>(order + asked, 0) : settings.order ? asked : std::min(asked, order);
}

CovarianceKind kind_for(const Identification& id) {
  const bool as_expected = id.test.probability && *id.test.probability >= kAsExpected;
  if (id.fit.correlation.any()) return CovarianceKind::residuals;
  return id.variance_known && as_expected && id.spectra.outputs() == 1 ? CovarianceKind::information : CovarianceKind::residuals;
}

// The same with numerators of one order less; nothing where one has no order to give, or a coefficient of it is fixed.
std::optional<Structure> with_lower_numerators(const Structure& structure) {
  Structure lower = structure;
  for (Eigen::Index& order : lower.numerator_orders) {
    if (order-- == 0) return {};
  }
  for (const FixedCoefficient& c : structure.fixed) {
    if (!c.of_denominator && c.power > lower.numerator_orders[static_cast<std::size_t>(c.output)]) return {};
  }
  return lower;
}

// Takes numerators of lower order as long as none of the higher ones is significantly better, or notes where that could be done.
void weigh_numerator(const Settings& settings, Identification& id) {
  const Fit highest = id.fit;
  if (!settings.estimate_delay) return;
  Structure structure = highest.structure;
  structure.estimate_delay = true;
  while (const auto lower = with_lower_numerators(structure)) {
    auto fit = fit_model(id.spectra, *lower, settings.starts);
    if (!fit || chance_of_fall(id.spectra, *fit, highest) < kSignificantFall ||
        chance_of_fall(id.spectra, *fit, id.fit) < kSignificantFall)
      return;
    if (!settings.numerator_orders.empty()) {
      id.enough_numerator_orders = lower->numerator_orders;
      return;
    }
    id.fit = std::move(*fit);
    structure = *lower;
  }
}

// R, or why there is none: also where the coefficients' own covariance is not finite, or not positive.
void add_covariance(Identification& id) {
  const Fit& fit = id.fit;
  auto root = covariance_root(fit.lines, fit.structure, fit.minimum.estimate, id.covariance_kind, id.spectra.degrees_of_freedom,
                              fit.correlation);
  if (!root) {
    id.no_covariance = root.error().text;
    return;
  }
  for (std::size_t i = 0; i < fit.models.size(); ++i) {
    const Coefficients c = coefficients_of(fit.lines, fit.structure, fit.minimum.estimate, i, fit.models[i], *root);
    for (std::size_t p = 0; p < c.names.size() && id.no_covariance.empty(); ++p) {
      if (!std::isfinite(c.covariance(static_cast<Eigen::Index>(p), static_cast<Eigen::Index>(p))))
        id.no_covariance = "that of " + c.names[p] + " is not finite: lower the order, or the numerator order";
    }
  }
  if (id.no_covariance.empty()) id.covariance_root = std::move(*root);
}

Expected<void> check(const Settings& settings, const Spectra& spectra) {
  const auto given = static_cast<Eigen::Index>(settings.numerator_orders.size());
  if (given > 1 && given != spectra.outputs()) {
    return refused("numerator_order has " + std::to_string(given) + " values for " + std::to_string(spectra.outputs()) +
                   " outputs; allowed: one for all, or one each");
  }
  return {};
}

}  // namespace

Structure structure_for(const Settings& settings, const Spectra& spectra, Eigen::Index order) {
  Structure s;
  s.domain = settings.domain;
  s.order = order;
  for (std::size_t i = 0; i < static_cast<std::size_t>(spectra.outputs()); ++i)
    s.numerator_orders.push_back(numerator_order(settings, i, order));
  s.estimate_delay = settings.estimate_delay;
  s.delay_s = settings.delay_s;
  const auto range = settings.delay_range_s.value_or(std::pair(0.0, widest_delay(spectra)));
  s.delay_low_s = range.first;
  s.delay_high_s = range.second;
  s.fixed_poles = settings.fixed_poles;
  s.fixed = settings.fixed;
  s.zero_order_hold = settings.zero_order_hold;
  return s;
}

Expected<Identification> identify(const Spectra& spectra, const Settings& settings) {
  if (const auto fits = check(settings, spectra); !fits) return refusal_in(fits);
  Identification id;
  id.spectra =
      settings.weighting == Weighting::variance ? spectra : evenly_weighted(spectra, settings.weighting == Weighting::relative);
  id.variance_known = id.spectra.variance_known;
  if (const auto fits = check(id.spectra); !fits) return refusal_in(fits);
  if (settings.order) {
    auto fit = fit_model(id.spectra, structure_for(settings, id.spectra, *settings.order), settings.starts);
    if (!fit) return refusal_in(fit);
    id.fit = std::move(*fit);
  } else {
    const Eigen::Index lowest = std::max<Eigen::Index>(1, settings.fixed_poles.size());
    auto scan = scan_orders(
        id.spectra, [&](Eigen::Index order) { return structure_for(settings, id.spectra, order); }, lowest,
        std::max(lowest, settings.highest_order), settings.starts);
    if (!scan) return refusal_in(scan);
    id.fit = scan->orders[scan->chosen].fit;
    id.scan = std::move(*scan);
  }
  weigh_numerator(settings, id);
  id.test = cost_test(id.spectra, id.fit);
  id.criteria = criteria(id.spectra, id.fit);
  id.covariance_kind = kind_for(id);
  add_covariance(id);
  const Eigen::MatrixXcd error = id.spectra.response() - id.fit.response;
  for (Eigen::Index i = 0; i < error.cols(); ++i) id.whiteness.push_back(whiteness(error.col(i), id.spectra.correlated_lines));
  return id;
}

}  // namespace bodeflow::maximum_likelihood
