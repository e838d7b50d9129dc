#include "drag.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

void Drag::describe(bodeflow::DescribeEffect& d) {
  d.id("@NAME@.drag").summary("A fluid brakes with the square of the velocity.").doc("F = k v |v|");
  d.acts(bodeflow::Acts::law, {"bearing"});
}

// k is positive by nature. The fit sets out where drag is a tenth of the largest force in the records.
std::vector<bodeflow::FitParameter> Drag::parameters(const bodeflow::Situation& s) const {
  return {bodeflow::positive("k", s.place.reaction_unit + "/(" + s.place.flow_unit + ")^2")};
}

std::vector<std::vector<double>> Drag::starts(const bodeflow::Situation& s) const {
  const double force = std::max(s.place.effort, 1e-12), velocity = std::max(s.place.flow, 1e-12);
  return {{0.1 * force / (velocity * velocity)}};
}

std::string Drag::sentence(std::span<const double> value, std::span<const double> std, const bodeflow::Situation&) const {
  char text[160];
  std::snprintf(text, sizeof text, "drag of a fluid, k = %.4g (+-%.2g)", value[0], std[0]);
  return text;
}

// The reaction and its slope over the velocity, which helps the solver.
bodeflow::Reaction Drag::react(const double* p, const bodeflow::Signals& s, const double*, double*) const {
  return {p[0] * s.flow * std::abs(s.flow), 2.0 * p[0] * std::abs(s.flow), 0.0};
}
