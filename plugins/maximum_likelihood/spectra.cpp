#include "spectra.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace bodeflow::maximum_likelihood {

namespace {

constexpr double kNyquist = 1e-9;         // relative distance to half the sample rate that counts as there
constexpr double kEdge = 1e-9;            // relative: the rounding of units does not take a line from the end of a band
constexpr double kLeastMagnitude = 1e-3;  // of the median, for relative weights

std::string line_text(const Spectra& s, Eigen::Index k) {
  return "line " + std::to_string(k + 1) + " of " + std::to_string(s.lines()) + " (" +
         std::to_string(s.omega_rad_s[k] / (2.0 * std::numbers::pi)) + " Hz)";
}

Expected<void> check_line(const Spectra& s, Eigen::Index k) {
  if (!std::isfinite(s.omega_rad_s[k]) || s.omega_rad_s[k] < 0.0)
    return refused("the frequency of line " + std::to_string(k + 1) + " is negative or not finite");
  if (k > 0 && s.omega_rad_s[k] <= s.omega_rad_s[k - 1]) return refused("the frequencies do not rise at " + line_text(s, k));
  if (!s.output.row(k).allFinite()) return refused("the output is not finite at " + line_text(s, k));
  if (!s.input.segment(k, 1).allFinite()) return refused("the input is not finite at " + line_text(s, k));
  if (s.input[k] == 0.0) return refused("the input is zero at " + line_text(s, k));
  if (!std::isfinite(s.input_variance[k]) || !s.output_variance.row(k).allFinite() || !s.covariance.row(k).allFinite())
    return refused("the variance is not finite at " + line_text(s, k));
  if (s.input_variance[k] < 0.0 || s.output_variance.row(k).minCoeff() < 0.0)
    return refused("the variance is negative at " + line_text(s, k));
  return {};
}

}  // namespace

bool Spectra::is_real(Eigen::Index k) const {
  return omega_rad_s[k] == 0.0 || std::abs(omega_rad_s[k] * sample_time_s / std::numbers::pi - 1.0) < kNyquist;
}

double Spectra::equations() const {
  double sum = 0.0;
  for (Eigen::Index k = 0; k < lines(); ++k) sum += weight(k);
  return sum * static_cast<double>(outputs());
}

double Spectra::power() const { return output.cwiseAbs2().cwiseQuotient(error_variance(response())).sum(); }

Eigen::MatrixXcd Spectra::response() const { return input.cwiseInverse().asDiagonal() * output; }

Eigen::MatrixXd Spectra::error_variance(const Eigen::MatrixXcd& response) const {
  const Eigen::MatrixXd through_input = input_variance.asDiagonal() * response.cwiseAbs2();
  return output_variance + through_input - 2.0 * response.conjugate().cwiseProduct(covariance).real();
}

Spectra spectra_of(const Eigen::VectorXd& omega_rad_s, const Eigen::MatrixXcd& response, const Eigen::MatrixXd& variance) {
  Spectra s;
  s.omega_rad_s = omega_rad_s;
  s.input = Eigen::VectorXcd::Ones(response.rows());
  s.output = response;
  s.input_variance = Eigen::VectorXd::Zero(response.rows());
  s.output_variance = variance;
  s.covariance = Eigen::MatrixXcd::Zero(response.rows(), response.cols());
  return s;
}

Spectra evenly_weighted(const Spectra& spectra, bool relative) {
  const Eigen::MatrixXcd response = spectra.response();
  Eigen::MatrixXd variance(response.rows(), response.cols());
  for (Eigen::Index i = 0; i < response.cols(); ++i) {
    const Eigen::VectorXd magnitude = response.col(i).cwiseAbs();
    std::vector<double> sorted(magnitude.begin(), magnitude.end());
    std::nth_element(sorted.begin(), sorted.begin() + magnitude.size() / 2, sorted.end());
    const double least = kLeastMagnitude * sorted[static_cast<std::size_t>(magnitude.size() / 2)];
    const double even = magnitude.squaredNorm() / static_cast<double>(magnitude.size());
    for (Eigen::Index k = 0; k < response.rows(); ++k) {
      const double size = std::max(magnitude[k], least);
      variance(k, i) = relative ? size * size : even;
    }
  }
  Spectra s = spectra_of(spectra.omega_rad_s, response, variance);
  s.sample_time_s = spectra.sample_time_s;
  s.correlated_lines = spectra.correlated_lines;
  s.variance_known = false;
  return s;
}

Spectra part_within(const Spectra& spectra, double low_rad_s, double high_rad_s) {
  std::vector<Eigen::Index> kept;
  for (Eigen::Index k = 0; k < spectra.lines(); ++k) {
    const double omega = spectra.omega_rad_s[k];
    if (omega >= low_rad_s * (1.0 - kEdge) && omega <= high_rad_s * (1.0 + kEdge)) kept.push_back(k);
  }
  Spectra s = spectra;
  s.omega_rad_s = spectra.omega_rad_s(kept);
  s.input = spectra.input(kept);
  s.input_variance = spectra.input_variance(kept);
  s.output = spectra.output(kept, Eigen::all);
  s.output_variance = spectra.output_variance(kept, Eigen::all);
  s.covariance = spectra.covariance(kept, Eigen::all);
  return s;
}

Expected<void> check(const Spectra& s) {
  const Eigen::Index lines = s.lines(), outputs = s.outputs();
  const auto fits = [&](const auto& m) { return m.rows() == lines && m.cols() == outputs; };
  if (lines == 0 || outputs == 0) return refused("there are no lines to fit");
  if (s.input.size() != lines || s.input_variance.size() != lines || !fits(s.output) || !fits(s.output_variance) ||
      !fits(s.covariance)) {
    return refused("input, output and their variances do not have the same lines and outputs");
  }
  for (Eigen::Index k = 0; k < lines; ++k) {
    if (const auto line = check_line(s, k); !line) return line;
  }
  const Eigen::MatrixXd variance = s.error_variance(s.response());
  for (Eigen::Index k = 0; k < lines; ++k) {
    if (variance.row(k).minCoeff() > 0.0) continue;
    return refused("the variance is zero at " + line_text(s, k) +
                   ": no line can weigh infinitely; leave the line out by `band`, or measure more periods");
  }
  return {};
}

}  // namespace bodeflow::maximum_likelihood
