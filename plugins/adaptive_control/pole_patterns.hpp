#pragma once

#include <Eigen/Core>

/// Characteristic polynomials in s for desired responses and observers, monic, in descending powers (sections 7.3 and 8 of
/// P.-O. Kallen, Frequency Domain Adaptive Control, Lund 1992). Orders are 1 to 20, `omega` [rad/s] is above 0.
namespace bodeflow::adaptive_control {

/// Bess(n, omega) (7.6): the Bessel polynomial theta_n(s) = sum_k (n+k)! / ((n-k)! k! 2^k) s^(n-k), scaled so that the product of
/// the roots has the magnitude omega^n. Its step response has next to no overshoot.
Eigen::VectorXd bessel(int order, double omega);

/// Butt(n, omega, alpha) (7.5): roots omega exp(i (pi + phi)), phi evenly spread over [-alpha, alpha]; order 1 has its root at
/// -omega. `alpha` [rad] lies in [0, pi / 2).
Eigen::VectorXd butterworth(int order, double omega, double alpha);

/// Bess(2, omega) Bess(n - 2, ratio omega): two dominant poles, the others `ratio` (2 to 4) times as fast (7.3). Order 2 has the
/// dominant poles alone, order 1 is s + omega.
Eigen::VectorXd dominant_poles(int order, double omega, double ratio);

/// (s + omega)^n
Eigen::VectorXd real_poles(int order, double omega);

/// The polynomial whose roots are those of `polynomial` times `factor`: as fast again by it.
Eigen::VectorXd faster(const Eigen::VectorXd& polynomial, double factor);

}  // namespace bodeflow::adaptive_control
