#pragma once

#include <Eigen/Core>
#include <bodeflow/error.hpp>
#include <complex>
#include <optional>
#include <string>
#include <vector>

namespace bodeflow::validation {

/// A resonance: a complex pole above the real axis, within the lines.
struct Mode {
  std::complex<double> pole;   ///< rad/s
  Eigen::Matrix2d covariance;  ///< of real and imaginary part; NaN where it is not known

  double frequency_hz() const;  ///< |pole| / 2 pi
  double damping() const;       ///< ratio
  double frequency_variance() const;
  double damping_variance() const;
};

/// The resonances of a model fitted to a response.
struct FittedModes {
  Eigen::Index order = 0;
  std::vector<Mode> modes;       ///< by frequency
  Eigen::Index other_poles = 0;  ///< real ones and those outside the lines
  double fit = 0.0;              ///< mean square residual over its expectation; NaN where no variance is known
  Eigen::VectorXcd response;     ///< of the model at the lines
  std::string no_covariance;     ///< why there is none
};

struct ModeSettings {
  std::optional<Eigen::Index> order;  ///< nothing: sought
  Eigen::Index highest_order = 30;
};

/// The resonances of one entry of a response.
///
/// Method: rational models by the Sanathanan-Koerner iteration in orthonormal polynomials, refined to the least-squares minimum;
/// weights 1 over the standard deviation, or 1/|G| where no variance is known. The order is the minimum of the description length
/// (MDL); the search ends kBeyond orders behind the first that leaves no more than the variance. Covariances assume that errors
/// are independent from line to line; where the model leaves more than the variance says they are larger by as much.
/// Errors: those of the method.
Expected<FittedModes> fit_modes(const Eigen::VectorXd& frequency_hz, const Eigen::VectorXcd& response,
                                const Eigen::VectorXd& variance, const ModeSettings& settings);

inline constexpr Eigen::Index kBeyond = 4;

}  // namespace bodeflow::validation
