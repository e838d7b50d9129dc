#include "frequency_point.hpp"

#include <cmath>
#include <vector>

#include "numbers_in_text.hpp"

namespace bodeflow::adaptive_control {
namespace {

constexpr double kHuber = 3.0;           // residuals beyond as many sigma count as that
constexpr std::int64_t kHuberFrom = 60;  // updates until sigma is known well enough to clip
constexpr double kSigmaMemory = 0.99;
constexpr double kLeastNoise = 1e-16;  // of the signal's power: noise-free data must not lead to sigma = 0, which clips all
constexpr double kExcitationMemory = 0.95;
constexpr double kLeastDenominator = 1e-9;  // |A(z)|^2: at a pole of the model the last estimate stays

std::string settings_error(const FrequencyPointSettings& s) {
  if (s.denominator < 0 || s.denominator > 2 || s.numerator < 1 || s.numerator > 3 || s.denominator + s.numerator < 2) {
    return "a model with " + std::to_string(s.denominator) + " denominator and " + std::to_string(s.numerator) +
           " numerator parameters; allowed: 0 to 2 and 1 to 3, at least 2 together";
  }
  if (s.method == Method::extended && (s.noise_terms < 1 || s.noise_terms > 3)) {
    return std::to_string(s.noise_terms) + " noise terms; allowed with extended least squares: 1 to 3";
  }
  if (s.delay < 0 || s.delay > kMostDelay) {
    return "delay " + std::to_string(s.delay) + " samples; allowed: 0 to " + std::to_string(kMostDelay);
  }
  if (!(s.forgetting > 0.0 && s.forgetting <= 1.0)) return "forgetting " + text_of(s.forgetting) + "; allowed: above 0, up to 1";
  if (!(s.p0 > 0.0 && std::isfinite(s.p0))) return "p0 " + text_of(s.p0) + "; allowed: above 0";
  if (s.warm_up < 0) return "warm_up " + std::to_string(s.warm_up) + "; allowed: at least 0";
  return {};
}

/// Autocorrelation at lags 0 .. , 1 at lag 0, of white noise behind h.
std::vector<double> correlation(const std::vector<double>& h) {
  std::vector<double> r(h.size());
  for (std::size_t lag = 0; lag < h.size(); ++lag) {
    for (std::size_t k = lag; k < h.size(); ++k) r[lag] += h[k] * h[k - lag];
  }
  for (std::size_t lag = r.size(); lag-- > 0;) r[lag] /= r[0];
  return r;
}

}  // namespace

Expected<FrequencyPoint> FrequencyPoint::make(const FrequencyPointSettings& s) {
  const std::string error = settings_error(s);
  if (!error.empty()) return refused(error);
  auto filter = numerics::NarrowBandPass::design(s.filter_radius, s.filter_sections, s.filter_spread, s.omega * s.sample_time);
  if (!filter) return refused("frequency " + text_of(s.omega) + " rad/s: " + filter.error().text);
  return FrequencyPoint(s, *filter);
}

FrequencyPoint::FrequencyPoint(const FrequencyPointSettings& s, const numerics::NarrowBandPass& filter)
    : settings_(s), filter_y_(filter), filter_u_(filter), filter_reference_(filter) {
  const double w_h = s.omega * s.sample_time, p0 = w_h * w_h * s.p0;
  ud_ = UdLeastSquares(parameter_count(), p0);
  full_ = FullLeastSquares(parameter_count(), p0);
  for (std::size_t i = 0; i < z_back_.size(); ++i) z_back_[i] = std::polar(1.0, -w_h * static_cast<double>(i));
  instrument_step_ = static_cast<std::size_t>(std::clamp(std::round(2.0 / w_h), 1.0, 4.0));
  z_delay_ = std::polar(1.0, -w_h * s.delay);
}

void FrequencyPoint::step(const Sample& sample) {
  const double y_f = filter_y_.step(sample.y);
  const double u_f = filter_u_.step(sample.u_late);
  newest_u_ = newest_u_ == 0 ? u_past_.size() - 1 : newest_u_ - 1;
  u_past_[newest_u_] = u_f;
  excitation_ = kExcitationMemory * excitation_ + (1.0 - kExcitationMemory) * u_f * u_f;
  y_power_ = kExcitationMemory * y_power_ + (1.0 - kExcitationMemory) * y_f * y_f;
  acting_ = {};
  acting_.gate = settings_.gate && !(excitation_ > sample.least_excitation);
  if (settings_.method == Method::instrumental) {
    for (std::size_t i = reference_past_.size() - 1; i > 0; --i) reference_past_[i] = reference_past_[i - 1];
    reference_past_[0] = filter_reference_.step(sample.reference);
  }
  if (!acting_.gate) update(y_f);
  y_past_[1] = y_past_[0];
  y_past_[0] = y_f;
}

Regressor FrequencyPoint::regressor() const {
  Regressor phi{};
  std::size_t at = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(settings_.denominator); ++i) phi[at++] = -y_past_[i];
  for (std::size_t i = 0; i < static_cast<std::size_t>(settings_.numerator); ++i) {
    phi[at++] = u_past_[(newest_u_ + static_cast<std::size_t>(settings_.delay) + i) % u_past_.size()];
  }
  if (settings_.method == Method::extended) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(settings_.noise_terms); ++i) phi[at++] = noise_past_[i];
  }
  return phi;
}

void FrequencyPoint::update(double y_f) {
  const Regressor phi = regressor();
  const double w_h = settings_.omega * settings_.sample_time, limit = w_h * w_h * settings_.p0;
  if (directional_or_iv()) {
    const double error = y_f - full_.prediction(phi);
    Regressor zeta{};
    for (std::size_t i = 0; i < static_cast<std::size_t>(parameter_count()); ++i)
      zeta[i] = reference_past_[1 + i * instrument_step_];
    const double scale = settings_.method == Method::directional ? full_.measure_directional(phi, settings_.forgetting)
                                                                 : full_.measure(phi, zeta, settings_.forgetting);
    full_.correct(clipped(error, std::sqrt(scale)));
    if (settings_.bound) acting_.bound = full_.bound(limit);
  } else {
    const double error = y_f - ud_.prediction(phi);
    const double scale = std::sqrt(ud_.measure(phi, settings_.forgetting));
    ud_.correct(clipped(error, scale));
    if (settings_.bound) acting_.bound = ud_.bound(limit);
    if (settings_.method == Method::extended) {
      noise_past_[2] = noise_past_[1];
      noise_past_[1] = noise_past_[0];
      noise_past_[0] = y_f - ud_.prediction(phi);
    }
  }
  ++updates_;
  weight_sum_ = settings_.forgetting * weight_sum_ + 1.0;
  weight_squares_ = settings_.forgetting * settings_.forgetting * weight_squares_ + 1.0;
  evaluate();
}

/// The error that the parameters are corrected by. The residual n = e / sqrt(lambda + phi' P phi) has the noise's variance.
double FrequencyPoint::clipped(double error, double scale) {
  const double residual = error / scale, size = std::abs(residual);
  if (updates_ == 0) sigma_squared_ = size * size;
  const double limit = kHuber * std::sqrt(std::max(sigma_squared_, kLeastNoise * y_power_));
  const double used = updates_ <= kHuberFrom ? size : std::min(size, limit);
  sigma_squared_ = kSigmaMemory * sigma_squared_ + (1.0 - kSigmaMemory) * used * used;
  acting_.residual = size;
  acting_.residual_limit = limit;
  if (!settings_.huber || updates_ <= kHuberFrom || size <= limit) return error;
  acting_.huber = true;
  return std::copysign(limit * scale, residual);
}

void FrequencyPoint::evaluate() {
  const Regressor& theta = parameters();
  std::complex<double> a = 1.0, b = 0.0;
  std::size_t at = 0;
  for (std::size_t i = 1; i <= static_cast<std::size_t>(settings_.denominator); ++i) a += theta[at++] * z_back_[i];
  for (std::size_t i = 1; i <= static_cast<std::size_t>(settings_.numerator); ++i) b += theta[at++] * z_back_[i];
  const double size = std::norm(a);
  if (size > kLeastDenominator) response_ = z_delay_ * b * std::conj(a) / size;
}

/// Over how many samples residuals and regressors stay alike: sum over all lags of their correlations' product. White noise v at
/// the output makes the residual A H v, the regressors have the band of H.
double FrequencyPoint::shared_correlation() const {
  numerics::NarrowBandPass filter = filter_y_;
  filter.reset();
  const int length = std::min(1024, static_cast<int>(std::ceil(8.0 * filter.sections() / (1.0 - filter.radius()))));
  std::vector<double> h, residual;
  for (int k = 0; k < length; ++k) h.push_back(filter.step(k == 0 ? 1.0 : 0.0));
  const Regressor& theta = parameters();
  for (std::size_t k = 0; k < h.size(); ++k) {
    residual.push_back(h[k]);
    for (std::size_t i = 0; i < static_cast<std::size_t>(settings_.denominator) && i < k; ++i) {
      residual[k] += theta[i] * h[k - i - 1];
    }
  }
  const std::vector<double> of_h = correlation(h), of_residual = correlation(residual);
  double sum = 1.0;
  for (std::size_t lag = 1; lag < h.size(); ++lag) sum += 2.0 * of_h[lag] * of_residual[lag];
  return std::max(sum, 0.0);
}

double FrequencyPoint::variance() const {
  if (updates_ == 0) return 0.0;
  const Regressor& theta = parameters();
  std::complex<double> a = 1.0, b = 0.0;
  const auto n_a = static_cast<std::size_t>(settings_.denominator), n_b = static_cast<std::size_t>(settings_.numerator);
  for (std::size_t i = 0; i < n_a; ++i) a += theta[i] * z_back_[i + 1];
  for (std::size_t i = 0; i < n_b; ++i) b += theta[n_a + i] * z_back_[i + 1];
  std::array<std::complex<double>, kMostParameters> slope{};  // dG / dtheta
  for (std::size_t i = 0; i < n_a; ++i) slope[i] = -z_delay_ * b / (a * a) * z_back_[i + 1];
  for (std::size_t i = 0; i < n_b; ++i) slope[n_a + i] = z_delay_ / a * z_back_[i + 1];
  double sum = 0.0;
  for (std::size_t i = 0; i < n_a + n_b; ++i) {
    for (std::size_t k = 0; k < n_a + n_b; ++k) {
      const double p = directional_or_iv() ? full_.covariance(i, k) : ud_.covariance(i, k);
      sum += (slope[i] * std::conj(slope[k])).real() * p;
    }
  }
  return sigma_squared_ * shared_correlation() * weight_squares_ / weight_sum_ * sum;
}

}  // namespace bodeflow::adaptive_control
