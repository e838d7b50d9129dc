#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

namespace bodeflow::validation {

/// The correlation coefficient of two magnitudes, sum x y / sqrt(sum x^2 sum y^2), as used for sweep frequency responses of
/// windings; not reduced by the mean. NaN where one is zero everywhere.
double correlation_coefficient(const Eigen::VectorXd& x, const Eigen::VectorXd& y);

/// The relative factor of DL/T 911: -lg(1 - rho), rho the correlation of the magnitudes in dB about their means; 10 where
/// 1 - rho < 1e-10. NaN for fewer than two values, and where one curve is flat.
double relative_factor(const Eigen::VectorXd& before, const Eigen::VectorXd& after);

/// One of the bands of DL/T 911, with its factor where the lines reach through it.
struct StandardBand {
  const char* name;
  double low_hz, high_hz;
  Eigen::Index lines = 0;
  double factor;  ///< NaN where the lines do not reach over the band
};

/// Factors of the low (1 to 100 kHz), medium (100 to 600 kHz) and high band (600 kHz to 1 MHz).
struct StandardFactors {
  std::array<StandardBand, 3> bands;
  /// The degree of winding deformation by the standard's table: "normal", "slight", "obvious", "severe"; "" where the bands that
  /// decide it are not covered.
  std::string deformation;
};

/// Source: DL/T 911-2004, Frequency response analysis on winding deformation of power transformers, annex; the limits are those
/// of its table: severe R_low < 0.6; obvious R_low < 1 or R_medium < 0.6; slight R_low < 2 or R_medium < 1; normal R_low >= 2,
/// R_medium >= 1 and R_high >= 0.6. The standard is written for magnitudes of transformer windings and knows no noise.
StandardFactors standard_factors(const Eigen::VectorXd& frequency_hz, const Eigen::VectorXcd& before,
                                 const Eigen::VectorXcd& after);

/// 20 lg |g|; the smallest normal number stands for 0.
Eigen::VectorXd decibels(const Eigen::VectorXcd& g);

}  // namespace bodeflow::validation
