#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "bodeflow/numerics/error.hpp"

/// Small dense nonlinear least squares, up to some tens of parameters.
namespace bodeflow::numerics {

/// Residuals r(p) and their Jacobian J(p) = dr/dp. Complex residuals stand as real parts, then imaginary parts. A residual that
/// is not finite marks parameters outside the domain: the step is shortened.
struct LeastSquaresProblem {
  Eigen::Index residuals = 0;
  std::function<void(const Eigen::VectorXd& parameters, Eigen::VectorXd& residual)> residual;
  std::function<void(const Eigen::VectorXd& parameters, Eigen::MatrixXd& jacobian)> jacobian;
};

struct LeastSquaresLimits {
  int evaluations = 1000;
  double tolerance = 1e-13;  ///< relative, of the cost and of the parameters; parameters are good to about its square root times
                             ///< their standard deviation
};

/// Where the search ended.
struct LeastSquaresFit {
  Eigen::VectorXd parameters;
  Eigen::VectorXd residual;
  Eigen::MatrixXd jacobian;
  double cost = 0.0;  ///< |r|^2
  int evaluations = 0;
  bool converged = false;
  std::string reason;  ///< in words, why the search ended
};

/// A local minimum of |r(p)|^2 from `start`. A search that used up its evaluations is returned with converged = false.
///
/// Method: Levenberg-Marquardt with a trust region scaled by the columns of J (J. J. More, "The Levenberg-Marquardt algorithm:
/// implementation and theory", Lecture Notes in Mathematics 630, 1978): MINPACK's lmder as ported in Eigen. It needs nothing
/// beyond Eigen, and for the dense problems of a few parameters here a general solver has nothing to add: no bounds (positive
/// parameters are fitted as logarithms), no sparsity, no loss functions. Cost: one QR factorisation of J a step, O(residuals *
/// parameters^2). Errors: fewer residuals than parameters; a start at which a residual or the Jacobian is not finite.
Expected<LeastSquaresFit> levenberg_marquardt(const LeastSquaresProblem& problem, const Eigen::VectorXd& start,
                                              const LeastSquaresLimits& limits = {});

/// (J^T J)^-1, the covariance of the parameters where the residuals are independent with unit variance.
/// Method: SVD of J with columns of unit length. Errors: a smallest singular value below 1e-10 of the greatest means that the
/// data leave a combination of parameters free; the text names the one that takes the greatest part in it. names: of the
/// parameters, for that text; empty: numbers from 1.
Expected<Eigen::MatrixXd> inverse_normal_matrix(const Eigen::MatrixXd& jacobian, const std::vector<std::string>& names = {});

}  // namespace bodeflow::numerics
