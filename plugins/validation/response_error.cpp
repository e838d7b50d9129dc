#include "response_error.hpp"

#include <bodeflow/numerics/polynomial.hpp>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "records/signals.hpp"

namespace bodeflow::validation {

using Complex = std::complex<double>;

Eigen::VectorXcd model_response(const records::ModelData& model, const Eigen::VectorXd& frequency_hz) {
  Eigen::VectorXcd g(frequency_hz.size());
  for (Eigen::Index k = 0; k < g.size(); ++k) {
    const Complex s(0.0, 2.0 * std::numbers::pi * frequency_hz[k]);
    const Complex x = model.sample_time_s > 0.0 ? std::exp(s * model.sample_time_s) : s;
    g[k] = numerics::evaluate(model.numerator, x) / numerics::evaluate(model.denominator, x) * std::exp(-s * model.delay_s);
  }
  return g;
}

Expected<ResponseError> response_error(const records::ResponseData& found, const records::ModelData& truth) {
  if (found.inputs() != 1 || found.outputs() != 1) {
    return unexpected("the response has " + std::to_string(found.inputs()) + " inputs and " + std::to_string(found.outputs()) +
                      " outputs; needed: one each");
  }
  const Eigen::VectorXd& f = found.frequency_hz;
  constexpr double kRounding = 1e-9;
  if (truth.sample_time_s > 0.0 && f.size() > 0 && f[f.size() - 1] * truth.sample_time_s > 0.5 * (1.0 + kRounding)) {
    return unexpected("the response goes to " + records::short_number(f[f.size() - 1]) +
                      " Hz, above half the sample rate of the true model");
  }
  const Eigen::VectorXcd g = model_response(truth, f);
  ResponseError e;
  e.relative.resize(f.size());
  double of_mean = 0.0, of_one_run = 0.0;
  const bool certain = found.variance.size() > 0;
  for (Eigen::Index k = 0; k < f.size(); ++k) {
    const double power = std::norm(g[k]);
    if (!(power > 0.0) || !std::isfinite(power))
      return unexpected("the true response at " + records::short_number(f[k]) + " Hz is " + (power > 0.0 ? "not finite" : "0"));
    const double square = std::norm(found.response(k, 0) - g[k]);
    e.relative[k] = std::sqrt(square / power);
    of_mean += square / power;
    if (certain) of_one_run += (square + found.variance(k, 0)) / power;
  }
  const auto lines = static_cast<double>(f.size());
  e.of_mean = std::sqrt(of_mean / lines);
  e.of_one_run = certain ? std::sqrt(of_one_run / lines) : std::numeric_limits<double>::quiet_NaN();
  return e;
}

}  // namespace bodeflow::validation
