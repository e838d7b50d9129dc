#pragma once

#include "effect.hpp"

namespace bodeflow::residual {

/// A time by which the output comes late beyond what is declared: y(t - d), exact for any d (Jury's modified z-transform where
/// the input is held). Linear. In an induction motor at standstill it can't be told from a rotor resistance that grows with the
/// square of frequency: with s = j omega both move the impedance, times (s + alpha)^2, within the polynomials of degree 4 that
/// the base parameters and that law span.
class Delay final : public Effect {
 public:
  std::string name() const override { return "delay"; }
  std::vector<Parameter> parameters() const override;
  std::vector<Eigen::VectorXd> starts(const Scales& scales) const override;
  std::string sentence(const Eigen::VectorXd& value, const Eigen::VectorXd& std, const Scales& scales) const override;
  bool linear() const override { return true; }
  double delay_s(const double* p) const override { return p[0]; }
  std::vector<std::string> equivalents() const override { return {"skin_effect"}; }
  std::string separation() const override;
};

}  // namespace bodeflow::residual
