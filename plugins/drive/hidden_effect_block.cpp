#include "hidden_effect_block.hpp"

namespace bodeflow::drive {
namespace {

std::vector<std::string> default_effects() { return {"none", "delay", "dead_time", "saturation"}; }

}  // namespace

void HiddenEffectBlock::describe(Describe& d) {
  d.id("drive.hidden_effect")
      .summary("Draws what a bench hides: an effect, its size, and the motor's true parameters.")
      .role("source");
  d.doc(
      "One of `effects`, each as likely, its size log-uniform within its range, given as the record `bench_properties` at the "
      "end. "
      "It runs in a phase of its own; the blocks of the bench in later phases take the record at `properties` and nobody else "
      "looks at it before the verdict. The default ranges are those that an experiment with 4 V a line below 6 Hz and 8 V a line "
      "up to 96 Hz on the motor of the defaults sees. With parameter_spread the record also has rs, rr, ls, lr, lm; lm and the "
      "leakages ls - lm, lr - lm are drawn, so that the coupling stays below 1.");
  d.parameter("effects", default_effects())
      .doc(
          "those to draw from: none, delay, dead_time, saturation, skin_effect, iron_loss, resistance_drift, sensor_lag, offset, "
          "hum");
  d.optional<std::int64_t>("seed").range(0, 9e18).doc("fixes the draw; without it the run's seed and the block's name do");
  for (const EffectKind& kind : kEffects) {
    if (kind.least == 0) continue;
    d.parameter("size." + std::string(kind.name), std::vector<double>{kind.least, kind.greatest})
        .unit(kind.unit)
        .doc("smallest and largest " + std::string(kind.size_is));
  }
  d.parameter("parameter_spread", 0.0)
      .unit("1")
      .range(0, 0.5)
      .doc("largest relative deviation of the motor's true parameters from the nominal ones; 0: not drawn");
  d.parameter("rs", 6.6).unit("ohm").above(0).doc("nominal stator resistance, per phase of the star");
  d.parameter("rr", 5.5).unit("ohm").above(0).doc("nominal rotor resistance");
  d.parameter("ls", 475e-3).unit("H").above(0).doc("nominal stator inductance");
  d.parameter("lr", 475e-3).unit("H").above(0).doc("nominal rotor inductance");
  d.parameter("lm", 454e-3).unit("H").above(0).doc("nominal mutual inductance");
  d.message_out(out).record_type("bench_properties").doc("effect, size, unit; the properties by name, in SI units");
}

void HiddenEffectBlock::configure(const Parameters& p) {
  names_ = p.texts("effects");
  for (std::size_t k = 1; k < kEffects.size(); ++k) {
    const std::string name = "size." + std::string(kEffects[k].name);
    const std::vector<double>& range = p.numbers(name);
    if (range.size() != 2) fail(name + " has " + std::to_string(range.size()) + " values, allowed: two");
    ranges_[k] = {range[0], range[1]};
  }
  nominal_ = {p.number("rs"), p.number("rr"), p.number("ls"), p.number("lr"), p.number("lm")};
  spread_ = p.number("parameter_spread");
  own_seed_ = p.has("seed");
  if (own_seed_) seed_ = static_cast<std::uint64_t>(p.integer("seed"));
  const auto effect = draw_effect(0, names_, ranges_);
  if (!effect) fail(effect.error().text);
  const auto motor = draw_motor(0, nominal_, spread_);
  if (!motor) fail(motor.error().text);
}

void HiddenEffectBlock::activate(const Activation& a) {
  if (!own_seed_) seed_ = a.seed;
}

void HiddenEffectBlock::finish(Io& io) {
  const HiddenEffect effect = draw_effect(seed_, names_, ranges_).value();
  RecordBuilder r("bench_properties");
  r.set("effect", effect.kind->name);
  r.set("size", effect.size);
  r.set("unit", effect.kind->unit);
  if (effect.size > 0) r.set(effect.kind->property, effect.size);
  if (spread_ > 0) {
    const MotorParameters motor = draw_motor(seed_, nominal_, spread_).value();
    r.set("rs", motor.rs).set("rr", motor.rr).set("ls", motor.ls).set("lr", motor.lr).set("lm", motor.lm);
  }
  io.emit(out, r);
}

}  // namespace bodeflow::drive
