#pragma once

#include <Eigen/Core>
#include <vector>

#include "basis.hpp"
#include "spectra.hpp"
#include "structure.hpp"

namespace bodeflow::maximum_likelihood {

/// The spectra of one output as the free part of a model meets them: fixed poles stand in Y, a hold in U.
struct Channel {
  Eigen::VectorXcd input, output;
  Eigen::VectorXd input_variance, output_variance;
  Eigen::VectorXcd covariance;
};

/// The points at which a model is evaluated, and the data there.
struct Lines {
  Eigen::VectorXd omega_rad_s;
  Eigen::VectorXd weight;   ///< 1, or 1/2 where spectra are real
  double scale = 1.0;       ///< x = s / scale, or z
  Eigen::VectorXcd points;  ///< x_k
  std::vector<Channel> channels;

  Eigen::Index size() const { return omega_rad_s.size(); }
};

/// The point x of a domain where a frequency lies.
std::complex<double> point_at(double omega_rad_s, Domain domain, double sample_time_s, double scale);

/// The lines of `spectra` for the free part of a model. Errors: a line that lies on a fixed pole.
Expected<Lines> lines_for(const Spectra& spectra, const Structure& structure);

/// Where the free polynomials of a model are expanded.
struct Bases {
  Basis denominator;
  std::vector<Basis> numerators;

  Eigen::Index size() const;
  Eigen::Index offset(std::size_t output) const;  ///< of the numerator's coefficients, after those of the denominator
};

/// A model with free coefficients theta = [denominator; numerators] in some bases, up to a common factor.
struct Estimate {
  Bases bases;
  Eigen::VectorXd theta;
  double delay_s = 0.0;

  Eigen::VectorXcd denominator() const { return bases.denominator.values() * theta.head(bases.denominator.size()); }
  /// Without the delay.
  Eigen::VectorXcd numerator(std::size_t output) const;
};

/// Bases whose columns, times the data and divided by `deviation` (lines x outputs, of the equation errors A Y - B U), are
/// orthonormal. Errors: those of Basis::orthonormal.
Expected<Bases> bases_for(const Lines& lines, const Structure& structure, const Eigen::MatrixXd& deviation);

/// exp(-j omega_k delay).
Eigen::VectorXcd delay_factor(const Lines& lines, double delay_s);

/// The variance of A Y_i - B_i U, lines x outputs: |A|^2 var Y + |B|^2 var U - 2 Re(A conj(B exp(-s delay)) cov).
Eigen::MatrixXd spread(const Lines& lines, const Estimate& estimate);

/// (A Y_i - B_i U exp(-s delay)) / sqrt(spread), times the root of the line's weight, lines x outputs: the normalised residuals,
/// whose squares sum up to the cost.
Eigen::MatrixXcd residuals(const Lines& lines, const Estimate& estimate);

/// The direction in the complex plane in which an error of G turns the residual of that line, lines x outputs.
Eigen::MatrixXcd error_directions(const Lines& lines, const Structure& structure, const Estimate& estimate);

/// Derivatives of the residuals, output by output, by theta and, in the last column, by the delay.
Eigen::MatrixXcd jacobian(const Lines& lines, const Estimate& estimate);

/// The same where the true input were what the model makes of it, U less its estimated noise, and the residual 0: the part that
/// carries information, for the Fisher matrix. With noise on the input `jacobian` is larger by that noise.
Eigen::MatrixXcd information_root(const Lines& lines, const Estimate& estimate);

/// |residuals|^2, summed.
double cost(const Lines& lines, const Estimate& estimate);

/// Real and imaginary parts one after the other.
Eigen::MatrixXd stacked(const Eigen::MatrixXcd& m);

}  // namespace bodeflow::maximum_likelihood
