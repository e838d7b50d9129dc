#include "periodic/likely_input.hpp"

#include <bodeflow/numerics/random.hpp>
#include <cmath>

#include "periodic/fourier.hpp"
#include "periodic/periodic_prediction.hpp"

namespace bodeflow::residual {
namespace {

constexpr int kSteps = 3;

/// Gain of the plant at the lines where the input is excited and noisy, as measured; 0 at the others.
Eigen::VectorXcd gains(const PeriodicRecord& r) {
  Eigen::VectorXcd g = Eigen::VectorXcd::Zero(r.lines());
  for (Eigen::Index k = 1; k < r.lines(); ++k) {
    const Eigen::Index bin = k * r.periods;
    const bool excited = r.kind[static_cast<std::size_t>(bin)] == Kind::excited && r.input_lines(k, 0) != 0.0;
    if (excited && r.input_variance(k, 0) > 0.0) g[k] = r.output[bin] / r.input_lines(k, 0);
  }
  return g;
}

/// Moves the input, and the output by what a linear plant makes of it.
void move_input(const Eigen::VectorXcd& by, const Eigen::VectorXcd& gain, PeriodicRecord& r) {
  r.input.col(0) += signal_of(by, r.period);
  r.input_lines.col(0) += by;
  for (Eigen::Index k = 1; k < r.lines(); ++k) r.output[k * r.periods] += gain[k] * by[k];
}

}  // namespace

bool take_likely_input(const JointModel& model, const Eigen::VectorXd& values, PeriodicRecord& r) {
  const PeriodicRecord measured = r;
  const Eigen::VectorXcd gain = gains(measured);
  const Eigen::VectorXd floor = measured.floor.at(measured.frequency_hz);
  for (int n = 0; n < kSteps; ++n) {
    const PeriodicPrediction p = predict(r, model, values);
    if (!p.bins.allFinite()) return false;
    Eigen::VectorXcd by = Eigen::VectorXcd::Zero(r.lines());
    for (Eigen::Index k = 1; k < r.lines(); ++k) {
      const Eigen::Index bin = k * r.periods;
      const double v = measured.input_variance(k, 0), w = floor[bin];
      if (gain[k] == 0.0) continue;
      const double information = std::norm(gain[k]) / w + 1.0 / v;
      by[k] = (std::conj(gain[k]) * (measured.output[bin] - p.bins[bin]) / w -
               (r.input_lines(k, 0) - measured.input_lines(k, 0)) / v) /
              information;
      r.input_variance(k, 0) = 1.0 / information;
    }
    move_input(by, gain, r);
  }
  return true;
}

void add_input_noise(std::uint64_t draw, double sign, PeriodicRecord& r) {
  numerics::Random random(draw);
  const Eigen::VectorXcd gain = gains(r);
  Eigen::VectorXcd noise = Eigen::VectorXcd::Zero(r.lines());
  for (Eigen::Index k = 1; k < r.lines(); ++k) {
    const double std = sign * std::sqrt(r.input_variance(k, 0) / 2.0), real = random.normal();
    if (gain[k] != 0.0) noise[k] = std * std::complex<double>(real, random.normal());
  }
  move_input(noise, gain, r);
}

}  // namespace bodeflow::residual
