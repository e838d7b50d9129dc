#include "sensor_dynamics.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <bodeflow/numerics/discretise.hpp>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>

namespace bodeflow::drive {
namespace {

constexpr int kTaps = 6;
// Of the sampling rate: with these two the largest error up to a tenth is the smallest.
constexpr std::array kExactAt{0.06, 0.095};

/// Taps k = 0 .. 5 of (1 - a/z) exp(-s delay) / (1 + s lag), z = exp(s), `delay` in samples from tap 0.
Eigen::VectorXd design(double lag, double delay) {
  const double decay = lag > 0 ? std::exp(-1 / lag) : 0.0;
  const double rise = lag > 0 ? -std::expm1(-1 / lag) : 1.0;
  Eigen::MatrixXd conditions(kTaps, kTaps);
  Eigen::VectorXd values(kTaps);
  const Eigen::ArrayXd k = Eigen::ArrayXd::LinSpaced(kTaps, 0, kTaps - 1);
  conditions.row(0).setOnes();
  values[0] = rise;
  conditions.row(1) = -k;
  values[1] = -rise * (delay + lag) + decay;
  int row = 2;
  for (const double frequency : kExactAt) {
    const double omega = 2 * std::numbers::pi * frequency;
    const std::complex<double> j(0, 1);
    const std::complex<double> value =
        std::exp(-j * omega * delay) * (1.0 - decay * std::exp(-j * omega)) / (1.0 + j * omega * lag);
    conditions.row(row) = (omega * k).cos();
    values[row++] = value.real();
    conditions.row(row) = -(omega * k).sin();
    values[row++] = value.imag();
  }
  return conditions.fullPivLu().solve(values);
}

bool is_allowed(double samples) { return samples >= 0 && samples <= SensorDynamics::kLongest; }

}  // namespace

numerics::Expected<SensorDynamics> SensorDynamics::make(double lag, double delay) {
  if (!is_allowed(lag) || !is_allowed(delay)) {
    return numerics::refused("lag of " + std::to_string(lag) + " and delay of " + std::to_string(delay) +
                             " samples; allowed: 0 to 1000000 each");
  }
  const numerics::SplitDelay split = numerics::split_delay(delay, 1.0);
  const auto whole = static_cast<std::size_t>(split.samples);
  if (lag == 0 && split.rest_s == 0) return SensorDynamics(0.0, {1.0}, whole);
  const std::size_t shift = whole - std::min<std::size_t>(whole, kTaps / 2 - 1);
  const Eigen::VectorXd taps = design(lag, static_cast<double>(whole - shift) + split.rest_s);
  return SensorDynamics(lag > 0 ? std::exp(-1 / lag) : 0.0, std::vector<double>(taps.begin(), taps.end()), shift);
}

SensorDynamics::SensorDynamics(double decay, std::vector<double> taps, std::size_t shift)
    : decay_(decay), taps_(std::move(taps)), shift_(shift), past_(shift + taps_.size()) {}

void SensorDynamics::run(std::span<const double> x, std::span<double> y) {
  for (std::size_t n = 0; n < x.size(); ++n) {
    newest_ = newest_ + 1 == past_.size() ? 0 : newest_ + 1;
    past_[newest_] = x[n];
    std::size_t at = newest_ >= shift_ ? newest_ - shift_ : newest_ + past_.size() - shift_;
    double sum = 0.0;
    for (const double tap : taps_) {
      sum += tap * past_[at];
      at = at == 0 ? past_.size() - 1 : at - 1;
    }
    output_ = decay_ * output_ + sum;
    y[n] = output_;
  }
}

void SensorDynamics::reset() {
  std::fill(past_.begin(), past_.end(), 0.0);
  newest_ = 0;
  output_ = 0.0;
}

}  // namespace bodeflow::drive
