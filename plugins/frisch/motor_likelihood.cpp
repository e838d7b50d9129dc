#include <cmath>
#include <string>

#include "motor_fit.hpp"
#include "motor_search.hpp"

namespace bodeflow::frisch {

namespace {

using Complex = std::complex<double>;

Expected<void> check(const MeanSpectra& s) {
  const Eigen::Index lines = s.lines();
  for (const Eigen::Index size :
       {s.input.size(), s.output.size(), s.input_variance.size(), s.output_variance.size(), s.covariance.size()}) {
    if (size != lines) return refused("the mean spectra differ in their number of lines");
  }
  if (lines < 3) return refused("the fit needs at least 3 lines; found " + std::to_string(lines));
  for (Eigen::Index k = 0; k < lines; ++k) {
    const double u = s.input_variance[k], y = s.output_variance[k];
    const std::string line = "line " + std::to_string(k) + " of the spectra";
    if (!(u >= 0.0) || !(y >= 0.0) || !(u + y > 0.0) || !std::isfinite(u + y)) {
      return refused(line + ": the noise variances must be finite, at least 0, and not both 0");
    }
    if (std::norm(s.covariance[k]) > u * y) return refused(line + ": the noise covariance exceeds what the variances allow");
    if (!(std::abs(s.input[k]) > 0.0)) return refused(line + ": the input is zero");
  }
  return {};
}

// (Y - G U) / sqrt(v) and its slope, v = var Y + |G|^2 var U - 2 Re(conj(G) cov(Y, U)).
LineResidual residual(const MeanSpectra& s, const MotorModel& m, Eigen::Index k) {
  const ResponseSlope g = response_slope(m, s.omega[k]);
  const double v =
      s.output_variance[k] + std::norm(g.value) * s.input_variance[k] - 2.0 * (std::conj(g.value) * s.covariance[k]).real();
  const Complex error = s.output[k] - g.value * s.input[k];
  const Complex pull = g.value * s.input_variance[k] - s.covariance[k];  // half the slope of v: Re(conj(dG) pull)
  const double root = 1.0 / std::sqrt(v);
  LineResidual r;
  r.value = error * root;
  for (Eigen::Index i = 0; i < MotorModel::kParameters; ++i) {
    r.slope[i] = -root * (g.slope[i] * s.input[k] + error / v * (std::conj(g.slope[i]) * pull).real());
  }
  return r;
}

}  // namespace

Expected<MotorFit> fit_motor_likelihood(const MeanSpectra& spectra) {
  if (auto fine = check(spectra); !fine) return tl::make_unexpected(fine.error());
  const auto start = motor_start(spectra.omega, spectra.output.cwiseQuotient(spectra.input));
  if (!start) return tl::make_unexpected(start.error());
  const auto problem =
      motor_problem(spectra.lines(), [&](const MotorModel& m, Eigen::Index k) { return residual(spectra, m, k); });
  const auto fit = numerics::levenberg_marquardt(problem, start->vector().array().log().matrix());
  if (!fit) return tl::make_unexpected(fit.error());
  const auto inverse = numerics::inverse_normal_matrix(fit->jacobian, motor_parameter_names());
  if (!inverse) return tl::make_unexpected(inverse.error());
  MotorFit f;
  f.model = MotorModel::of(fit->parameters.array().exp().matrix());
  f.cost = fit->cost;
  f.expected_cost = static_cast<double>(spectra.lines()) - 0.5 * MotorModel::kParameters;
  f.converged = fit->converged;
  f.reason = fit->reason;
  constexpr double kVariance = 0.5;  // of the real and of the imaginary part of a residual of unit variance
  set_uncertainty(kVariance * *inverse, box_bias(problem, *fit, *inverse, kVariance), f);
  return f;
}

}  // namespace bodeflow::frisch
