#pragma once

#include <Eigen/Core>
#include <limits>

#include "expected.hpp"

namespace bodeflow::maximum_likelihood {

/// What a model is fitted to: mean spectra of one input and some outputs, a line in each row, with the covariance of the noise on
/// these means. A response G with variance is the same with U = 1, without noise, and Y = G.
struct Spectra {
  Eigen::VectorXd omega_rad_s;      ///< rising, not negative
  double sample_time_s = 0.0;       ///< 0: not known
  Eigen::VectorXcd input;           ///< U
  Eigen::MatrixXcd output;          ///< Y_i, lines x outputs
  Eigen::VectorXd input_variance;   ///< E|dU|^2
  Eigen::MatrixXd output_variance;  ///< E|dY_i|^2
  Eigen::MatrixXcd covariance;      ///< E(dY_i conj dU)
  /// nu, complex, of variances estimated from the scatter between periods: P - 1.
  double degrees_of_freedom = std::numeric_limits<double>::infinity();
  /// How many lines before and behind a line have errors that are correlated with its own; 0: all are independent.
  Eigen::Index correlated_lines = 0;
  bool variance_known = true;  ///< false: the variances only say how lines weigh against each other

  Eigen::Index lines() const { return omega_rad_s.size(); }
  Eigen::Index outputs() const { return output.cols(); }
  /// Whether spectra are real at line k, as at 0 and at half the sample rate.
  bool is_real(Eigen::Index k) const;
  /// 1 for a complex line, 1/2 for a real one: the equations it gives, in pairs.
  double weight(Eigen::Index k) const { return is_real(k) ? 0.5 : 1.0; }
  /// The sum of the weights over lines and outputs.
  double equations() const;
  /// |Y_i|^2 over the variance of the equation errors, summed: the cost of a model that is 0, about.
  double power() const;
  /// Y_i / U, lines x outputs.
  Eigen::MatrixXcd response() const;
  /// var Y + |G|^2 var U - 2 Re(conj(G) cov) for a response G, lines x outputs.
  Eigen::MatrixXd error_variance(const Eigen::MatrixXcd& response) const;
};

/// The spectra that a response and its variance (lines x outputs) stand for.
Spectra spectra_of(const Eigen::VectorXd& omega_rad_s, const Eigen::MatrixXcd& response, const Eigen::MatrixXd& variance);

/// The spectra whose lines weigh alike in G - response (`relative` false), or in (G - response) / response: for data without
/// variance. A line where |response| is below 1e-3 of the median counts as if it were there. variance_known is false.
Spectra evenly_weighted(const Spectra& spectra, bool relative);

/// The lines within low .. high, both included.
Spectra part_within(const Spectra& spectra, double low_rad_s, double high_rad_s);

/// Nothing, or why the spectra can't be fitted: sizes that differ, values that are not finite (with the line), frequencies that
/// do not rise, a line without input, a variance that is negative, or zero at a line (at all: see evenly_weighted).
Expected<void> check(const Spectra& spectra);

}  // namespace bodeflow::maximum_likelihood
