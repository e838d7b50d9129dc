#pragma once

#include "effect.hpp"

namespace bodeflow::residual {

/// Saturation of the main flux: the magnetising current is i = psi (1 + (a psi^2 + b psi^4) / (1 + c psi^4)) / Lm, all of a, b, c
/// positive: linear for small flux, then with a third and a fifth power, up to the incremental inductance Lm / (1 + b / c) far
/// beyond the knee. It can be told from a measurement how far the inductance falls, hardly what each of the three is.
class Saturation final : public Effect {
 public:
  std::string name() const override { return "saturation"; }
  std::vector<Parameter> parameters() const override;
  std::vector<Eigen::VectorXd> starts(const Scales& scales) const override;
  std::string sentence(const Eigen::VectorXd& value, const Eigen::VectorXd& std, const Scales& scales) const override;
  bool linear() const override { return false; }
  bool stores() const override { return true; }
  Law extra_stored(const double* p, double flux) const override;
};

}  // namespace bodeflow::residual
