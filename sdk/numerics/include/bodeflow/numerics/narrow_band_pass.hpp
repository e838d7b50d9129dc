#pragma once

#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdio>
#include <numbers>
#include <string>

#include "bodeflow/numerics/error.hpp"

namespace bodeflow::numerics {

/// A narrow band-pass filter of order 2 m whose poles stand at one distance 1 - r from the unit circle, dphi apart, around the
/// angle w h:
///   H(z) = prod_i (1 - r)(z^2 - 1) / (z^2 - 2 r cos(phi_i) z + r^2), phi_i = w h + ((m + 1) / 2 - i) dphi, i = 1 .. m.
/// The impulse response decays as r^k whatever m is. Each section is realised by a rotation, whose poles move by no more than its
/// coefficients do:
///   x[k+1] = r [cos -sin; sin cos] x[k] + [(1 - r) / (r sin); 0] u[k], y[k] = [r^2 sin 2 phi, r^2 cos 2 phi - 1] x[k] + (1 - r)
///   u[k].
/// The gain at the centre is only near 1 (1.05 to 1.08 for r = 0.9, m = 2, dphi = 2 degrees and w h above 0.3), and below w h of
/// about 1 - r the peak lies above the centre: 0.118 for w h = 0.05. Group delay there about 19 samples, 50 until the impulse
/// response is below 5 %.
/// Source: A. Kallen, Frequency Domain Adaptive Control, Lund 1992, section 6.4, (6.4)-(6.10).
class NarrowBandPass {
 public:
  static constexpr int kMostSections = 16;
  /// The least angle of a pole and of its distance to pi: nearer to the real axis the input gain (1 - r) / (r sin phi) of the
  /// realisation multiplies rounding errors by more than 10^4.
  static constexpr double kLeastAngle = 1e-4;

  /// One section: its angle and the coefficients of its realisation.
  struct Section {
    double phi = 0.0;
    double cosine = 0.0;  // r cos phi
    double sine = 0.0;    // r sin phi
    double input = 0.0;   // (1 - r) / (r sin phi)
    double first = 0.0;   // r^2 sin 2 phi
    double second = 0.0;  // r^2 cos 2 phi - 1
    double direct = 0.0;  // 1 - r
  };

  /// The filter with pole radius r, m sections, an angle of dphi [rad] between poles and its centre at w_h = w h [rad] (h the
  /// sample time). Errors: r outside 0 .. 1, m outside 1 .. kMostSections, dphi negative, a centre so near zero or the Nyquist
  /// frequency that a pole would lie on the real axis: allowed is dphi (m - 1) / 2 < w h < pi - dphi (m - 1) / 2, both by
  /// kLeastAngle.
  static Expected<NarrowBandPass> design(double r, int m, double dphi, double w_h);

  /// y[k] for the next u[k]. Allocates nothing.
  double step(double u) {
    for (std::size_t i = 0; i < count_; ++i) {
      const Section& s = sections_[i];
      const auto [x1, x2] = states_[i];
      const double y = (s.first * x1 + s.second * x2) + s.direct * u;
      states_[i] = {(s.cosine * x1 - s.sine * x2) + s.input * u, s.sine * x1 + s.cosine * x2};
      u = y;
    }
    return u;
  }

  /// Back to a past of zeros.
  void reset() { states_ = {}; }

  /// H(exp(j w_h)), w_h in rad.
  std::complex<double> response(double w_h) const {
    const std::complex<double> z = std::polar(1.0, w_h);
    std::complex<double> h = 1;
    for (std::size_t i = 0; i < count_; ++i) {
      const Section& s = sections_[i];
      h *= s.direct * (z * z - 1.0) / ((z - 2 * s.cosine) * z + r_ * r_);
    }
    return h;
  }

  double radius() const { return r_; }
  int sections() const { return static_cast<int>(count_); }
  const Section& section(int i) const { return sections_[static_cast<std::size_t>(i)]; }

 private:
  NarrowBandPass() = default;

  double r_ = 0.0;
  std::size_t count_ = 0;
  std::array<Section, kMostSections> sections_{};
  std::array<std::array<double, 2>, kMostSections> states_{};
};

inline Expected<NarrowBandPass> NarrowBandPass::design(double r, int m, double dphi, double w_h) {
  const auto text = [](double value) {
    char digits[32];
    std::snprintf(digits, sizeof digits, "%.6g", value);
    return std::string(digits);
  };
  if (!(r > 0 && r < 1)) return refused("the pole radius r = " + text(r) + " must lie between 0 and 1");
  if (m < 1 || m > kMostSections) {
    return refused("m = " + std::to_string(m) + " sections: allowed are 1 to " + std::to_string(kMostSections));
  }
  if (!(dphi >= 0 && dphi < std::numbers::pi)) {
    return refused("the angle dphi = " + text(dphi) + " rad between poles must be at least 0 and less than pi");
  }
  const double least = 0.5 * dphi * (m - 1) + kLeastAngle;
  if (!(w_h >= least)) {
    return refused("the centre w h = " + text(w_h) + " rad is too near zero: a filter with m = " + std::to_string(m) +
                   " and dphi = " + text(dphi) + " rad needs more than dphi (m - 1) / 2, at least " + text(least) + " rad");
  }
  if (!(w_h <= std::numbers::pi - least)) {
    return refused("the centre w h = " + text(w_h) + " rad is too near the Nyquist frequency pi or above it: allowed is up to " +
                   text(std::numbers::pi - least) + " rad");
  }
  NarrowBandPass filter;
  filter.r_ = r;
  filter.count_ = static_cast<std::size_t>(m);
  for (int i = 1; i <= m; ++i) {
    const double phi = w_h + (0.5 * (m + 1) - i) * dphi;
    const double sine = r * std::sin(phi);
    filter.sections_[static_cast<std::size_t>(i - 1)] = {
        phi, r * std::cos(phi), sine, (1 - r) / sine, r * r * std::sin(2 * phi), r * r * std::cos(2 * phi) - 1, 1 - r};
  }
  return filter;
}

}  // namespace bodeflow::numerics
