#include "second_order.hpp"

#include <cmath>
#include <numbers>

#include "declared_timing.hpp"
#include "polynomial_start.hpp"

namespace bodeflow::residual {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;
// Of a start where the response does not tell the damping.
constexpr double kUsualDamping = 0.05;

/// "N s/m"; where both units are the same they cancel.
std::string unit_per(const std::string& effort, const std::string& time, const std::string& displacement) {
  if (effort == displacement) return time.empty() ? "1" : time;
  const bool product = displacement.find_first_of(" /*^") != std::string::npos;
  return effort + (time.empty() ? "" : "*" + time) + "/" + (product ? "(" + displacement + ")" : displacement);
}

}  // namespace

void SecondOrder::describe(Describe& d) {
  d.id("residual.second_order")
      .summary("A mass on a spring with a damper, or a resonant circuit: one input, one output, three parameters.");
  d.doc(
      "m x'' + c x' + k x = u, or the same as gain 1 / k, natural frequency sqrt(k / m) / 2 pi and damping ratio c / (2 sqrt(k "
      "m)). Both identify from one input and one output; in units of the input, so k of a circuit is that of its input "
      "voltage. Effects act at its bearing (over x') and its spring (over x) and add to the input's unit.");
  d.parameter("form", "stiffness").choices({"stiffness", "resonance"}).doc("mass, damping, stiffness; or gain, frequency, ratio");
  d.parameter("output", "displacement").choices({"displacement", "velocity", "acceleration"}).doc("what is measured");
  d.parameter("effort_unit", "N").doc("of the input");
  d.parameter("displacement_unit", "m").doc("of x");
  describe_timing(d, Hold::band_limited);
}

void SecondOrder::configure(const Parameters& p) {
  resonance_ = p.text("form") == "resonance";
  const std::string& output = p.text("output");
  output_ = output == "velocity" ? Output::velocity : output == "acceleration" ? Output::acceleration : Output::displacement;
  effort_unit_ = p.text("effort_unit");
  displacement_unit_ = p.text("displacement_unit");
  timing_ = read_timing(p);
}

std::vector<FitParameter> SecondOrder::parameters() const {
  if (resonance_) {
    return {
        positive("gain", unit_per(displacement_unit_, "", effort_unit_)).says("displacement by a steady input, 1 / stiffness"),
        positive("frequency", "Hz").says("natural, without damping"), positive("damping_ratio", "1")};
  }
  return {positive("mass", unit_per(effort_unit_, "s^2", displacement_unit_)),
          positive("damping", unit_per(effort_unit_, "s", displacement_unit_)),
          positive("stiffness", unit_per(effort_unit_, "", displacement_unit_))};
}

std::vector<Place> SecondOrder::places() const {
  const std::string velocity = displacement_unit_ + "/s";
  std::vector<Place> all(2);
  all[0].name = all[0].kind = "bearing";
  all[1].name = all[1].kind = "spring";
  for (Place& p : all) {
    p.flow_unit = velocity;
    p.stored_unit = displacement_unit_;
    p.reaction_unit = effort_unit_;
  }
  return all;
}

std::vector<std::string> SecondOrder::conventions() const { return timing_words(timing_); }

SecondOrder::Coefficients SecondOrder::coefficients(const double* v) const {
  if (!resonance_) return {v[0], v[1], v[2]};
  const double omega = kTwoPi * v[1], stiffness = 1.0 / v[0];
  return {stiffness / (omega * omega), 2.0 * v[2] * stiffness / omega, stiffness};
}

std::vector<double> SecondOrder::values(const Coefficients& c) const {
  if (!resonance_) return {c.mass, c.damping, c.stiffness};
  return {1.0 / c.stiffness, std::sqrt(c.stiffness / c.mass) / kTwoPi, 0.5 * c.damping / std::sqrt(c.stiffness * c.mass)};
}

std::vector<std::vector<double>> SecondOrder::starts(std::span<const MeasuredResponse> measured) const {
  const auto numerator = [this](std::complex<double> s) {
    return output_ == Output::displacement ? 1.0 : output_ == Output::velocity ? s : s * s;
  };
  const MeasuredResponse lines = joined_lines(measured);
  if (lines.frequency_hz.empty()) fail("the records have no line with a response: nothing to start from");
  if (const auto d = denominator_near(measured, numerator, 2)) {
    const Coefficients c{(*d)[2], (*d)[1], (*d)[0]};
    if (c.mass < 0.0 && c.stiffness < 0.0)
      fail("the output moves against the input at low and at high frequencies: check the signs of the signals");
    if (c.mass > 0.0 && c.damping > 0.0 && c.stiffness > 0.0) return {values(c)};
  }
  // The peak of the displacement for its frequency, its lowest line for the stiffness.
  std::size_t peak = 0;
  const auto displacement = [&](std::size_t i) {
    return std::abs(lines.response[i] / numerator({0.0, kTwoPi * lines.frequency_hz[i]}));
  };
  for (std::size_t i = 1; i < lines.frequency_hz.size(); ++i)
    if (displacement(i) > displacement(peak)) peak = i;
  const double omega = kTwoPi * lines.frequency_hz[peak], stiffness = 1.0 / displacement(0);
  const double mass = stiffness / (omega * omega);
  return {values({mass, 2.0 * kUsualDamping * std::sqrt(stiffness * mass), stiffness})};
}

bool SecondOrder::state_space(const double* v, const double* /*known*/, LinearPlant& plant) const {
  const Coefficients c = coefficients(v);
  if (!(c.mass > 0.0) || !(c.stiffness > 0.0) || !(c.damping >= 0.0) || !std::isfinite(c.stiffness / c.mass)) return false;
  plant.resize(2, 1, 2);
  const double k = c.stiffness / c.mass, r = c.damping / c.mass, b = 1.0 / c.mass;
  plant.A = {0.0, 1.0, -k, -r};
  plant.B = {0.0, b};
  plant.E = {0.0, 0.0, -b, -b};
  plant.Cf = {0.0, 1.0, 0.0, 1.0};
  plant.Cs = {1.0, 0.0, 1.0, 0.0};
  if (output_ == Output::displacement) plant.C = {1.0, 0.0};
  if (output_ == Output::velocity) plant.C = {0.0, 1.0};
  if (output_ == Output::acceleration) {
    plant.C = {-k, -r};
    plant.D = {b};
    plant.F = {-b, -b};
  }
  return true;
}

}  // namespace bodeflow::residual
