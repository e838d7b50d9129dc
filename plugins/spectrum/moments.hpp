#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace bodeflow::spectrum {

/// How many signals of each kind are measured. They stand in this order: inputs, outputs, references.
struct Layout {
  Eigen::Index inputs = 1;
  Eigen::Index outputs = 1;
  Eigen::Index references = 0;
  Eigen::Index signals() const { return inputs + outputs + references; }
};

/// Mean spectra of one experiment and the noise on them, at the lines 0 .. N/2 (rows). Signals in columns, as in Layout.
struct Moments {
  std::int64_t periods = 0;
  double degrees_of_freedom = 0.0;  ///< complex ones of the covariances; 0: unknown, they are empty then
  Eigen::MatrixXcd mean;            ///< Z_a(k), 1/N sum_n z_a[n] exp(-2 pi i k n / N), mean over the periods
  Eigen::MatrixXd variance;         ///< of the mean: E|dZ_a|^2
  Eigen::MatrixXcd covariance;      ///< of the mean: E{dZ_a conj(dZ_b)}, a > b, in column pair_column(a, b)
  /// Spectra of single periods, kept for checks: the first, the second and the last one averaged.
  Eigen::MatrixXcd first, second, last;

  /// Straight line through the means of the periods, of each signal: its rise from one period to the next, and the sum of squares
  /// around it. Empty: fewer than 3 periods, periods left out, or a drift that was taken off.
  Eigen::VectorXd trend, trend_residual;

  std::vector<std::int64_t> left_out;  ///< periods, counted from 0, that were not averaged

  bool has_noise() const { return degrees_of_freedom > 0.0; }
};

/// The column of the pair of signals a > b in Moments::covariance.
inline Eigen::Index pair_column(Eigen::Index a, Eigen::Index b) { return a * (a - 1) / 2 + b; }

/// The covariance matrix of the mean spectra at a line: signals x signals, Hermitian.
Eigen::MatrixXcd covariance_at(const Moments& moments, Eigen::Index line);

/// A measurement: the moments of each experiment of each realisation, realisation after realisation.
struct Measured {
  Layout layout;
  Eigen::Index period = 0;       ///< N, samples
  Eigen::Index experiments = 1;  ///< of one realisation
  std::vector<Moments> parts;

  std::size_t realisations() const { return parts.size() / static_cast<std::size_t>(experiments); }
  const Moments& part(std::size_t realisation, Eigen::Index experiment) const {
    return parts[realisation * static_cast<std::size_t>(experiments) + static_cast<std::size_t>(experiment)];
  }
  bool has_noise() const {
    for (const Moments& m : parts) {
      if (!m.has_noise()) return false;
    }
    return !parts.empty();
  }
};

}  // namespace bodeflow::spectrum
