#pragma once

#include <bodeflow/numerics/random.hpp>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <vector>

#include "model/simulate.hpp"
#include "records/recording.hpp"
#include "small_models.hpp"

/// Periodic recordings of the mass of small_models.hpp.
namespace bodeflow::residual::small {

constexpr Eigen::Index kPeriod = 512;
constexpr double kRate = 100.0;

inline Eigen::VectorXd mass_values() {
  const double omega = 2.0 * std::numbers::pi * 8.0;
  return Eigen::Vector3d(2.0, 2.0 * 2.0 * 0.05 * omega, 2.0 * omega * omega);
}

/// Odd lines 3 .. 161, every fourth left out, with phases of that seed.
inline std::vector<std::int64_t> lines() {
  std::vector<std::int64_t> all;
  for (std::int64_t k = 3; k < 162; k += 2)
    if (k % 8 != 5) all.push_back(k);
  return all;
}

inline Eigen::VectorXd multisine(double amplitude, std::uint64_t seed) {
  numerics::Random random(seed);
  Eigen::VectorXd u = Eigen::VectorXd::Zero(kPeriod);
  for (const std::int64_t k : lines()) {
    const double phase = 2.0 * std::numbers::pi * random.uniform();
    for (Eigen::Index n = 0; n < kPeriod; ++n)
      u[n] += amplitude * std::cos(2.0 * std::numbers::pi * static_cast<double>(k * n % kPeriod) / kPeriod + phase);
  }
  return u;
}

/// Noise of that deviation; `colour` in [0, 1) makes it fall with frequency (first-order autoregressive).
inline Eigen::VectorXd noise(Eigen::Index samples, double std, double colour, std::uint64_t seed) {
  numerics::Random random(seed);
  Eigen::VectorXd e(samples);
  double state = random.normal();
  for (Eigen::Index n = 0; n < samples; ++n) {
    e[n] = std * state;
    state = colour * state + std::sqrt(1.0 - colour * colour) * random.normal();
  }
  return e;
}

/// A recording of skip + periods periods of an input period, the steady output of a period (or of all the record) and noise.
inline records::Recording recording(const Eigen::MatrixXd& input, const Eigen::VectorXd& output, const Eigen::VectorXd& noise,
                                    Eigen::Index periods = 6, Eigen::Index skip = 1) {
  records::Recording r;
  r.sample_rate_hz = kRate;
  r.period = input.rows();
  r.skip = skip;
  r.periods = periods;
  for (Eigen::Index j = 0; j < input.cols(); ++j) {
    r.input_signals.names.push_back("force" + std::to_string(j));
    r.input_signals.units.push_back("N");
  }
  r.output_signals = {{"position"}, {"m"}};
  r.input = input.replicate(skip + periods, 1);
  r.output = output.size() == r.input.rows() ? Eigen::MatrixXd(output) : Eigen::MatrixXd(output.replicate(skip + periods, 1));
  r.output.col(0) += noise;
  return r;
}

inline Drive drive(const JointModel& model, const Eigen::VectorXd& values, const Eigen::MatrixXd& input) {
  Drive d;
  d.hold = model.base->timing().hold;
  d.sample_time_s = 1.0 / kRate;
  d.delay_s = model.delay_s(values);
  d.periodic = true;
  d.input = input;
  return d;
}

}  // namespace bodeflow::residual::small
