#include "model_warnings.hpp"

#include <cmath>
#include <numbers>

#include "records/signals.hpp"

namespace bodeflow::maximum_likelihood {

namespace {

using records::counted;
using records::short_number;
using Texts = std::vector<std::string>;

constexpr double kImprobable = 0.001;
constexpr double kFewDegrees = 5.0;  // nu below: the variance of a line scatters by 45 % and more
constexpr double kInputNoise = 0.1;  // var U over |U|^2: 10 dB
constexpr double kSurely = 3.0;      // standard deviations

std::string rounded(double value) { return short_number(value, 3); }

std::string root_text(std::complex<double> x, const Structure& structure) {
  const std::string text = rounded(x.real()) + (x.imag() == 0.0 ? "" : " +- j " + rounded(std::abs(x.imag())));
  return structure.domain == Domain::s ? text + " rad/s" : "z = " + text;
}

void warn_of_variance(const Identification& id, const Measured& measured, Texts& warnings) {
  if (!measured.has_variance) {
    warnings.push_back(
        "the response has no variance: lines weigh alike relative to |G|, the covariance is that of the residuals, "
        "and the cost can't be tested; measure several periods, or weigh by `weighting: none`");
    return;
  }
  if (!id.variance_known) return;
  const double nu = id.spectra.degrees_of_freedom;
  if (nu < kFewDegrees) {
    warnings.push_back("the variances have only " + short_number(nu) + " degrees of freedom (" + short_number(nu + 1.0) +
                       " periods): lines weigh by chance" +
                       (nu > 2.0 ? "; the covariance is enlarged for it" : " and the cost has no finite deviation") +
                       "; measure at least 6 periods");
  }
  Eigen::Index line = 0;
  const double worst = id.spectra.input_variance.cwiseQuotient(id.spectra.input.cwiseAbs2()).maxCoeff(&line);
  if (worst > kInputNoise) {
    warnings.push_back("the input is less than 10 dB above its noise at " +
                       rounded(id.spectra.omega_rad_s[line] / (2.0 * std::numbers::pi)) +
                       " Hz: the covariance is too small there; excite more, or average more periods");
  }
}

void warn_of_cost(const Identification& id, Texts& warnings) {
  if (!id.test.probability || !id.variance_known) return;
  const std::string times = rounded(id.test.cost / id.test.expected) + " times what the noise explains";
  if (*id.test.probability < kImprobable) {
    warnings.push_back("the cost is " + times +
                       ": the data hold what the model does not (order, delay, nonlinear distortion, drift); see the record "
                       "`residual`; standard deviations do not hold this error");
  } else if (1.0 - *id.test.probability < kImprobable) {
    warnings.push_back("the cost is only " + times +
                       ": the variances are too large, or the noise of neighbouring lines is shared");
  }
}

void warn_of_residuals(const Identification& id, const Measured& measured, Texts& warnings) {
  for (std::size_t i = 0; i < id.whiteness.size(); ++i) {
    if (!id.whiteness[i] || !(id.whiteness[i]->probability < kImprobable)) continue;
    warnings.push_back("the residuals of '" + measured.output_names[i] + "' are not independent from line to line (probability " +
                       rounded(id.whiteness[i]->probability) +
                       "): dynamics that the model lacks, or a response that was smoothed; raise the order, or look at the "
                       "record `residual`");
  }
}

void warn_of_roots(const Identification& id, const Measured& measured, Texts& warnings) {
  for (const Cancellation& c : cancellations(id.fit, id.covariance_root)) {
    const std::string where = measured.output_names.size() > 1 ? " of '" + measured.output_names[c.output] + "'" : "";
    warnings.push_back("the pole " + root_text(c.pole, id.fit.structure) + " and the zero " +
                       root_text(c.zero, id.fit.structure) + where + " may cancel, within their uncertainty: lower the order");
  }
  for (const UnstablePole& p : unstable_poles(id.fit, id.covariance_root)) {
    const bool surely = p.deviations > kSurely;
    warnings.push_back("the pole " + root_text(p.pole, id.fit.structure) + " is unstable" +
                       (std::isfinite(p.deviations) ? ", by " + rounded(p.deviations) + " standard deviations" : "") +
                       (surely ? ": is the plant, or is the order too high, or an integrator not declared in `fixed_poles`?"
                               : ": it may be stable as well; declare an integrator in `fixed_poles`, or lower the order"));
  }
}

void warn_of_search(const Identification& id, Texts& warnings) {
  const Fit& fit = id.fit;
  if (!fit.minimum.converged)
    warnings.push_back("the search did not converge (" + fit.minimum.reason + "): lower the order, or narrow the band");
  if (fit.delay_at_bound) {
    warnings.push_back("the delay is at the end of its range, " + rounded(fit.structure.delay_s) +
                       " s: widen `delay_range`, or give `delay: 0`");
  }
  if (id.enough_numerator_orders) {
    const std::string highest = "b" + std::to_string(fit.structure.numerator_orders.front());
    const std::string orders = std::to_string(id.enough_numerator_orders->front());
    warnings.push_back("the data do not tell " + highest + " from the delay: a numerator of order " + orders +
                       " explains them as well; standard deviations of delay and " + highest +
                       " are not to be relied on; give `numerator_order: " + orders + "`, leave it out, or give the delay");
  }
  if (!id.no_covariance.empty()) warnings.push_back("the model has no covariance: " + id.no_covariance);
  if (id.scan && id.scan->still_falls) {
    warnings.push_back("the cost still falls at order " + std::to_string(id.scan->orders.back().fit.structure.order) +
                       ", the highest tried: raise `highest_order`, narrow the band, or give the order (see `order_scan`)");
  }
}

}  // namespace

std::vector<std::string> model_warnings(const Identification& id, const Measured& measured) {
  Texts warnings;
  warn_of_variance(id, measured, warnings);
  warn_of_cost(id, warnings);
  warn_of_residuals(id, measured, warnings);
  warn_of_search(id, warnings);
  warn_of_roots(id, measured, warnings);
  return warnings;
}

}  // namespace bodeflow::maximum_likelihood
