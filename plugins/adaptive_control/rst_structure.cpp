#include <algorithm>
#include <bodeflow/numerics/polynomial.hpp>
#include <cmath>
#include <numbers>

#include "numbers_in_text.hpp"
#include "rst_design.hpp"

namespace bodeflow::adaptive_control {
namespace {

constexpr double kRounding = 1e-7;  // a double root on the unit circle comes back this far outside of it

std::string factor_error(const Eigen::VectorXd& factor, const char* name, int degree) {
  const std::string who = std::string("the prescribed factor of ") + name;
  if (factor.size() == 0 || factor[0] != 1.0) return who + " is not monic";
  if (factor.size() - 1 > degree) {
    return who + " has degree " + std::to_string(factor.size() - 1) + ", " + name + " has " + std::to_string(degree) +
           "; allowed: no more than that";
  }
  const auto roots = numerics::roots(factor);
  if (!roots) return who + ": " + roots.error().text;
  for (const std::complex<double>& root : *roots) {
    if (std::abs(root) > 1.0 + kRounding) {
      return who + " is unstable: it has the root " + text_of(root) + "; allowed: roots inside or on the unit circle";
    }
  }
  return {};
}

std::string points_error(const RstStructure& s) {
  const std::size_t points = s.omega.size();
  if (2 * static_cast<int>(points) < s.unknowns()) {
    return std::to_string(points) + (points == 1 ? " frequency" : " frequencies") + " of fitting for " +
           std::to_string(s.unknowns()) + " unknown parameters; needed: at least " + std::to_string((s.unknowns() + 1) / 2) +
           " (3.27)";
  }
  if (points > static_cast<std::size_t>(kMostPoints)) {
    return std::to_string(points) + " frequencies of fitting; allowed: up to " + std::to_string(kMostPoints);
  }
  const double nyquist = std::numbers::pi / s.sample_time;
  for (std::size_t j = 0; j < points; ++j) {
    if (!(s.omega[j] > 0.0 && s.omega[j] < nyquist)) {
      return "frequency of fitting " + text_of(s.omega[j]) + " rad/s; allowed: above 0 and below the Nyquist frequency " +
             text_of(nyquist) + " rad/s";
    }
    if (std::count(s.omega.begin(), s.omega.end(), s.omega[j]) > 1) {
      return "frequency of fitting " + text_of(s.omega[j]) + " rad/s stands twice";
    }
  }
  if (!s.weights.empty() && s.weights.size() != points) {
    return std::to_string(s.weights.size()) + " weights for " + std::to_string(points) + " frequencies; allowed: one each";
  }
  for (const double v : s.weights) {
    if (!(v > 0.0 && std::isfinite(v))) return "weight " + text_of(v) + "; allowed: above 0";
  }
  return {};
}

}  // namespace

std::string structure_error(const RstStructure& s) {
  if (!(s.sample_time > 0.0 && std::isfinite(s.sample_time))) {
    return "sample time " + text_of(s.sample_time) + " s; allowed: above 0";
  }
  for (const auto& [degree, name] : {std::pair(s.n_r, "R"), std::pair(s.n_s, "S")}) {
    if (degree < 0 || degree > kMostOrder) {
      return std::string("degree of ") + name + " is " + std::to_string(degree) + "; allowed: 0 to " + std::to_string(kMostOrder);
    }
  }
  if (s.n_s > s.n_r) {
    return "degree of S is " + std::to_string(s.n_s) + ", that of R is " + std::to_string(s.n_r) +
           "; allowed: no more than that, or the controller is not causal";
  }
  for (const std::string& error : {factor_error(s.r_p, "R", s.n_r), factor_error(s.s_p, "S", s.n_s)}) {
    if (!error.empty()) return error;
  }
  return points_error(s);
}

}  // namespace bodeflow::adaptive_control
