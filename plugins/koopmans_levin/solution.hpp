#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "factors.hpp"

/// Identification of a discrete-time model from records of input and output that both carry white noise, with or without
/// periodicity, where the ratio of the noise variances is known: the Koopmans-Levin method over the lines of a band.
namespace bodeflow::koopmans_levin {

/// Covariance of the noise part of the equations.
enum class NoiseMatrix {
  exact,    ///< diag(ratio T_W, T_W, 0), right for every band
  identity  ///< diag(ratio I, I, 0), as printed (Remark 4 of the paper): right for the full range only. For comparison: on a band
            ///< the estimate is biased and the noise variance far too small.
};

/// A(z^-1) y = B(z^-1) u, A = 1 + a_1 z^-1 + .. + a_n z^-n, B = b_0 + .. + b_n z^-n.
struct Model {
  double ratio = 1.0;   ///< output noise variance / input noise variance, as given
  Eigen::VectorXd a;    ///< 1, a_1 .. a_n
  Eigen::VectorXd b;    ///< b_0 .. b_n
  Eigen::VectorXd tau;  ///< tau_0 .. tau_(n-1), empty without transient
  double noise = 0.0;   ///< lambda_u, the input noise variance as the method gives it: too small by the parameters it fitted
  double noise_unbiased = 0.0;  ///< lambda_u / (1 - free parameters / real equations)

  Eigen::Index order() const { return b.size() - 1; }
};

/// A Koopmans-Levin model with the basis of its eigenvalue problem, from which covariances and ratios follow.
struct Solution : Model {
  NoiseMatrix noise_matrix = NoiseMatrix::exact;
  Eigen::VectorXd x;        ///< [a_n .. a_1 1 | -b_n .. -b_0]
  Eigen::VectorXd squares;  ///< generalised eigenvalues of (Sigma, Lambda), descending; the last one is `noise`
  Eigen::MatrixXd basis;    ///< their vectors in columns, basis^T Lambda basis = I
};

/// The model of smallest noise: Sigma x = lambda Lambda x for the smallest lambda, x scaled so that A begins with 1.
///
/// Method: the transient is eliminated by QR, M = R22 C^-1 with C = blkdiag(sqrt(ratio) noise, noise), lambda = the smallest
/// singular value of M squared, x = C^-1 v. Sigma itself is never formed: right down to noise of 1e-8 of the signal.
/// Assumptions: white noise on both signals, independent of each other and of the signal; the ratio known. A ratio that is
/// wrong by a factor 2 moves estimates by one to two standard deviations at 1000 samples; coloured noise biases them (see
/// whiteness.hpp, ratio_sensitivity.hpp). Consistent, not efficient: maximum_likelihood.hpp scatters less.
/// Reference: U. Soverini, G. Catania, "FRF parameter identification with arbitrary input sequence from noisy input-output
/// measurements", 2015; for time domain K. V. Fernando, H. Nicholson, IEE Proc. D 132 (1985) 30.
/// Cost: O(n^3), so a sweep over ratios is cheap. Errors: a ratio that is not positive and finite; data that leave more than one
/// model (input without enough lines, order too high for data without noise); a model without the term 1 in A.
Expected<Solution> solve(const Factors& factors, double ratio, NoiseMatrix noise_matrix = NoiseMatrix::exact);

/// "a1" .. "an", "b0" .. "bn": the order of parameters in covariances.
std::vector<std::string> parameter_names(Eigen::Index order);

/// a_1 .. a_n, b_0 .. b_n.
Eigen::VectorXd parameters(const Model& model);

/// The response B/A at omega [rad/sample].
Eigen::VectorXcd response(const Model& model, const Eigen::VectorXd& omega);

/// The equation errors A Y - B U - T at the lines.
Eigen::VectorXcd equation_errors(const Lines& lines, const Model& model);

/// Their variance E|A Y - B U - T|^2 = noise (ratio |A|^2 + |B|^2).
Eigen::VectorXd equation_variances(const Lines& lines, const Model& model);

}  // namespace bodeflow::koopmans_levin
