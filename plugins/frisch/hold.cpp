#include "hold.hpp"

#include <cmath>
#include <numbers>
#include <string>

namespace bodeflow::frisch {
namespace {

using Complex = std::complex<double>;

constexpr int kTurns = 50;
// Relative change of a parameter: what the search itself leaves; the factors move by a thousandth of it.
constexpr double kRest = 1e-9;

/// Half a step of delay and the fall of the hold: near enough to start with, whatever the motor.
Eigen::VectorXcd first_factor(const Eigen::VectorXd& omega, const Sampling& s) {
  return omega.unaryExpr([&](double w) {
    const double half = 0.5 * w * s.hold_s;
    return std::polar(half > 0.0 ? half / std::sin(half) : 1.0, half + w * s.delay_s);
  });
}

}  // namespace

std::complex<double> held_response(const MotorModel& m, double omega, double hold_s) {
  const Eigen::Vector2d pole = poles(m);
  const Complex z = std::polar(1.0, omega * hold_s);
  Complex g = 0.0;
  for (const auto& [p, other] : {std::pair{pole[0], pole[1]}, std::pair{pole[1], pole[0]}}) {
    const double step = p == 0.0 ? hold_s : std::expm1(p * hold_s) / p;
    g += (p + m.alpha) / (m.sigma * (p - other)) * step / (z - std::exp(p * hold_s));
  }
  return g;
}

Eigen::VectorXcd continuous_factor(const MotorModel& model, const Eigen::VectorXd& omega, const Sampling& s) {
  return omega.unaryExpr([&](double w) {
    const Complex advance = std::polar(1.0, w * s.delay_s);
    return s.hold_s > 0.0 ? advance * response(model, w) / held_response(model, w, s.hold_s) : advance;
  });
}

Expected<MotorFit> fit_behind_hold(const FitToFactors& fit, const Eigen::VectorXd& omega, const Sampling& s) {
  if (omega.size() > 0 && omega.maxCoeff() * s.hold_s >= std::numbers::pi) {
    return refused("a line at " + std::to_string(omega.maxCoeff() / (2.0 * std::numbers::pi)) +
                   " Hz is not below half the rate of the hold, " + std::to_string(0.5 / s.hold_s) + " Hz; is hold right?");
  }
  auto found = fit(first_factor(omega, s));
  if (!found || s.hold_s == 0.0) return found;
  for (int turn = 0; turn < kTurns; ++turn) {
    const Eigen::Array4d before = found->model.vector();
    found = fit(continuous_factor(found->model, omega, s));
    if (!found) return found;
    if ((found->model.vector().array() / before - 1.0).abs().maxCoeff() < kRest) return found;
  }
  return refused("the model behind the hold did not come to rest in " + std::to_string(kTurns) + " turns");
}

}  // namespace bodeflow::frisch
