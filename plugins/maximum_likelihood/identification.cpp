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
  return id.variance_known && as_expected && id.spectra.outputs() == 1 ? CovarianceKind::information : CovarianceKind::residuals;
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
  id.test = cost_test(id.spectra, id.fit);
  id.criteria = criteria(id.spectra, id.fit);
  id.covariance_kind = kind_for(id);
  auto root =
      covariance_root(id.fit.lines, id.fit.structure, id.fit.minimum.estimate, id.covariance_kind, id.spectra.degrees_of_freedom);
  if (root && root->allFinite()) {
    id.covariance_root = std::move(*root);
  } else {
    id.no_covariance = root ? "its numbers are not finite" : root.error().text;
  }
  const Eigen::MatrixXcd error = id.spectra.response() - id.fit.response;
  for (Eigen::Index i = 0; i < error.cols(); ++i) id.whiteness.push_back(whiteness(error.col(i)));
  return id;
}

}  // namespace bodeflow::maximum_likelihood
