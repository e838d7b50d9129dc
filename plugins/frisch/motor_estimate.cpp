#include "motor_estimate.hpp"

#include <algorithm>

namespace bodeflow::frisch {
namespace {

using Complex = std::complex<double>;

/// The mean spectra with outputs referred to the continuous motor.
MeanSpectra continuous(MeanSpectra s, const Eigen::VectorXcd& factor) {
  s.output.array() *= factor.array();
  s.covariance.array() *= factor.array();
  s.output_variance.array() *= factor.array().abs2();
  return s;
}

void set_response(const MeanSpectra& s, MotorEstimate& e) {
  e.response = s.output.cwiseQuotient(s.input);
  e.variance.resize(s.lines());
  for (Eigen::Index k = 0; k < s.lines(); ++k) {
    const Complex g = e.response[k];
    const double v = s.output_variance[k] + std::norm(g) * s.input_variance[k] - 2.0 * (std::conj(g) * s.covariance[k]).real();
    e.variance[k] = std::max(0.0, v) / std::norm(s.input[k]);
  }
}

Expected<MotorEstimate> by_likelihood(const std::vector<Band>& bands, const MotorSettings& settings) {
  MotorEstimate e;
  MeanSpectra all = with_pooled_noise(bands.front(), settings.correlated_noise);
  for (std::size_t b = 0; b < bands.size(); ++b) {
    if (b > 0) all = joined(all, with_pooled_noise(bands[b], settings.correlated_noise));
    if (!bands[b].has_scatter()) continue;
    const PooledNoise noise = pooled_noise(bands[b]);
    e.input_noise_variance.push_back(noise.input_variance);
    e.output_noise_variance.push_back(noise.output_variance);
  }
  const auto fit = fit_behind_hold([&](const Eigen::VectorXcd& factor) { return fit_motor_likelihood(continuous(all, factor)); },
                                   all.omega, settings.sampling);
  if (!fit) return tl::make_unexpected(fit.error());
  e.fit = *fit;
  e.omega = all.omega;
  set_response(continuous(all, continuous_factor(fit->model, all.omega, settings.sampling)), e);
  return e;
}

Expected<MotorEstimate> by_least_squares(const std::vector<Band>& bands, const MotorSettings& settings) {
  MotorEstimate e;
  for (const Band& band : bands) {
    if (band.power.lines() == 0) {
      return refused("the band of " + band.range() +
                     " has no products of windows; give records `spectral_matrix`, or responses "
                     "with mean spectra of 2 periods or more");
    }
    NoiseVariances noise;
    if (settings.method == Method::frisch) {
      const auto found = frisch_noise(band.power, settings.outliers);
      if (!found) return refused("band of " + band.range() + ": " + found.error().text);
      noise = found->second;
      e.input_noise_variance.push_back(noise.input);
      e.output_noise_variance.push_back(noise.output);
    }
    const auto response = corrected_response(band.power, noise, settings.form);
    if (!response) return refused("band of " + band.range() + ": " + response.error().text);
    const Eigen::Index before = e.omega.size(), lines = response->size();
    e.omega.conservativeResize(before + lines);
    e.response.conservativeResize(before + lines);
    e.omega.tail(lines) = band.mean.omega;
    e.response.tail(lines) = *response;
  }
  const Eigen::VectorXd weight = Eigen::VectorXd::Ones(e.omega.size());
  const auto fit =
      fit_behind_hold([&](const Eigen::VectorXcd& factor) { return fit_motor(e.omega, e.response.cwiseProduct(factor), weight); },
                      e.omega, settings.sampling);
  if (!fit) return tl::make_unexpected(fit.error());
  e.fit = *fit;
  e.response.array() *= continuous_factor(fit->model, e.omega, settings.sampling).array();
  return e;
}

}  // namespace

Expected<MotorEstimate> estimate_motor(std::vector<Band> bands, const MotorSettings& settings) {
  if (bands.empty()) return refused("no band was measured");
  std::stable_sort(bands.begin(), bands.end(), [](const Band& a, const Band& b) { return a.mean.omega[0] < b.mean.omega[0]; });
  return settings.method == Method::maximum_likelihood ? by_likelihood(bands, settings) : by_least_squares(bands, settings);
}

}  // namespace bodeflow::frisch
