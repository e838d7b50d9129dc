#pragma once

#include <Eigen/Core>
#include <bodeflow/numerics/random.hpp>
#include <cmath>
#include <numbers>
#include <vector>

#include "frisch/motor_fit.hpp"
#include "frisch/physical_parameters.hpp"

/// The paper's motor and its two records.
namespace bodeflow::test {

inline frisch::MotorModel paper_motor() { return *frisch::motor_model(6.6, 5.5, 0.475, 0.475, 0.454); }

struct MotorBand {
  double sample_time = 0.0;
  std::vector<Eigen::Index> lines;
  double amplitude = 0.0;      // V peak a line
  double voltage_noise = 0.0;  // standard deviation
  double current_noise = 0.0;

  Eigen::VectorXd omega() const {
    Eigen::VectorXd w(static_cast<Eigen::Index>(lines.size()));
    for (std::size_t i = 0; i < lines.size(); ++i) {
      w[static_cast<Eigen::Index>(i)] = 2.0 * std::numbers::pi * static_cast<double>(lines[i]) / (128.0 * sample_time);
    }
    return w;
  }
};

inline std::vector<Eigen::Index> odd_lines(Eigen::Index first) {
  std::vector<Eigen::Index> lines;
  for (Eigen::Index i = 0; i < 24; ++i) lines.push_back(first + 2 * i);
  return lines;
}

inline MotorBand low_band(double amplitude) { return {0.064, odd_lines(1), amplitude, 0.71, 0.22}; }
inline MotorBand high_band(double amplitude) { return {0.004, odd_lines(3), amplitude, 0.57, 0.117}; }

/// Eight periods of 128 samples of voltage and current in the steady state, with white noise.
struct MotorRecord {
  Eigen::VectorXd voltage;
  Eigen::VectorXd current;
};

inline MotorRecord motor_record(const MotorBand& band, numerics::Random& random) {
  constexpr Eigen::Index kPeriod = 128, kPeriods = 8;
  MotorRecord r{Eigen::VectorXd::Zero(kPeriod * kPeriods), Eigen::VectorXd::Zero(kPeriod * kPeriods)};
  const Eigen::VectorXcd g = frisch::response(paper_motor(), band.omega());
  const auto count = static_cast<double>(band.lines.size());
  for (std::size_t i = 0; i < band.lines.size(); ++i) {
    const double number = static_cast<double>(i) + 1.0, phase = -number * (number - 1.0) * std::numbers::pi / count;
    const std::complex<double> gain = g[static_cast<Eigen::Index>(i)];
    for (Eigen::Index t = 0; t < kPeriod; ++t) {
      const double angle = 2.0 * std::numbers::pi * static_cast<double>(band.lines[i] * t % kPeriod) / kPeriod + phase;
      r.voltage[t] += band.amplitude * std::cos(angle);
      r.current[t] += band.amplitude * std::abs(gain) * std::cos(angle + std::arg(gain));
    }
  }
  for (Eigen::Index t = kPeriod; t < r.voltage.size(); ++t) {
    r.voltage[t] = r.voltage[t - kPeriod];
    r.current[t] = r.current[t - kPeriod];
  }
  for (double& v : r.voltage) v += band.voltage_noise * random.normal();
  for (double& i : r.current) i += band.current_noise * random.normal();
  return r;
}

struct WindowSpectra {
  Eigen::MatrixXcd input, output;
};

inline WindowSpectra windows(const MotorRecord& r, const MotorBand& band, Eigen::Index step) {
  return {*frisch::window_spectra(r.voltage, 128, step, band.lines), *frisch::window_spectra(r.current, 128, step, band.lines)};
}

/// The mean spectra of a band with pooled noise, input and output taken as uncorrelated.
inline frisch::MeanSpectra means(const MotorRecord& r, const MotorBand& band, bool with_covariance = false) {
  const WindowSpectra w = windows(r, band, 128);
  return *frisch::mean_spectra(band.omega(), w.input, w.output, *frisch::pooled_noise(w.input, w.output), with_covariance);
}

inline Eigen::VectorXd stacked(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  Eigen::VectorXd both(a.size() + b.size());
  both << a, b;
  return both;
}

inline Eigen::VectorXcd stacked(const Eigen::VectorXcd& a, const Eigen::VectorXcd& b) {
  Eigen::VectorXcd both(a.size() + b.size());
  both << a, b;
  return both;
}

}  // namespace bodeflow::test
