#include "motor_network.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <string>

#include "records/signals.hpp"

namespace bodeflow::drive {
namespace {

using numerics::refused;
using records::short_number;

constexpr Eigen::Index kEddyLoops = 4;  // R z coth z within 1e-5 up to |z| = 4: a bar of 30 mm up to 83 Hz
constexpr double kVacuumPermeability = 4e-7 * 3.14159265358979323846;

/// The eddy loops behind the rotor loop: loop k shares the inductor R tau / (4 k - 1) with the one before.
void add_bars(const MotorParameters& p, const HiddenPhysics& hidden, MotorNetwork& network) {
  const double bar = hidden.bar_share * p.rr;
  const double tau = kVacuumPermeability * hidden.bar_conductivity * hidden.bar_height * hidden.bar_height;
  for (Eigen::Index k = 1; k <= kEddyLoops; ++k) {
    const Eigen::Index loop = 1 + k;
    const double shared = bar * tau / static_cast<double>(4 * k - 1);
    if (k > 1) network.inductance(loop - 1, loop - 1) += shared;
    network.inductance(loop, loop) += shared;
    network.inductance(loop, loop - 1) -= shared;
    network.inductance(loop - 1, loop) -= shared;
    network.resistance[loop] = bar * static_cast<double>(4 * k + 1);
  }
}

void add_iron_loss(const MotorParameters& p, const HiddenPhysics& hidden, MotorNetwork& network) {
  const Eigen::Index iron = network.loops() - 1;
  network.inductance(iron, iron) = p.lm;
  for (const Eigen::Index winding : {Eigen::Index{0}, Eigen::Index{1}}) {
    network.inductance(iron, winding) = network.inductance(winding, iron) = -p.lm;
  }
  network.resistance[iron] = hidden.iron_loss_resistance;
  network.magnetises[iron] = -1.0;
}

}  // namespace

numerics::Expected<MotorNetwork> motor_network(const MotorParameters& p, const HiddenPhysics& hidden) {
  const bool bars = hidden.bar_height > 0.0, iron = hidden.iron_loss_resistance > 0.0;
  const Eigen::Index loops = 2 + (bars ? kEddyLoops : 0) + (iron ? 1 : 0);
  MotorNetwork network;
  network.inductance = LoopMatrix::Zero(loops, loops);
  network.inductance.topLeftCorner(2, 2) << p.ls, p.lm, p.lm, p.lr;
  network.resistance = LoopVector::Zero(loops);
  network.resistance.head(2) << p.rs, p.rr;
  network.magnetises = LoopVector::Zero(loops);
  network.magnetises.head(2).setOnes();
  network.lm = p.lm;
  network.rotor_loops = bars ? 1 + static_cast<int>(kEddyLoops) : 1;
  network.iron = iron;
  if (bars) add_bars(p, hidden, network);
  if (iron) add_iron_loss(p, hidden, network);
  if (network.inductance.llt().info() == Eigen::Success) return network;
  if (iron && !(p.ls > p.lm && p.lr > p.lm)) {
    return refused("iron loss needs leakage on both sides: ls = " + short_number(p.ls) + " H and lr = " + short_number(p.lr) +
                   " H, allowed: above lm = " + short_number(p.lm) + " H");
  }
  return refused("bar_height = " + short_number(hidden.bar_height) + " m: slots of that height have more leakage than the " +
                 short_number(inverse_gamma_form(p).leakage) + " H of the whole motor");
}

LoopMatrix saturated_inductance(const MotorNetwork& network, double share) {
  return network.inductance - (1.0 - share) * network.lm * network.magnetises * network.magnetises.transpose();
}

Modes modes_of(const LoopMatrix& inductance, const LoopVector& resistance) {
  const LoopMatrix diagonal = resistance.asDiagonal();
  const Eigen::GeneralizedSelfAdjointEigenSolver<LoopMatrix> solver(diagonal, inductance);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

}  // namespace bodeflow::drive
