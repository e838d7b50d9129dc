#include "self_tuning_block.hpp"

#include <cmath>
#include <limits>

#include "block_settings.hpp"
#include "controller_record.hpp"
#include "pole_patterns.hpp"

namespace bodeflow::adaptive_control {

void SelfTuning::describe(Describe& d) {
  d.id("adaptive_control.self_tuning")
      .summary("Controls by an indirect self-tuning regulator of second order: the peer of the frequency-domain scheme.")
      .realtime_safe()
      .cost_ns(150);
  d.doc(
      "A model (b0 z + b1) / (z^2 + a1 z + a2) of band-pass filtered signals, poles placed at those of A_m A_o with integral "
      "action. "
      "Quantities that the user supplies (chapter 9): orders of A and B, G_m, A_o, h and one filter; the frequency-domain scheme "
      "has "
      "the orders of R and S, G_m, A_o, h, one filter a frequency, and the frequencies. It rests on the plant's order: on a "
      "plant of "
      "fifth order it tracks 12 times worse. No safety nets.");
  d.reference("P.-O. Kallen, Frequency Domain Adaptive Control, Lund 1992, chapters 8 and 9");
  d.required<double>("bandwidth").unit("rad/s").above(0).doc("A_m = Bess(2, w_m)");
  d.optional<double>("observer").unit("rad/s").above(0).doc("A_o = Bess(2, w_o), w_m otherwise");
  d.required<std::vector<double>>("band").unit("rad/s").doc("pass band of the data filter: low and high edge");
  d.parameter("p0", 1e6).above(0).doc("P(0) = p0 I");
  d.parameter("forgetting", 1.0).above(0).range(0, 1).doc("lambda");
  d.parameter("start", 0.0).unit("s").range(0, 1e12).doc("time from which designed controllers are used");
  d.parameter("start_gain", 0.0).unit("").doc("of the proportional controller until then");
  d.optional<double>("min").unit("").doc("least control signal");
  d.optional<double>("max").unit("").doc("greatest control signal");
  d.parameter("unit", "").doc("unit of the control signal");
  d.stream_in(setpoint).doc("command");
  d.stream_in(y).doc("output of the plant");
  d.stream_out(u).doc("limited control signal");
  d.message_out(controller).record_type("controller").doc("model and controller at the end");
}

void SelfTuning::configure(const Parameters& p) {
  settings_.a_m = bessel(2, p.number("bandwidth"));
  settings_.a_o = bessel(2, p.has("observer") ? p.number("observer") : p.number("bandwidth"));
  const std::vector<double>& band = p.numbers("band");
  if (band.size() != 2) fail("band has " + std::to_string(band.size()) + " values; needed: low and high edge");
  settings_.band_low = band[0];
  settings_.band_high = band[1];
  settings_.p0 = p.number("p0");
  settings_.forgetting = p.number("forgetting");
  settings_.start_gain = p.number("start_gain");
  constexpr double kNone = std::numeric_limits<double>::infinity();
  settings_.least = p.has("min") ? p.number("min") : -kNone;
  settings_.most = p.has("max") ? p.number("max") : kNone;
  if (!(settings_.least < settings_.most)) fail("min must be below max");
  start_s_ = p.number("start");
  unit_ = p.text("unit");
}

SelfTuningSettings SelfTuning::at(double sample_time) const {
  SelfTuningSettings s = settings_;
  s.sample_time = sample_time;
  s.start = static_cast<std::int64_t>(std::ceil(start_s_ / sample_time - 1e-9));
  return s;
}

void SelfTuning::resolve(Facts& f) {
  const StreamFacts& known = f.in(setpoint).known ? f.in(setpoint) : f.in(y);
  if (!known.known) return;
  if (known.channels != 1) fail("one channel is needed at each input, found: " + std::to_string(known.channels));
  value_or_fail(SelfTuningRegulator::make(at(1.0 / known.rate.hz())));
  StreamFacts& out = f.out(u);
  out.known = true;
  out.channels = 1;
  out.rate = known.rate;
  out.length = known.length;
  out.clock = known.clock;
  out.unit = unit_;
}

void SelfTuning::activate(const Activation& a) {
  sample_time_ = 1.0 / a.rate.hz();
  reset();
}

void SelfTuning::reset() { regulator_ = value_or_fail(SelfTuningRegulator::make(at(sample_time_))); }

void SelfTuning::process(Io& io) {
  const auto command = io.read(setpoint), measured = io.read(y);
  const auto out = io.write(u);
  require_finite(command, "setpoint", io.position());
  require_finite(measured, "y", io.position());
  for (std::size_t n = 0; n < io.count(); ++n) {
    out[n] = regulator_->step(measured[n], command[n]);
    if (!std::isfinite(out[n])) fail("the control signal is not finite at sample " + std::to_string(io.position() + n));
  }
}

void SelfTuning::finish(Io& io) {
  RecordBuilder r = controller_record(regulator_->controller(), sample_time_);
  const Regressor& theta = regulator_->model();
  r.set("model", std::vector<double>(theta.begin(), theta.begin() + 4));
  r.set("designs_refused", regulator_->designs_refused());
  io.emit(controller, r);
}

}  // namespace bodeflow::adaptive_control
