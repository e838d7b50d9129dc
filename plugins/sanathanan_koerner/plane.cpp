#include "plane.hpp"

#include <cmath>

namespace bodeflow::sanathanan_koerner {

Eigen::VectorXcd Plane::circle(const Eigen::VectorXd& omega_rad_s) const {
  Eigen::VectorXcd z(omega_rad_s.size());
  for (Eigen::Index k = 0; k < z.size(); ++k)
    z[k] = std::polar(1.0, discrete() ? omega_rad_s[k] * sample_time_s : 2.0 * std::atan(omega_rad_s[k] / prewarp_rad_s));
  return z;
}

std::complex<double> Plane::pole(std::complex<double> z) const { return discrete() ? z : prewarp_rad_s * (z - 1.0) / (z + 1.0); }

std::complex<double> Plane::pole_slope(std::complex<double> z) const {
  return discrete() ? 1.0 : 2.0 * prewarp_rad_s / ((z + 1.0) * (z + 1.0));
}

}  // namespace bodeflow::sanathanan_koerner
