#include "physical_parameters.hpp"

#include <cmath>

namespace bodeflow::frisch {

IdentifiableParameters identifiable_parameters(const MotorFit& fit) {
  const auto& [gamma, alpha, lm_beta, sigma] = fit.model;
  IdentifiableParameters p;
  p.stator_resistance_ohm = sigma * (gamma - alpha * lm_beta);
  p.stator_inductance_h = sigma * (1.0 + lm_beta);
  p.rotor_time_constant_s = 1.0 / alpha;
  p.leakage_inductance_h = sigma;
  Eigen::Matrix4d slope;                                                      // by gamma, alpha, Lm_beta, sigma
  slope << sigma, -sigma * lm_beta, -sigma * alpha, gamma - alpha * lm_beta,  //
      0.0, 0.0, sigma, 1.0 + lm_beta,                                         //
      0.0, -1.0 / (alpha * alpha), 0.0, 0.0,                                  //
      0.0, 0.0, 0.0, 1.0;
  p.covariance = slope * fit.covariance * slope.transpose();
  return p;
}

EqualInductanceParameters equal_inductance_parameters(const MotorFit& fit) {
  const auto& [gamma, alpha, lm_beta, sigma] = fit.model;
  EqualInductanceParameters p;
  p.stator_resistance_ohm = sigma * (gamma - alpha * lm_beta);
  p.stator_inductance_h = p.rotor_inductance_h = sigma * (1.0 + lm_beta);
  p.rotor_resistance_ohm = alpha * p.rotor_inductance_h;
  const double root = std::sqrt((1.0 + lm_beta) * lm_beta);
  p.mutual_inductance_h = sigma * root;
  Eigen::Matrix<double, 5, 4> slope;
  slope << sigma, -sigma * lm_beta, -sigma * alpha, gamma - alpha * lm_beta,  //
      0.0, p.rotor_inductance_h, alpha * sigma, alpha * (1.0 + lm_beta),      //
      0.0, 0.0, sigma, 1.0 + lm_beta,                                         //
      0.0, 0.0, sigma, 1.0 + lm_beta,                                         //
      0.0, 0.0, sigma * (1.0 + 2.0 * lm_beta) / (2.0 * root), root;
  p.covariance = slope * fit.covariance * slope.transpose();
  return p;
}

Expected<MotorModel> motor_model(double Rs, double Rr, double Ls, double Lr, double Lm) {
  for (const double value : {Rs, Rr, Ls, Lr, Lm}) {
    if (!(value > 0.0) || !std::isfinite(value)) return refused("resistances and inductances must be above 0 and finite");
  }
  const double sigma = Ls - Lm * Lm / Lr;
  if (!(sigma > 0.0)) return refused("Lm^2 must be below Ls Lr: the leakage is not positive");
  MotorModel m;
  m.sigma = sigma;
  m.alpha = Rr / Lr;
  m.lm_beta = Lm * Lm / (sigma * Lr);
  m.gamma = Rs / sigma + m.alpha * m.lm_beta;
  return m;
}

}  // namespace bodeflow::frisch
