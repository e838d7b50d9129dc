#include "desired_response.hpp"

#include <bodeflow/numerics/discretise.hpp>
#include <bodeflow/numerics/frequency_response.hpp>
#include <bodeflow/numerics/polynomial.hpp>
#include <cmath>
#include <numbers>

#include "numbers_in_text.hpp"
#include "pole_patterns.hpp"

namespace bodeflow::adaptive_control {
namespace {

Expected<Eigen::VectorXcd> stable_roots(const Eigen::VectorXd& polynomial, const char* name) {
  auto found = numerics::roots(polynomial);
  if (!found) return refused(std::string(name) + ": " + found.error().text);
  for (const std::complex<double>& root : *found) {
    if (!(root.real() < 0.0)) {
      return refused(std::string(name) + " has a pole at " + text_of(root) + " rad/s; allowed: the open left half plane");
    }
  }
  return *found;
}

}  // namespace

DesiredResponse scaled(const DesiredResponse& desired, double factor) {
  return {faster(desired.a_m, factor), faster(desired.a_o, factor), desired.delay_s};
}

numerics::TransferFunction undelayed(const DesiredResponse& desired) {
  return {Eigen::VectorXd::Constant(1, desired.a_m[desired.a_m.size() - 1]), desired.a_m, 0.0};
}

Expected<std::vector<std::complex<double>>> sampled_response(const numerics::TransferFunction& plant, double delay_s,
                                                             double sample_time, const std::vector<double>& omega) {
  auto system = numerics::to_state_space(plant);
  if (!system) return refused(system.error().text);
  auto sampled = numerics::zero_order_hold(*system, sample_time, delay_s);
  if (!sampled) return refused(sampled.error().text);
  Eigen::VectorXd hz(static_cast<Eigen::Index>(omega.size()));
  for (std::size_t j = 0; j < omega.size(); ++j) hz[static_cast<Eigen::Index>(j)] = omega[j] / (2.0 * std::numbers::pi);
  const auto lines = numerics::frequency_response(sampled->model, hz);
  std::vector<std::complex<double>> points;
  for (std::size_t j = 0; j < omega.size(); ++j) {
    const double turned = -omega[j] * sample_time * static_cast<double>(sampled->delay);
    points.push_back(lines[j](0, 0) * std::polar(1.0, turned));
    if (!std::isfinite(points.back().real()) || !std::isfinite(points.back().imag())) {
      return refused("no finite response at " + text_of(omega[j]) + " rad/s");
    }
  }
  return points;
}

Expected<std::vector<std::complex<double>>> desired_points(const DesiredResponse& desired, double sample_time,
                                                           const std::vector<double>& omega) {
  const auto poles = stable_roots(desired.a_m, "the desired response");
  if (!poles) return refused(poles.error().text);
  return sampled_response(undelayed(desired), desired.delay_s, sample_time, omega);
}

Expected<Eigen::VectorXd> sampled_observer(const Eigen::VectorXd& a_o, double sample_time) {
  auto poles = stable_roots(a_o, "the observer polynomial");
  if (!poles) return refused(poles.error().text);
  for (std::complex<double>& pole : *poles) pole = std::exp(pole * sample_time);
  return numerics::polynomial_from_roots(*poles);
}

}  // namespace bodeflow::adaptive_control
