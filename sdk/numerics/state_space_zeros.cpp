#include <Eigen/Eigenvalues>
#include <Eigen/Householder>
#include <algorithm>
#include <cmath>

#include "bodeflow/numerics/balance.hpp"
#include "bodeflow/numerics/linear_system.hpp"

namespace bodeflow::numerics {
namespace {

// Of an entry beside the others of its row, column or state space: what elimination leaves of an exact zero.
constexpr double kNothing = 1e-11;

struct Zeros {
  Eigen::VectorXcd values;
  double gain = 0.0;
};

// Where D is zero, a reflection brings C to [0 .. 0 c]: the zeros are those of the system without its last state, whose own
// equation becomes the output. Each such step multiplies the gain by c.
Zeros zeros_of(StateSpace s) {
  const Eigen::VectorXd scales = balancing_scales(s.A);
  s.A = scaled_by(s.A, scales);
  s.B = scales.cwiseInverse().asDiagonal() * s.B;
  s.C = s.C * scales.asDiagonal();
  const double scale = s.A.size() > 0 ? s.A.norm() : 0.0;
  double gain = 1.0, largest = s.C.norm() * s.B.norm() / (scale > 0.0 ? scale : 1.0);
  while (std::abs(s.D(0, 0)) <= kNothing * largest) {
    const Eigen::Index n = s.states();
    if (n == 0) return {};
    // The reflection maps C' onto the last unit vector.
    Eigen::VectorXd v = s.C.transpose().reverse();
    const double norm = v.norm();
    if (!(norm > 0.0)) return {};
    double tau = 0.0, c = 0.0;
    Eigen::VectorXd essential(n - 1);
    v.makeHouseholder(essential, tau, c);
    Eigen::VectorXd full(n);
    full << 1.0, essential;
    const Eigen::VectorXd h = full.reverse();
    s.A -= tau * h * (h.transpose() * s.A);
    s.A -= tau * (s.A * h) * h.transpose();
    s.B -= tau * h * (h.transpose() * s.B);
    gain *= c;
    const Eigen::MatrixXd rest_C = s.A.row(n - 1).head(n - 1), rest_D = s.B.row(n - 1);
    largest = std::max(s.B.norm(), rest_C.norm() * s.B.norm() / (scale > 0.0 ? scale : 1.0));
    s = StateSpace{s.A.topLeftCorner(n - 1, n - 1).eval(), s.B.topRows(n - 1).eval(), rest_C, rest_D, s.sample_time};
  }
  const double d = s.D(0, 0);
  Zeros zeros;
  zeros.gain = gain * d;
  if (s.states() > 0) zeros.values = (s.A - s.B * (s.C / d)).eigenvalues();
  return zeros;
}

}  // namespace

Expected<ZeroPoleGain> to_zero_pole_gain(const StateSpace& system) {
  if (system.inputs() != 1 || system.outputs() != 1)
    return refused("zeros, poles and gain need one input and one output; the system has " + std::to_string(system.inputs()) +
                   " and " + std::to_string(system.outputs()));
  if (!system.A.allFinite() || !system.B.allFinite() || !system.C.allFinite() || !system.D.allFinite())
    return refused("an entry of A, B, C or D is not a finite number");
  const Zeros zeros = zeros_of(system);
  ZeroPoleGain zpk{zeros.values, {}, zeros.gain, system.sample_time};
  if (system.states() > 0) zpk.poles = system.A.eigenvalues();
  return zpk;
}

Expected<TransferFunction> to_transfer_function(const StateSpace& system) {
  const auto zpk = to_zero_pole_gain(system);
  if (!zpk) return tl::make_unexpected(zpk.error());
  return to_transfer_function(*zpk);
}

}  // namespace bodeflow::numerics
