#include "bodeflow/numerics/bilinear.hpp"

#include <Eigen/LU>
#include <cmath>
#include <limits>

namespace bodeflow::numerics {
namespace {

// Below it the factor 1 / (1 + z) or 1 / (a - s) has lost all digits.
bool singular(const Eigen::PartialPivLU<Eigen::MatrixXd>& lu) { return !(lu.rcond() > std::numeric_limits<double>::epsilon()); }

// C M^-1 of the factored M.
Eigen::MatrixXd right_solve(const Eigen::PartialPivLU<Eigen::MatrixXd>& lu, const Eigen::MatrixXd& C) {
  const Eigen::MatrixXd solved = lu.transpose().solve(Eigen::MatrixXd(C.transpose()));
  return solved.transpose();
}

}  // namespace

Expected<StateSpace> bilinear(const StateSpace& system, double a, double sample_time) {
  if (system.sample_time != 0.0) return refused("the system is already a discrete-time one");
  if (!(a > 0.0) || !std::isfinite(a)) return refused("the bilinear map needs an a above 0");
  if (!(sample_time > 0.0) || !std::isfinite(sample_time)) return refused("the sample time must be above 0");
  StateSpace z = system;
  z.sample_time = sample_time;
  const Eigen::Index n = system.states();
  if (n == 0) return z;
  const Eigen::MatrixXd I = Eigen::MatrixXd::Identity(n, n);
  const Eigen::PartialPivLU<Eigen::MatrixXd> lu(a * I - system.A);
  if (singular(lu)) return refused("the system has a pole at s = a of the bilinear map");
  const double root = std::sqrt(2.0 * a);
  const Eigen::MatrixXd inverse_B = lu.solve(system.B);
  z.A = lu.solve(a * I + system.A);
  z.B = root * inverse_B;
  z.C = root * right_solve(lu, system.C);
  z.D = system.D + system.C * inverse_B;
  if (!z.A.allFinite()) return refused("the system has a pole at s = a of the bilinear map");
  return z;
}

Expected<StateSpace> undo_bilinear(const StateSpace& system, double a) {
  if (system.sample_time == 0.0) return refused("the system is already a continuous-time one");
  if (!(a > 0.0) || !std::isfinite(a)) return refused("the bilinear map needs an a above 0");
  StateSpace s = system;
  s.sample_time = 0.0;
  const Eigen::Index n = system.states();
  if (n == 0) return s;
  const Eigen::MatrixXd I = Eigen::MatrixXd::Identity(n, n);
  const Eigen::PartialPivLU<Eigen::MatrixXd> lu(I + system.A);
  if (singular(lu)) return refused("the system has a pole at z = -1, which the bilinear map takes to infinity");
  const double root = std::sqrt(2.0 * a);
  const Eigen::MatrixXd inverse_B = lu.solve(system.B);
  s.A = a * lu.solve(system.A - I);
  s.B = root * inverse_B;
  s.C = root * right_solve(lu, system.C);
  s.D = system.D - system.C * inverse_B;
  if (!s.A.allFinite()) return refused("the system has a pole at z = -1, which the bilinear map takes to infinity");
  return s;
}

double prewarped(double omega_rad_s, double sample_time) {
  if (omega_rad_s == 0.0) return 2.0 / sample_time;
  return omega_rad_s / std::tan(0.5 * omega_rad_s * sample_time);
}

}  // namespace bodeflow::numerics
