#include <bodeflow/numerics/chi_squared.hpp>
#include <cmath>

#include "motor_record.hpp"
#include "records/signals.hpp"

namespace bodeflow::frisch {
namespace {

using records::short_number;

// Probability below which chance does not explain what was found.
constexpr double kUnlikely = 0.001;
// Relative standard deviation from which a parameter is hardly determined.
constexpr double kVague = 0.3;
// Power of the input over its noise, of the mean: below it Y/U is no longer normal and the fit is biased.
constexpr double kClear = 10.0;

std::string of_cost(const MotorFit& fit, double lines) {
  if (!std::isfinite(fit.expected_cost)) return {};
  const double p = numerics::chi_squared_tail(2.0 * fit.cost, 2.0 * lines - MotorModel::kParameters);
  if (p >= kUnlikely) return {};
  return "the cost is " + short_number(fit.cost, 4) + " where noise alone gives " + short_number(fit.expected_cost, 4) +
         ": the motor has something that the model lacks (delay, dead time, saturation, skin effect), and the parameters have "
         "taken part of it; look at the residual, check hold and delay, or measure at another amplitude";
}

std::string of_method(Method method) {
  if (method == Method::frisch) {
    return "the Frisch scheme underestimates the noise, and sigma comes out several percent low where the current is noisy; with "
           "repeated periods use method: maximum_likelihood";
  }
  if (method == Method::none) {
    return "without correction the noise of the current enters the response: sigma comes out low and gamma high; use method: "
           "maximum_likelihood, or frisch";
  }
  return {};
}

void add_vague(const MotorFit& fit, std::vector<std::string>& all) {
  const Eigen::Array4d relative = fit.covariance.diagonal().array().sqrt() / fit.model.vector().array();
  for (Eigen::Index i = 0; i < MotorModel::kParameters; ++i) {
    if (relative[i] < kVague) continue;
    all.push_back(motor_parameter_names()[static_cast<std::size_t>(i)] + " is known to " + short_number(100.0 * relative[i], 2) +
                  " % only; measure longer, at a larger amplitude, or with lines nearer its corner frequency");
  }
}

void add_of_band(const Band& b, Method method, std::vector<std::string>& all) {
  if (method == Method::maximum_likelihood && noise_flatness(b) < kUnlikely) {
    all.push_back(
        "the noise in the band of " + b.range() +
        " differs from line to line, and it is pooled over them: look for hum or disturbances at single lines, and leave "
        "those out by spectrum's `lines`");
  }
  Eigen::Index weak = 0;
  for (Eigen::Index k = 0; k < b.mean.lines(); ++k) {
    if (std::norm(b.mean.input[k]) < kClear * b.mean.input_variance[k]) ++weak;
  }
  if (weak > 0) {
    all.push_back(records::counted(weak, "line") + " of the band of " + b.range() +
                  " hardly stand above the noise of the input; raise the amplitude or average more periods");
  }
}

}  // namespace

std::vector<std::string> motor_warnings(const MotorEstimate& e, const MotorContext& c) {
  std::vector<std::string> all;
  const auto add = [&](std::string text) {
    if (!text.empty()) all.push_back(std::move(text));
  };
  if (!e.fit.converged) add("the search ended without converging (" + e.fit.reason + "); do not use the parameters");
  add(of_method(c.settings.method));
  add(of_cost(e.fit, static_cast<double>(e.omega.size())));
  add_vague(e.fit, all);
  for (const Band& b : c.bands) add_of_band(b, c.settings.method, all);
  if (c.input_is == "command" && c.settings.sampling.hold_s == 0.0) {
    add("the input is the command and `hold` is 0: half a step of the staircase then counts as leakage inductance; give the time "
        "of a step as `hold`");
  }
  return all;
}

}  // namespace bodeflow::frisch
