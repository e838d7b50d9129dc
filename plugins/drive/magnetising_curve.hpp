#pragma once

#include <vector>

namespace bodeflow::drive {

/// The magnetising branch psi(i) = lm ((1 - share) i + share isat tanh(i / isat)), as a table.
///
/// A network that sees the branch through an inductance knows M = a i + g psi(i) and needs i. The table holds i / M, an even and
/// smooth function, by cubic Hermite polynomials between 4096 equal steps of M; beyond 20 isat, where tanh is 1, the law is
/// linear and solved as it stands. Largest error 1e-12 of M.
class MagnetisingCurve {
 public:
  MagnetisingCurve() = default;
  /// lm, isat > 0; share from 0 to below 1; a, g >= 0 and not both 0.
  MagnetisingCurve(double lm, double isat, double share, double a, double g);

  /// i / M for M >= 0.
  double current_share(double m) const;

  /// psi(i) by the law itself.
  double flux(double i) const;

 private:
  struct Node {
    double value, slope;  // of i / M, the slope for one step
  };

  double solve(double m, double start) const;

  double lm_ = 1.0, isat_ = 1.0, share_ = 0.0, a_ = 1.0, g_ = 0.0;
  double per_step_ = 0.0;  // 1 / step of M
  double offset_ = 0.0, steepness_ = 1.0;
  std::vector<Node> nodes_;
};

}  // namespace bodeflow::drive
