#include "ladder.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <string>

namespace bodeflow::plants {
namespace {

numerics::Expected<void> check(const Ladder& l) {
  const std::size_t n = l.sections();
  if (n == 0) return numerics::refused("a ladder needs at least one section");
  const struct {
    const char* name;
    const std::vector<double>& values;
    bool positive;
  } lists[] = {{"inductance", l.inductance_h, true},
               {"resistance", l.resistance_ohm, false},
               {"turn_capacitance", l.turn_capacitance_f, false},
               {"earth_capacitance", l.earth_capacitance_f, true},
               {"earth_conductance", l.earth_conductance_s, false}};
  for (const auto& list : lists) {
    if (list.values.size() != n)
      return numerics::refused(std::string(list.name) + " has " + std::to_string(list.values.size()) + " values for " +
                               std::to_string(n) + " sections");
    for (const double v : list.values)
      if (!std::isfinite(v) || v < 0.0 || (list.positive && v == 0.0))
        return numerics::refused(std::string(list.name) + (list.positive ? " must be above 0" : " must not be below 0"));
  }
  if (!(l.pick_up_f >= 0.0) || !(l.load_ohm > 0.0)) return numerics::refused("pick_up must not be below 0, load must be above 0");
  return {};
}

}  // namespace

numerics::Expected<numerics::StateSpace> ladder_system(const Ladder& l) {
  if (auto good = check(l); !good) return numerics::refused(good.error().text);
  const auto n = static_cast<Eigen::Index>(l.sections());
  const bool picked = l.pick_up_f > 0.0;
  const Eigen::Index nodes = n + (picked ? 1 : 0);
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(nodes, nodes), loss = M, incidence = Eigen::MatrixXd::Zero(nodes, n);
  Eigen::VectorXd k = Eigen::VectorXd::Zero(nodes);
  for (Eigen::Index i = 0; i < nodes; ++i) {
    const auto s = static_cast<std::size_t>(i);
    const double beside = i < n ? l.turn_capacitance_f[s] : l.pick_up_f;
    M(i, i) += beside;
    if (i > 0) {
      M(i - 1, i - 1) += beside;
      M(i, i - 1) -= beside;
      M(i - 1, i) -= beside;
    } else {
      k[0] = beside;
    }
    if (i == n) {
      loss(i, i) = 1.0 / l.load_ohm;
      continue;
    }
    M(i, i) += l.earth_capacitance_f[s];
    loss(i, i) = l.earth_conductance_s[s];
    incidence(i, i) = 1.0;  // the current of section i enters node i and leaves node i - 1
    if (i > 0) incidence(i - 1, i) = -1.0;
  }
  const Eigen::MatrixXd inverse = M.inverse();
  const Eigen::VectorXd through = inverse * k;
  const Eigen::VectorXd L = Eigen::Map<const Eigen::VectorXd>(l.inductance_h.data(), n);
  const Eigen::VectorXd R = Eigen::Map<const Eigen::VectorXd>(l.resistance_ohm.data(), n);
  // States: voltages less what the input drives through the capacitances, then currents.
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(nodes + n, nodes + n);
  A.topLeftCorner(nodes, nodes) = -inverse * loss;
  A.topRightCorner(nodes, n) = inverse * incidence;
  A.bottomLeftCorner(n, nodes) = -(L.cwiseInverse().asDiagonal() * incidence.transpose());
  A.bottomRightCorner(n, n) = (-R.array() / L.array()).matrix().asDiagonal();
  Eigen::VectorXd B(nodes + n);
  B.head(nodes) = -inverse * loss * through;
  B.tail(n) = -(L.cwiseInverse().asDiagonal() * (incidence.transpose() * through));
  B[nodes] += 1.0 / L[0];
  Eigen::MatrixXd C = Eigen::MatrixXd::Zero(1, nodes + n);
  C(0, nodes - 1) = 1.0;
  return numerics::make_state_space(A, B, C, Eigen::MatrixXd::Constant(1, 1, through[nodes - 1]));
}

}  // namespace bodeflow::plants
