#pragma once

#include <Eigen/Core>
#include <complex>

namespace bodeflow::sanathanan_koerner {

/// Where the frequencies lie on the unit circle of z. Continuous time: z = (a + s)/(a - s), which takes the left half plane into
/// the disc, s = 0 to 1, j a to j and infinity to -1; D. A. Jue prints the inverse of z, turned, which takes it outside. Discrete
/// time: z = exp(j omega T).
struct Plane {
  double prewarp_rad_s = 1.0;  ///< a; continuous time only
  double sample_time_s = 0.0;  ///< 0: continuous time

  bool discrete() const { return sample_time_s > 0.0; }
  Eigen::VectorXcd circle(const Eigen::VectorXd& omega_rad_s) const;
  /// The pole in s (or z, in discrete time) of a root of z; infinite where z = -1 in continuous time.
  std::complex<double> pole(std::complex<double> z) const;
  /// d pole / dz.
  std::complex<double> pole_slope(std::complex<double> z) const;
};

}  // namespace bodeflow::sanathanan_koerner
