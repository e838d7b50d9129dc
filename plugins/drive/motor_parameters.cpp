#include "motor_parameters.hpp"

#include <cmath>
#include <string>

#include "records/signals.hpp"

namespace bodeflow::drive {
namespace {

using numerics::Expected;
using numerics::refused;
using records::short_number;

}  // namespace

Expected<MotorParameters> checked(const MotorParameters& p) {
  const struct {
    const char* name;
    double value;
  } all[] = {{"rs", p.rs}, {"rr", p.rr}, {"ls", p.ls}, {"lr", p.lr}, {"lm", p.lm}};
  for (const auto& [name, value] : all) {
    if (!(value > 0.0) || !std::isfinite(value)) {
      return refused(std::string("the motor has ") + name + " = " + short_number(value) + ", allowed: positive numbers");
    }
  }
  if (!(p.lm * p.lm < p.ls * p.lr)) {
    return refused("the motor has lm = " + short_number(p.lm) +
                   " H, allowed: less than sqrt(ls lr) = " + short_number(std::sqrt(p.ls * p.lr)) + " H");
  }
  return p;
}

ModelConstants constants_of(const MotorParameters& p) {
  ModelConstants c;
  c.alpha = p.rr / p.lr;
  c.sigma = p.ls - p.lm * p.lm / p.lr;
  c.beta = p.lm / (c.sigma * p.lr);
  c.lm_beta = p.lm * c.beta;
  c.gamma = p.rs / c.sigma + c.alpha * c.lm_beta;
  return c;
}

TForm t_form(const MotorParameters& p) { return {p.rs, p.rr, p.ls - p.lm, p.lr - p.lm, p.lm}; }

InverseGammaForm inverse_gamma_form(const MotorParameters& p) {
  const double ratio = p.lm / p.lr;
  return {p.rs, p.rr * ratio * ratio, p.ls - p.lm * ratio, p.lm * ratio};
}

Expected<MotorParameters> from_constants(const ModelConstants& c) {
  MotorParameters p;
  if (c.lm_beta > 0 && c.beta > 0) {
    p.lm = c.lm_beta / c.beta;
    p.lr = p.lm / (c.beta * c.sigma);
  } else if (c.lm_beta > 0) {
    p.lr = c.sigma * (1.0 + c.lm_beta);
    p.lm = std::sqrt(p.lr * c.sigma * c.lm_beta);
  } else if (c.beta > 0) {
    const double coupling = c.beta * c.sigma;  // Lm / Lr
    if (!(coupling < 1.0)) return refused("beta sigma = " + short_number(coupling) + ", allowed: below 1, where Ls = Lr");
    p.lr = c.sigma / (1.0 - coupling * coupling);
    p.lm = coupling * p.lr;
  } else {
    return refused("beta or lm_beta is missing");
  }
  p.ls = c.sigma + p.lm * p.lm / p.lr;
  p.rr = c.alpha * p.lr;
  const double feedback = c.alpha * p.lm * p.lm / (c.sigma * p.lr);  // alpha Lm beta
  p.rs = c.sigma * (c.gamma - feedback);
  if (!(c.gamma > feedback)) {
    return refused("gamma = " + short_number(c.gamma) + " 1/s, allowed: above alpha Lm beta = " + short_number(feedback) +
                   " 1/s, or Rs is not positive");
  }
  return checked(p);
}

Expected<MotorParameters> from_t_form(const TForm& t) {
  return checked({t.rs, t.rr, t.stator_leakage + t.lm, t.rotor_leakage + t.lm, t.lm});
}

Expected<MotorParameters> from_inverse_gamma(const InverseGammaForm& g) {
  return checked({g.rs, g.rotor_resistance, g.leakage + g.magnetising, g.magnetising, g.magnetising});
}

double torque_constant(const MotorParameters& p) { return 1.5 * p.lm / p.lr; }

}  // namespace bodeflow::drive
