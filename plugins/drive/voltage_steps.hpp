#pragma once

#include <array>

#include "pwm.hpp"

namespace bodeflow::drive {

/// A PWM period as intervals of constant voltage.
struct VoltageSteps {
  static constexpr std::size_t kMost = 7;
  std::array<double, kMost> length{};  ///< [s]
  std::array<AlphaBeta, kMost> voltage{};
  std::size_t count = 0;
};

/// The intervals between the instants of three legs, each at `link` volts between its instants, else at 0. The instants lie
/// from 0 to `period_s`.
inline VoltageSteps voltage_steps(const std::array<Pulse, 3>& legs, double link, double period_s) {
  struct Edge {
    double at;
    AlphaBeta change;
  };
  const std::array<AlphaBeta, 3> unit = {clarke(1, 0, 0), clarke(0, 1, 0), clarke(0, 0, 1)};
  std::array<Edge, 6> edges;
  std::size_t known = 0;
  const auto insert = [&](double at, AlphaBeta change) {
    std::size_t place = known++;
    for (; place > 0 && edges[place - 1].at > at; --place) edges[place] = edges[place - 1];
    edges[place] = {at, change};
  };
  for (std::size_t leg = 0; leg < 3; ++leg) {
    insert(legs[leg].on, {link * unit[leg].alpha, link * unit[leg].beta});
    insert(legs[leg].off, {-link * unit[leg].alpha, -link * unit[leg].beta});
  }
  VoltageSteps steps;
  AlphaBeta v;
  double from = 0.0;
  for (const Edge& edge : edges) {
    if (edge.at > from) {
      steps.length[steps.count] = edge.at - from;
      steps.voltage[steps.count++] = v;
      from = edge.at;
    }
    v.alpha += edge.change.alpha;
    v.beta += edge.change.beta;
  }
  steps.length[steps.count] = period_s - from;
  steps.voltage[steps.count++] = {};
  return steps;
}

}  // namespace bodeflow::drive
