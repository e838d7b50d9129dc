#include "closed_loop.hpp"

#include <bodeflow/numerics/discretise.hpp>
#include <bodeflow/numerics/polynomial.hpp>
#include <cmath>
#include <numbers>

namespace bodeflow::adaptive_control {
namespace {

Eigen::VectorXd polynomial_of(const Coefficients& c, int n) {
  return Eigen::Map<const Eigen::VectorXd>(c.data(), static_cast<Eigen::Index>(n) + 1);
}

Eigen::VectorXd sum(const Eigen::VectorXd& p, const Eigen::VectorXd& q) {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(std::max(p.size(), q.size()));
  result.tail(p.size()) += p;
  result.tail(q.size()) += q;
  return result;
}

struct Loop {
  Eigen::VectorXd open, closed;  // B S and A R

  std::complex<double> gain(double w_h) const {
    const std::complex<double> z = std::polar(1.0, w_h);
    return numerics::evaluate(open, z) / numerics::evaluate(closed, z);
  }
  double sensitivity(double w_h) const { return 1.0 / std::abs(1.0 + gain(w_h)); }
};

constexpr int kGrid = 4000;

double angle_of(int i) { return std::numbers::pi * std::pow(1e-4, 1.0 - static_cast<double>(i) / kGrid); }

double largest_sensitivity(const Loop& loop) {
  int best = 0;
  double largest = 0.0;
  for (int i = 0; i <= kGrid; ++i) {
    const double found = loop.sensitivity(angle_of(i));
    if (found > largest) largest = found, best = i;
  }
  double low = angle_of(std::max(best - 1, 0)), high = angle_of(std::min(best + 1, kGrid));
  const double golden = 0.5 * (std::sqrt(5.0) - 1.0);
  for (int i = 0; i < 40; ++i) {
    const double left = high - golden * (high - low), right = low + golden * (high - low);
    (loop.sensitivity(left) > loop.sensitivity(right) ? high : low) =
        loop.sensitivity(left) > loop.sensitivity(right) ? right : left;
  }
  return std::max(largest, loop.sensitivity(0.5 * (low + high)));
}

double least_gain_margin(const Loop& loop) {
  double least = 0.0;
  std::complex<double> before = loop.gain(angle_of(0));
  for (int i = 1; i <= kGrid; ++i) {
    const std::complex<double> now = loop.gain(angle_of(i));
    if (before.imag() * now.imag() < 0.0) {
      const double share = before.imag() / (before.imag() - now.imag());
      const double at = before.real() + share * (now.real() - before.real());
      if (at < 0.0 && at > -1.0 && (least == 0.0 || -1.0 / at < least)) least = -1.0 / at;
    }
    before = now;
  }
  return least;
}

}  // namespace

Expected<SampledPlant> sampled_plant(const numerics::TransferFunction& plant, double delay_s, double sample_time) {
  auto system = numerics::to_state_space(plant);
  if (!system) return refused(system.error().text);
  auto held = numerics::zero_order_hold(*system, sample_time, delay_s);
  if (!held) return refused(held.error().text);
  auto sampled = numerics::to_transfer_function(held->model);
  if (!sampled) return refused(sampled.error().text);
  SampledPlant result{numerics::trimmed(sampled->numerator), sampled->denominator};
  result.b /= result.a[0];
  result.a /= result.a[0];
  const Eigen::Index degree = result.a.size();
  result.a.conservativeResize(degree + held->delay);
  result.a.tail(held->delay).setZero();
  return result;
}

Expected<LoopQuality> loop_quality(const SampledPlant& plant, const Rst& c) {
  const Loop loop{numerics::multiply(plant.b, polynomial_of(c.s, c.n_s)), numerics::multiply(plant.a, polynomial_of(c.r, c.n_r))};
  auto poles = numerics::roots(sum(loop.open, loop.closed));
  if (!poles) return refused(poles.error().text);
  LoopQuality quality;
  quality.poles = *poles;
  if (poles->size() > 0) quality.largest_pole = poles->cwiseAbs().maxCoeff();
  quality.sensitivity = largest_sensitivity(loop);
  quality.gain_margin = least_gain_margin(loop);
  const auto controller = numerics::roots(polynomial_of(c.r, c.n_r));
  if (controller && controller->size() > 0) quality.controller_pole = controller->real().minCoeff();
  return quality;
}

}  // namespace bodeflow::adaptive_control
