#include "relay.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "numbers_in_text.hpp"

namespace bodeflow::adaptive_control {
namespace {

constexpr double kAtOnce = 0.2;       // of it: the first response of a plant of low order
constexpr double kNearlyZero = 0.02;  // of the oscillation's peak value: what counts as no response yet

std::complex<double> fourier_sum(const std::vector<double>& x, std::size_t from, std::size_t to, int cycles) {
  const double turn = 2.0 * std::numbers::pi * cycles / static_cast<double>(to - from);
  std::complex<double> sum = 0.0;
  for (std::size_t n = from; n < to; ++n) sum += x[n] * std::polar(1.0, -turn * static_cast<double>(n - from));
  return sum;
}

}  // namespace

Expected<RelayExperiment> RelayExperiment::make(const RelaySettings& s) {
  if (!(s.amplitude > 0.0)) return refused("relay amplitude " + text_of(s.amplitude) + "; allowed: above 0");
  if (!(s.hysteresis >= 0.0)) return refused("relay hysteresis " + text_of(s.hysteresis) + "; allowed: at least 0");
  if (s.cycles < 1 || s.settling_cycles < 0) return refused("relay: at least one cycle must be measured");
  return RelayExperiment(s);
}

double RelayExperiment::step(double y, double setpoint) {
  if (finished_) return s_.offset;
  const double error = setpoint - y;
  aborted_ = std::abs(error) > s_.largest_output;
  const bool was_up = up_;
  if (up_ && error < -s_.hysteresis) up_ = false;
  if (!up_ && error > s_.hysteresis) up_ = true;
  if (!u_.empty() && up_ && !was_up) rises_.push_back(u_.size());
  finished_ = aborted_ || rises_.size() > static_cast<std::size_t>(s_.settling_cycles + s_.cycles);
  const double u = finished_ ? s_.offset : s_.offset + (up_ ? s_.amplitude : -s_.amplitude);
  u_.push_back(u);
  y_.push_back(y);
  return u;
}

Expected<RelayResult> RelayExperiment::result(double sample_time) const {
  if (aborted_) return refused("the output left its bounds of " + text_of(s_.largest_output) + " around the set point");
  if (!finished_) {
    return refused("the relay made " + std::to_string(rises_.size()) + " cycles; needed: " +
                   std::to_string(s_.settling_cycles + s_.cycles + 1) + ", so run longer, or lower the hysteresis");
  }
  const std::size_t to = rises_.back(), from = rises_[rises_.size() - 1 - static_cast<std::size_t>(s_.cycles)];
  const std::complex<double> u = fourier_sum(u_, from, to, s_.cycles), y = fourier_sum(y_, from, to, s_.cycles);
  if (!(std::abs(u) > 0.0)) return refused("the relay's signal has no part at its own frequency: it switches at every sample");
  RelayResult r;
  r.omega = 2.0 * std::numbers::pi * s_.cycles / (static_cast<double>(to - from) * sample_time);
  r.response = y / u;
  const auto [least, most] =
      std::minmax_element(y_.begin() + static_cast<std::ptrdiff_t>(from), y_.begin() + static_cast<std::ptrdiff_t>(to));
  r.output_amplitude = 0.5 * (*most - *least);
  r.describing_gain = std::numbers::pi * r.output_amplitude / (4.0 * s_.amplitude);
  const double nearly = kNearlyZero * r.output_amplitude + s_.hysteresis;
  while (static_cast<std::size_t>(r.zero_samples) < y_.size() && y_[static_cast<std::size_t>(r.zero_samples)] - y_[0] <= nearly) {
    ++r.zero_samples;
  }
  const auto first = static_cast<std::size_t>(r.zero_samples);
  const bool at_once = first < y_.size() && y_[first] - y_[0] > kAtOnce * r.output_amplitude;
  r.delay = r.zero_samples - (at_once && r.zero_samples > 0 ? 1 : 0);
  return r;
}

}  // namespace bodeflow::adaptive_control
