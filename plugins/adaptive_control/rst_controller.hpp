#pragma once

#include <limits>

#include "rst.hpp"

namespace bodeflow::adaptive_control {

/// The time-varying controller with anti-windup (6.3): A_ar u = (A_ar - R) u_l - S y + T u_c, u_l = u within its limits, written
/// in the past signals alone. A_ar is monic and has the degree of R; its roots are how fast the controller's states follow a
/// limited signal. With R(1) = 0 and S(1) = T(1) other coefficients change nothing at rest.
class RstController {
 public:
  RstController() = default;
  RstController(double least, double most) : least_(least), most_(most) {}

  /// u_l(k). Allocates nothing.
  double step(double y, double u_c, const Rst& c, const Coefficients& a_ar) {
    push(y_, y);
    push(u_c_, u_c);
    double u = 0.0;
    for (std::size_t i = 1; i <= static_cast<std::size_t>(c.n_r); ++i) {
      u += (a_ar[i] - c.r[i]) * limited_[i - 1] - a_ar[i] * u_[i - 1];
    }
    const auto late_s = static_cast<std::size_t>(c.n_r - c.n_s), late_t = static_cast<std::size_t>(c.n_r - c.n_t);
    for (std::size_t i = 0; i <= static_cast<std::size_t>(c.n_s); ++i) u -= c.s[i] * y_[late_s + i];
    for (std::size_t i = 0; i <= static_cast<std::size_t>(c.n_t); ++i) u += c.t[i] * u_c_[late_t + i];
    const double limited = u < least_ ? least_ : u > most_ ? most_ : u;
    push(u_, u);
    push(limited_, limited);
    return limited;
  }

  /// u(k) before its limits.
  double unlimited() const { return u_[0]; }
  bool saturated() const { return u_[0] != limited_[0]; }
  /// 1 where u_l is at its greatest value, -1 at its least, else 0.
  int at_limit() const { return limited_[0] >= most_ ? 1 : limited_[0] <= least_ ? -1 : 0; }
  void reset() { *this = RstController(least_, most_); }

 private:
  using Past = std::array<double, kMostOrder + 1>;
  static void push(Past& past, double value) {
    for (std::size_t i = past.size() - 1; i > 0; --i) past[i] = past[i - 1];
    past[0] = value;
  }

  double least_ = -std::numeric_limits<double>::infinity();
  double most_ = std::numeric_limits<double>::infinity();
  Past y_{}, u_c_{}, u_{}, limited_{};
};

}  // namespace bodeflow::adaptive_control
