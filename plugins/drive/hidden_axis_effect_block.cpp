#include "hidden_axis_effect_block.hpp"

#include "draw_parameters.hpp"

namespace bodeflow::drive {

void HiddenAxisEffect::describe(Describe& d) {
  d.id("drive.hidden_axis_effect")
      .summary("Draws what an axis hides: nothing, an effect or two, their sizes, and the true inertias and stiffness.")
      .role("source");
  d.doc(
      "As drive.hidden_effect, for drive.axis. With parameter_spread the record also has the true motor_inertia, load_inertia, "
      "stiffness, damping, motor_viscosity, load_viscosity.");
  describe_draw(d, kAxisEffects, {"none", "coulomb_friction", "backlash", "cubic_stiffness"});
  d.parameter("parameter_spread", 0.0)
      .unit("1")
      .range(0, 0.5)
      .doc("largest relative deviation of the true parameters from the nominal ones; 0: not drawn");
  d.parameter("motor_inertia", 1e-3).unit("kg m^2").above(0).doc("nominal");
  d.parameter("load_inertia", 2e-3).unit("kg m^2").above(0).doc("nominal");
  d.parameter("stiffness", 40.0).unit("Nm/rad").above(0).doc("nominal, of the coupling");
  d.parameter("damping", 0.02).unit("Nm s/rad").range(0, 1e6).doc("nominal, in the coupling");
  d.parameter("motor_viscosity", 0.01).unit("Nm s/rad").range(0, 1e6).doc("nominal friction over speed in the motor's bearing");
  d.parameter("load_viscosity", 0.01).unit("Nm s/rad").range(0, 1e6).doc("nominal friction over speed in the load's bearing");
  d.message_out(out).record_type("bench_properties").doc("effects, sizes, units; the properties by name, in SI units");
}

void HiddenAxisEffect::configure(const Parameters& p) {
  draw_ = read_draw(p, kAxisEffects);
  nominal_.clear();
  for (const char* name : kParameters) nominal_.push_back(p.number(name));
  spread_ = p.number("parameter_spread");
  own_seed_ = p.has("seed");
  if (own_seed_) seed_ = static_cast<std::uint64_t>(p.integer("seed"));
}

void HiddenAxisEffect::activate(const Activation& a) {
  if (!own_seed_) seed_ = a.seed;
}

void HiddenAxisEffect::finish(Io& io) {
  RecordBuilder r = bench_properties(draw_effects(seed_, draw_).value());
  if (spread_ > 0) {
    const std::vector<double> values = draw_near(seed_, nominal_, spread_);
    for (std::size_t k = 0; k < values.size(); ++k) r.set(kParameters[k], values[k]);
  }
  io.emit(out, r);
}

}  // namespace bodeflow::drive
