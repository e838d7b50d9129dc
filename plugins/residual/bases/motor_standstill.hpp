#pragma once

#include <bodeflow/base_model.hpp>

namespace bodeflow::residual {

/// An induction motor at standstill, one phase (amplitude-invariant Clarke transform, one axis), from stator voltage to stator
/// current, by gamma, alpha, Lm_beta and sigma:
///   G(s) = (s + alpha)/sigma / (s^2 + s (gamma + alpha) + alpha (gamma - alpha Lm_beta))   (17)
/// alpha = Rr/Lr, Lm_beta = Lm^2/(sigma Lr), sigma = Ls - Lm^2/Lr, gamma = Rs/sigma + alpha Lm_beta. The places are those of its
/// T circuit with Ls = Lr, which the stator alone can't tell from any other split of the leakage. Positive Rs is part of the
/// model: gamma > alpha Lm_beta. Reference: P. Castaldi, M. Montanari, A. Tilli, Induction motor model identification via
/// frequency-domain Frisch scheme, IFAC World Congress 2002, equations (16) and (17).
class MotorStandstill final : public BaseModel {
 public:
  static void describe(Describe& d);

  void configure(const Parameters& p) override;
  std::vector<FitParameter> parameters() const override;
  std::vector<Place> places() const override;
  Timing timing() const override;
  std::string response_unit() const override { return "S"; }
  std::vector<std::string> conventions() const override;
  std::vector<std::vector<double>> starts(std::span<const MeasuredResponse> measured) const override;
  bool state_space(const double* v, const double* known, LinearPlant& plant) const override;

 private:
  std::string input_ = "command";
  double computation_delay_s_ = 0.0;
};

}  // namespace bodeflow::residual
