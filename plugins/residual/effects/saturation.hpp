#pragma once

#include "effect.hpp"

namespace bodeflow::residual {

/// Saturation of the main flux: the magnetising current is i = psi (1 + a psi^2 / (1 + c psi^2)) / Lm: linear for small flux,
/// then with a third power, which c > 0 bends down to the incremental inductance Lm c / (a + c) far beyond the knee, and c < 0
/// bends up.
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
