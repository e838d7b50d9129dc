#include "drive_axis.hpp"

#include <cmath>
#include <numbers>

#include "declared_timing.hpp"
#include "polynomial_start.hpp"

namespace bodeflow::residual {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;

}  // namespace

void DriveAxis::describe(Describe& d) {
  d.id("residual.drive_axis")
      .summary("An axis moved by a motor of known force constant against viscous friction: mass and friction are fitted.");
  d.doc(
      "M dv/dt + F v = f u with the declared force constant f. The position integrates the velocity, so errors of a simulated "
      "position grow with time; `inverse` turns the model round: from the measured position to the force (u f), "
      "without any state. The derivatives of the position come from a low-pass filter applied forth and back (no phase); "
      "its corner `filter` is declared, and the force passes the same filter, as the reactions of effects do. A command that is "
      "held "
      "acts half a sample later in the mean: with `inverse` declare that as `delay`, too. Effects act at the bearing, over the "
      "velocity and the position.");
  d.parameter("motion", "linear").choices({"linear", "rotary"}).doc("units of the parameters: kg and N, or kg m^2 and N m");
  d.parameter("force_constant", 1.0).above(0.0).doc("force (torque) by a unit of the input");
  d.parameter("output", "position").choices({"position", "velocity"}).doc("what is measured; a velocity knows no position");
  d.parameter("inverse", false).doc("the input is the measured position, the output the motor's input: the force residual");
  d.optional<double>("filter").unit("Hz").above(0.0).doc("corner (-3 dB) of the filter behind the derivatives, for `inverse`");
  describe_timing(d, Hold::zero_order);
}

void DriveAxis::configure(const Parameters& p) {
  rotary_ = p.text("motion") == "rotary";
  velocity_ = p.text("output") == "velocity";
  inverse_ = p.boolean("inverse");
  force_constant_ = p.number("force_constant");
  timing_ = read_timing(p);
  filter_hz_ = p.has("filter") ? p.number("filter") : 0.0;
  if (inverse_ && velocity_) fail("inverse takes the measured position: output says velocity");
  if (inverse_ && !p.has("filter")) fail("inverse needs filter: the corner of the low-pass behind the derivatives");
  if (!inverse_ && p.has("filter")) fail("filter belongs to inverse, which forms derivatives");
  if (inverse_) timing_.delay_s = -timing_.delay_s;  // what acts on the position now was commanded before
}

std::vector<FitParameter> DriveAxis::parameters() const {
  if (rotary_) return {positive("inertia", "kg*m^2"), positive("viscous_friction", "N*m*s/rad")};
  return {positive("mass", "kg"), positive("viscous_friction", "N*s/m")};
}

std::vector<Place> DriveAxis::places() const {
  Place p;
  p.name = p.kind = "bearing";
  p.flow_unit = rotary_ ? "rad/s" : "m/s";
  if (!velocity_) p.stored_unit = rotary_ ? "rad" : "m";
  p.reaction_unit = rotary_ ? "N*m" : "N";
  return {p};
}

std::vector<PlantInput> DriveAxis::inputs() const {
  if (inverse_) return {{0, 0}, {0, 1}, {0, 2}};
  return {PlantInput{}};
}

std::vector<std::string> DriveAxis::conventions() const {
  const std::string constant =
      "force constant " + short_text(force_constant_) + (rotary_ ? " N m" : " N") + " by a unit of the motor's input (declared)";
  if (inverse_) {
    std::vector<std::string> words = {constant,
                                      "force from the measured position: its derivatives and the force pass a "
                                      "low-pass filter of " +
                                          short_text(filter_hz_) + " Hz, forth and back"};
    if (timing_.delay_s < 0.0)
      words.push_back("the motor's input acts " + short_text(-1e6 * timing_.delay_s) + " us after its sample");
    return words;
  }
  std::vector<std::string> words = timing_words(timing_);
  words.insert(words.begin(), constant);
  return words;
}

std::vector<std::vector<double>> DriveAxis::starts(std::span<const MeasuredResponse> measured) const {
  MeasuredResponse lines = joined_lines(measured);
  if (lines.frequency_hz.empty()) fail("the records have no line with a response: nothing to start from");
  // f / G = F + M s, G from the force to the velocity.
  for (std::size_t i = 0; i < lines.frequency_hz.size(); ++i) {
    const std::complex<double> s(0.0, kTwoPi * lines.frequency_hz[i]);
    if (inverse_) {
      lines.weight[i] /= std::norm(lines.response[i] / s);
      lines.response[i] = s / lines.response[i];
    } else if (!velocity_) {
      lines.response[i] *= s;
      lines.weight[i] /= std::abs(s);
    }
  }
  const double constant = force_constant_;
  const auto numerator = [constant](std::complex<double>) { return std::complex<double>(constant); };
  double mass = 0.0, friction = 0.0;
  if (const auto d = denominator_near({&lines, 1}, numerator, 1)) friction = (*d)[0], mass = (*d)[1];
  if (mass < 0.0 && friction < 0.0) fail("the axis moves against the force: check the signs of the signals");
  const std::size_t last = lines.frequency_hz.size() - 1;
  if (!(mass > 0.0)) mass = constant / std::abs(lines.response[last]) / (kTwoPi * lines.frequency_hz[last]);
  if (!(friction > 0.0)) friction = 0.1 * mass * kTwoPi * lines.frequency_hz[0];
  return {{mass, friction}};
}

bool DriveAxis::state_space(const double* v, const double* /*known*/, LinearPlant& plant) const {
  const double mass = v[0], friction = v[1], f = force_constant_;
  if (!(mass > 0.0) || !(friction >= 0.0) || !std::isfinite(friction / mass) || !std::isfinite(mass)) return false;
  if (inverse_) {
    plant.resize(0, 3, 1);
    plant.Df = {0.0, 1.0, 0.0};
    plant.Ds = {1.0, 0.0, 0.0};
    plant.D = {0.0, friction / f, mass / f};
    plant.F = {1.0 / f};
    return true;
  }
  if (velocity_) {
    plant.resize(1, 1, 1);
    plant.A = {-friction / mass};
    plant.B = {f / mass};
    plant.E = {-1.0 / mass};
    plant.Cf = {1.0};
    plant.C = {1.0};
    return true;
  }
  plant.resize(2, 1, 1);
  plant.A = {0.0, 1.0, 0.0, -friction / mass};
  plant.B = {0.0, f / mass};
  plant.E = {0.0, -1.0 / mass};
  plant.Cf = {0.0, 1.0};
  plant.Cs = {1.0, 0.0};
  plant.C = {1.0, 0.0};
  return true;
}

}  // namespace bodeflow::residual
