#pragma once

#include <Eigen/Core>

#include "equations.hpp"

namespace bodeflow::maximum_likelihood {

/// gain * prod(x - zeros) / prod(x - poles) exp(-s delay) of one output, in rad/s or as values of z.
struct Rational {
  Eigen::VectorXcd poles;  ///< the fixed ones first, then by magnitude
  Eigen::VectorXcd zeros;
  double gain = 0.0;
  double delay_s = 0.0;
  double sample_time_s = 0.0;  ///< 0: x = s

  /// Descending powers; the denominator's first is 1. Multiplied out from the roots, which loses no digits for stable ones.
  Eigen::VectorXd numerator() const;
  Eigen::VectorXd denominator() const;
  std::complex<double> response(double omega_rad_s) const;
};

/// The model of one output. sample_time_s: of the data, for domain z. Errors: a denominator whose highest coefficient is 0, a
/// numerator that is 0.
Expected<Rational> rational_of(const Lines& lines, const Structure& structure, const Estimate& estimate, std::size_t output,
                               double sample_time_s);

}  // namespace bodeflow::maximum_likelihood
