#include "bodeflow/numerics/fir.hpp"

#include <cmath>
#include <numbers>

namespace bodeflow::numerics {

using std::numbers::pi;

namespace {

// Beyond it a filter is a mistake, and its length may not even fit an index.
constexpr double kMostTaps = 0x1p26;

}  // namespace

double bessel_i0(double x) {
  const double quarter = 0.25 * x * x;
  double term = 1;
  double sum = 1;
  for (int k = 1; term > 1e-17 * sum; ++k) {
    term *= quarter / (static_cast<double>(k) * k);
    sum += term;
  }
  return sum;
}

Eigen::VectorXd kaiser_window(Eigen::Index length, double beta) {
  Eigen::VectorXd window = Eigen::VectorXd::Ones(length);
  const double middle = 0.5 * static_cast<double>(length - 1);
  for (Eigen::Index j = 0; j < length && length > 1; ++j) {
    const double x = (static_cast<double>(j) - middle) / middle;
    window[j] = bessel_i0(beta * std::sqrt((1 - x) * (1 + x))) / bessel_i0(beta);
  }
  return window;
}

double kaiser_beta(double attenuation_db) {
  if (attenuation_db > 50) return 0.1102 * (attenuation_db - 8.7);
  if (attenuation_db < 21) return 0;
  return 0.5842 * std::pow(attenuation_db - 21, 0.4) + 0.07886 * (attenuation_db - 21);
}

Expected<Eigen::Index> low_pass_half_length(const LowPass& design) {
  if (!(design.pass_edge > 0) || !(design.stop_edge > design.pass_edge) || !(design.stop_edge <= 1)) {
    return refused("the edges of the bands must be 0 < pass < stop <= 1");
  }
  if (!(design.attenuation_db >= 21) || !(design.attenuation_db <= 200)) return refused("the attenuation must be 21 to 200 dB");
  const double taps = (design.attenuation_db - 7.95) / (2.285 * pi * (design.stop_edge - design.pass_edge));
  if (taps > kMostTaps) return refused("the transition band is too narrow: more than 2^26 taps");
  return static_cast<Eigen::Index>(std::ceil(0.5 * taps));
}

Eigen::VectorXd low_pass(const LowPass& design, Eigen::Index half) {
  const double cut_off = 0.5 * (design.pass_edge + design.stop_edge);
  Eigen::VectorXd taps = kaiser_window(2 * half + 1, kaiser_beta(design.attenuation_db));
  for (Eigen::Index j = 1; j <= half; ++j) {
    const double t = static_cast<double>(j);
    const double sinc = std::sin(pi * cut_off * t) / (pi * t);
    taps[half - j] *= sinc;
    taps[half + j] = taps[half - j];
  }
  taps[half] = cut_off;
  return taps / taps.sum();
}

double dot(const double* a, const double* b, std::size_t count) {
  constexpr std::size_t kLanes = 8;
  double partial[kLanes] = {};
  std::size_t j = 0;
  for (; j + kLanes <= count; j += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) partial[lane] += a[j + lane] * b[j + lane];
  }
  for (std::size_t lane = 0; j < count; ++j, ++lane) partial[lane] += a[j] * b[j];
  return ((partial[0] + partial[4]) + (partial[1] + partial[5])) + ((partial[2] + partial[6]) + (partial[3] + partial[7]));
}

std::complex<double> fir_response(const Eigen::VectorXd& taps, double fraction_of_nyquist) {
  std::complex<double> sum = 0;
  for (Eigen::Index j = 0; j < taps.size(); ++j) sum += std::polar(taps[j], -pi * fraction_of_nyquist * static_cast<double>(j));
  return sum;
}

}  // namespace bodeflow::numerics
