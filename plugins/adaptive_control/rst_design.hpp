#pragma once

#include <Eigen/Core>
#include <array>
#include <complex>
#include <vector>

#include "desired_response.hpp"
#include "rst.hpp"

namespace bodeflow::adaptive_control {

/// What is to be designed: degrees, prescribed factors and points of fitting.
struct RstStructure {
  double sample_time = 1.0;     ///< h [s]
  std::vector<double> omega;    ///< frequencies of fitting [rad/s], M of them
  int n_r = 2, n_s = 2;         ///< full degrees of R and S, prescribed factors included
  Eigen::VectorXd r_p, s_p;     ///< prescribed factors of R and S, monic, descending powers of z; (z - 1) gives integral action
  std::vector<double> weights;  ///< v_j > 0, one a point; empty: 1

  int n_r_bar() const { return n_r - static_cast<int>(r_p.size()) + 1; }
  int n_s_bar() const { return n_s - static_cast<int>(s_p.size()) + 1; }
  int unknowns() const { return n_r_bar() + n_s_bar() + 2; }
};

/// A designed controller and what the fit says of it.
struct RstResult {
  Rst rst;                                     ///< what the loop runs with: T scaled to S(1) = T(1) under integral action
  double t0 = 0.0;                             ///< gain of T before that scaling
  double residual = 0.0;                       ///< ||psi - Phi theta||, 0 for an interpolating design
  double gain_ratio = 1.0;                     ///< S(1) / T(1) before that scaling; 1 with other structures
  std::array<double, kMostOrder + 1> r_bar{};  ///< R without its prescribed factor, monic, n_r_bar + 1 coefficients
};

/// Fits the closed loop G T / (R + G S) to a desired response at points of the plant's Nyquist curve, in the sense of least
/// squares of the relative error v (G_cl - G_m) / G_cl.
///
/// Method: (3.10)-(3.27) of P.-O. Kallen, Frequency Domain Adaptive Control, Lund 1992. With T = t0 A_o, F_R = G_m R_p / (G A_o),
/// F_S = G_m S_p / A_o and theta = (1, r_1 .. , s_0 ..) / t0 the error is affine, 1 - phi(z) theta; real and imaginary parts of
/// the rows stand one over the other, and Householder reflections solve them (cost 2 M (n + 1)^2 for n unknowns, no allocation).
class RstDesign {
 public:
  /// `g_m`: the desired response at the points. `a_o`: the observer polynomial in z, monic; its degree is that of T.
  /// Errors: fewer than n / 2 points, more than kMostPoints; points outside (0, pi / h) or twice; degrees outside 0 .. kMostOrder
  /// or below those of the prescribed factors; prescribed factors that are not monic or have roots outside the unit circle; an
  /// observer polynomial with roots that are not inside it; a desired response that is not finite or 0; weights not above 0.
  static Expected<RstDesign> make(const RstStructure& structure, const std::vector<std::complex<double>>& g_m,
                                  const Eigen::VectorXd& a_o);

  /// The design for a plant with the response g[j] at point j. False where there is none: a response that is 0 or not finite,
  /// rows without full rank, t0 not above 0. Allocates nothing.
  bool solve(const std::complex<double>* g, RstResult& result) const;

  int points() const { return points_; }
  std::complex<double> z(int j) const { return z_[static_cast<std::size_t>(j)]; }
  std::complex<double> desired(int j) const { return g_m_[static_cast<std::size_t>(j)]; }
  int n_r_bar() const { return n_r_bar_; }
  /// A_o(z), also the anti-windup polynomial.
  const Coefficients& observer() const { return a_o_; }
  int n_t() const { return n_t_; }

 private:
  static constexpr int kMostUnknowns = 2 * kMostOrder + 2;
  static constexpr int kMostRows = 2 * kMostPoints;
  using Point = std::array<std::complex<double>, kMostPoints>;

  void result_of(const double* theta, RstResult& result) const;

  int points_ = 0, n_r_ = 0, n_s_ = 0, n_t_ = 0, n_r_bar_ = 0, n_s_bar_ = 0;
  Coefficients r_p_{}, s_p_{}, a_o_{};
  bool integral_action_ = false;
  Point z_{}, g_m_{};
  std::array<double, kMostPoints> weight_{};
  std::array<std::array<std::complex<double>, kMostOrder + 1>, kMostPoints> r_row_{}, s_row_{};  // v F_R G z^k, v F_S z^k
};

/// What is wrong with the structure, as RstDesign::make says it; nothing if all is right.
std::string structure_error(const RstStructure& structure);

}  // namespace bodeflow::adaptive_control
