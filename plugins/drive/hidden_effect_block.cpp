#include "hidden_effect_block.hpp"

#include "draw_parameters.hpp"

namespace bodeflow::drive {

void HiddenEffectBlock::describe(Describe& d) {
  d.id("drive.hidden_effect")
      .summary("Draws what a bench hides: nothing, an effect or two, their sizes, and the motor's true parameters.")
      .role("source");
  d.doc(
      "One of `effects`, each as likely, or nothing, one, two or something of `outside` by `odds`; sizes are log-uniform within "
      "their range. Two never act alike: not a delay and a lag. Given as the record `bench_properties` at the end. "
      "It runs in a phase of its own; the blocks of the bench in later phases take the record at `properties` and nobody else "
      "looks at it before the verdict. The default ranges are those that an experiment with 4 V a line below 6 Hz and 8 V a line "
      "up to 96 Hz on the motor of the defaults sees. With parameter_spread the record also has rs, rr, ls, lr, lm; lm and the "
      "leakages ls - lm, lr - lm are drawn, so that the coupling stays below 1.");
  describe_draw(d, kDriveEffects, {"none", "delay", "dead_time", "saturation"});
  d.parameter("parameter_spread", 0.0)
      .unit("1")
      .range(0, 0.5)
      .doc("largest relative deviation of the motor's true parameters from the nominal ones; 0: not drawn");
  d.parameter("rs", 6.6).unit("ohm").above(0).doc("nominal stator resistance, per phase of the star");
  d.parameter("rr", 5.5).unit("ohm").above(0).doc("nominal rotor resistance");
  d.parameter("ls", 475e-3).unit("H").above(0).doc("nominal stator inductance");
  d.parameter("lr", 475e-3).unit("H").above(0).doc("nominal rotor inductance");
  d.parameter("lm", 454e-3).unit("H").above(0).doc("nominal mutual inductance");
  d.message_out(out).record_type("bench_properties").doc("effects, sizes, units; the properties by name, in SI units");
}

void HiddenEffectBlock::configure(const Parameters& p) {
  draw_ = read_draw(p, kDriveEffects);
  nominal_ = {p.number("rs"), p.number("rr"), p.number("ls"), p.number("lr"), p.number("lm")};
  spread_ = p.number("parameter_spread");
  own_seed_ = p.has("seed");
  if (own_seed_) seed_ = static_cast<std::uint64_t>(p.integer("seed"));
  const auto motor = draw_motor(0, nominal_, spread_);
  if (!motor) fail(motor.error().text);
}

void HiddenEffectBlock::activate(const Activation& a) {
  if (!own_seed_) seed_ = a.seed;
}

void HiddenEffectBlock::finish(Io& io) {
  RecordBuilder r = bench_properties(draw_effects(seed_, draw_).value());
  if (spread_ > 0) {
    const MotorParameters motor = draw_motor(seed_, nominal_, spread_).value();
    r.set("rs", motor.rs).set("rr", motor.rr).set("ls", motor.ls).set("lr", motor.lr).set("lm", motor.lm);
  }
  io.emit(out, r);
}

}  // namespace bodeflow::drive
