#pragma once

#include <Eigen/Core>
#include <functional>

#include "solution.hpp"

namespace bodeflow::koopmans_levin {

/// How much each line moves a solution: the first-order change of the estimate by the noise at that line.
///
/// With the estimating equations (Sigma - lambda Lambda) x = 0 and the share of line k in them,
///   f_k = w_k/L [Re(phi_k^H eps_k) - lambda Lambda_k x],  E f_k = 0,
/// Lambda_k = diag(ratio C_k, C_k), C_k(i,j) = cos((i-j) w_k), the solution moves by
///   dx = -sum_i basis_i (basis_i^T f_k) / (squares_i - lambda), rescaled to keep A at 1 + ..,
///   d lambda = x^T f_k / x^T Lambda x.
/// Shares of different lines are independent for white noise, so sums of their squares are covariances (sandwich estimator):
/// also for noise that is not normal, and with the noise-noise terms that a linearisation around clean data leaves out.
/// Assumption: the band has several times as many lines as there are parameters.
class Influence {
 public:
  /// Keeps references: both arguments outlive it. Errors: a solution with the identity as noise matrix of a band, whose equations
  /// are not zero in the mean.
  static Expected<Influence> of(const Lines& lines, const Factors& factors, const Solution& solution);

  /// What one line gives.
  struct Line {
    Eigen::VectorXd change;      ///< of [a_n .. a_1 1 | -b_n .. -b_0] (0 at the 1), then of lambda: 2n + 3 entries
    std::complex<double> error;  ///< eps_k = A Y - B U - T
    Eigen::VectorXcd row;        ///< phi_k, the transient eliminated: eps_k = row . x
    double variance = 0.0;       ///< lambda (ratio |A|^2 + |B|^2)
    std::complex<double> A, B;
    Eigen::VectorXcd powers;  ///< z^n .. 1
  };
  void for_each(const std::function<void(Eigen::Index line, const Line&)>& visit) const;

 private:
  Influence(const Lines& lines, const Factors& factors, const Solution& solution);

  const Lines& lines_;
  const Solution& solution_;
  Eigen::MatrixXd transient_from_x_;  // R11^-1 R12
  Eigen::MatrixXd change_from_share_;
  Eigen::RowVectorXd noise_from_share_;
};

/// The change vector of `Influence` in the order a_1 .. a_n, b_0 .. b_n, lambda.
Eigen::VectorXd in_parameter_order(const Eigen::VectorXd& change);

/// The covariance of a_1 .. a_n, b_0 .. b_n, lambda_u: (2n+2) x (2n+2). The ratio counts as known.
/// Cost: O(lines n^2). Errors: those of Influence::of.
Expected<Eigen::MatrixXd> covariance(const Lines& lines, const Factors& factors, const Solution& solution);

}  // namespace bodeflow::koopmans_levin
