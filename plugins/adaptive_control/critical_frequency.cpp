#include "critical_frequency.hpp"

#include <cmath>
#include <numbers>

namespace bodeflow::adaptive_control {
namespace {

constexpr int kGrid = 400;  // frequencies over 3 decades, 1.7 % apart; a crossing is interpolated between them

}  // namespace

Expected<CriticalFrequency> CriticalFrequency::make(const DesiredResponse& desired, double sample_time) {
  CriticalFrequency c;
  for (int i = 0; i < kGrid; ++i) {
    c.omega_.push_back(0.999 * std::numbers::pi / sample_time * std::pow(1e-3, 1.0 - (i + 1.0) / kGrid));
    c.z_.push_back(std::polar(1.0, c.omega_.back() * sample_time));
  }
  auto g_m = desired_points(desired, sample_time, c.omega_);
  if (!g_m) return refused(g_m.error().text);
  c.g_m_ = *g_m;
  return c;
}

double CriticalFrequency::estimate(const Rst& rst) const {
  std::complex<double> before;
  for (std::size_t i = 0; i < omega_.size(); ++i) {
    const std::complex<double> t = value_at(rst.t, rst.n_t, z_[i]), s = value_at(rst.s, rst.n_s, z_[i]);
    const std::complex<double> loop = g_m_[i] * s / (t - g_m_[i] * s);
    if (i > 0 && before.imag() < 0.0 && loop.imag() >= 0.0 && loop.real() < 0.0) {
      const double share = before.imag() / (before.imag() - loop.imag());
      return omega_[i - 1] + share * (omega_[i] - omega_[i - 1]);
    }
    before = loop;
  }
  return 0.0;
}

}  // namespace bodeflow::adaptive_control
