#include "design_block.hpp"

#include <algorithm>
#include <cmath>

#include "block_settings.hpp"
#include "coefficient_stream.hpp"
#include "controller_record.hpp"
#include "design_advice.hpp"
#include "numbers_in_text.hpp"
#include "plan_record.hpp"

namespace bodeflow::adaptive_control {

void Design::describe(Describe& d) {
  d.id("adaptive_control.design")
      .summary("Designs an RST controller at each sample from points of the plant's frequency response.")
      .cost_ns(600);
  d.doc(
      "The closed loop G T / (R + G S) is fitted to a desired response G_m at the points, in the sense of least squares of the "
      "relative error (G_cl - G_m) / G_cl, with T = t0 A_o; T is then scaled to S(1) = T(1) where R has integral action. Low "
      "orders control plants of any order, but demands must be within reach: about the speed of the plant itself. Until `start` "
      "and until a design was accepted the controller is u = start_gain (u_c - y). Safety nets: a design is used only if the "
      "controller's own poles, the residual and the sensitivity at the points keep their limits; else the demands are lowered "
      "along a ladder; if no demand is met the last controller stays; a designed controller in use moves by nets.rate of its way "
      "to the newest each sample; and where `setpoint` and `y` are connected, an output more than 3 half swings of the command "
      "off, an error as large as the command, or (with `u`) a control signal that keeps running into its limits while the "
      "command rests, leads back to the start controller for `pause` samples and to demands two steps lower. Each tells in `log` "
      "when it begins and ends. They are judged at the points alone: necessary, no proof of stability.");
  d.reference("P.-O. Kallen, Frequency Domain Adaptive Control, Lund 1992, chapters 3 and 7");
  describe_frequencies(d);
  describe_structure(d);
  describe_desired(d);
  d.parameter("desired.points", std::vector<std::complex<double>>{})
      .doc("G_m at the frequencies, in place of A_m and its delay; there is no ladder then");
  d.parameter("start", 0.0).unit("s").range(0, 1e12).doc("time from which designed controllers are used");
  d.parameter("start_gain", 0.0).unit("").doc("of the proportional controller until then");
  d.parameter("pause", std::int64_t{150}).range(0, 1e9).doc("samples with the start controller after a retreat");
  d.parameter("nets.checks", true).doc("designs beyond the limits are refused");
  d.parameter("nets.ladder", true).doc("demands are lowered where they can't be met");
  d.parameter("nets.rate", 0.1).above(0).range(0, 1).doc("share of the way to the new controller a sample; 1: no limit");
  d.parameter("ladder.steps", std::int64_t{12}).range(1, 64).doc("demands that are tried");
  d.parameter("ladder.ratio", 0.9).above(0).below(1).doc("of the speeds of neighbouring steps");
  d.parameter("limits.pole_radius", 0.98).range(0.1, 1).doc("of the controller's poles, prescribed ones apart");
  d.parameter("limits.residual", 0.5).above(0).doc("of the fit");
  d.parameter("limits.sensitivity", 2.5).above(1).doc("at the points; 4 for plants with an integrator and delay");
  d.stream_in(response).doc("one complex channel a frequency");
  d.stream_in(setpoint).optional().doc("command; with y: watches the loop");
  d.stream_in(y).optional().doc("output of the plant");
  d.stream_in(u).optional().doc("limited control signal of adaptive_control.rst; with setpoint and y: limit cycles are seen");
  d.stream_out(coefficients).doc("r1 .., s0 .., t0 .., and the anti-windup polynomial a1 .. = A_o");
  d.message_in(plan)
      .optional()
      .record_type("adaptive_plan")
      .doc("frequencies and demands from a start-up experiment, before the first sample");
  d.message_out(controller).record_type("controller").doc("the controller at the end");
  d.message_out(log).record_type("net_action").doc("a safety net begins or ceases to act");
}

void Design::configure(const Parameters& p) {
  DesignerSettings& s = settings_;
  s.structure = read_structure(p);
  s.desired = read_desired(p, s.structure.n_r);
  s.desired_points = p.complex_list("desired.points");
  s.checks = p.boolean("nets.checks");
  s.ladder_steps = p.boolean("nets.ladder") ? static_cast<int>(p.integer("ladder.steps")) : 1;
  s.ladder_ratio = p.number("ladder.ratio");
  s.rate = p.number("nets.rate");
  s.limits = {p.number("limits.pole_radius"), p.number("limits.residual"), p.number("limits.sensitivity")};
  s.start_gain = p.number("start_gain");
  s.pause = static_cast<int>(std::min<std::int64_t>(p.integer("pause"), 1'000'000'000));
  start_s_ = p.number("start");
  bandwidth_ = p.number("desired.bandwidth");
  omega_ = s.structure.omega;
}

DesignerSettings Design::at(double sample_time) const {
  DesignerSettings s = settings_;
  s.structure.sample_time = sample_time;
  s.start = static_cast<std::int64_t>(std::ceil(start_s_ / sample_time - 1e-9));
  return s;
}

void Design::resolve(Facts& f) {
  f.delay(u, 1);
  if (f.in(u).known) {
    const std::vector<double> limits = f.in(u).note(kLimitsNote);
    if (limits.size() != 2) fail("the stream at 'u' tells no limits; needed: the output of adaptive_control.rst itself");
    least_u_ = limits[0];
    most_u_ = limits[1];
  }
  const StreamFacts& g = f.in(response);
  if (!g.known) return;
  const Designer designer = value_or_fail(Designer::make(at(1.0 / g.rate.hz())));
  if (g.channels != designer.design(0).points()) {
    fail("'response' has " + std::to_string(g.channels) + " channels; needed: one for each of the " +
         std::to_string(designer.design(0).points()) + " frequencies");
  }
  const std::vector<double> estimated = g.note("fit.frequencies");
  for (std::size_t j = 0; j < estimated.size(); ++j) {
    if (std::abs(estimated[j] / settings_.structure.omega[j] - 1.0) < 1e-9) continue;
    fail("frequency " + std::to_string(j + 1) + " is " + text_of(settings_.structure.omega[j]) + " rad/s here and " +
         text_of(estimated[j]) + " rad/s where the response is estimated; allowed: the same");
  }
  const CoefficientStream layout{settings_.structure.n_r, settings_.structure.n_s, designer.design(0).n_t()};
  StreamFacts& c = f.out(coefficients);
  c.known = true;
  c.channels = layout.channels();
  c.rate = g.rate;
  c.length = g.length;
  c.clock = g.clock;
  c.channel_names = layout.names();
  c.notes["rst.degrees"] = layout.note();
}

/// The list of section 7.4, as far as it can be judged without the plant.
void Design::advise(const Facts& f, Advice& a) {
  if (!f.in(response).known) return;
  const DesignerSettings s = at(1.0 / f.in(response).rate.hz());
  const DesignAdvice advice = advice_before(s.structure, s.desired, {});
  for (const std::string& text : advice.notes) a.tell(text);
  for (const std::string& text : advice.warnings) a.tell(text);
}

void Design::activate(const Activation& a) {
  sample_time_ = 1.0 / a.rate.hz();
  points_.resize(settings_.structure.omega.size());
  reset();
}

void Design::reset() {
  designer_ = value_or_fail(Designer::make(at(sample_time_)));
  critical_frequency_ = value_or_fail(CriticalFrequency::make(settings_.desired, sample_time_));
  omega_ = settings_.structure.omega;
  last_ = Rst{};
}

void Design::receive(int, const RecordView& record, Io& io) {
  if (io.position() > 0) fail("a plan arrived at sample " + std::to_string(io.position()) + "; allowed: before the first sample");
  const Plan found = read_plan(record, settings_.structure.omega.size());
  DesignerSettings s = at(sample_time_);
  s.structure.omega = found.omega;
  s.desired = scaled(s.desired, found.bandwidth / bandwidth_);
  s.desired.delay_s = found.desired_delay_s;
  s.start_gain = found.start_gain;
  designer_ = value_or_fail(Designer::make(s));
  critical_frequency_ = value_or_fail(CriticalFrequency::make(s.desired, sample_time_));
  omega_ = found.omega;
}

void Design::process(Io& io) {
  for (std::size_t n = 0; n < io.count(); ++n) {
    watch(io, n);
    for (std::size_t j = 0; j < points_.size(); ++j) points_[j] = io.read(response, static_cast<int>(j))[n];
    last_ = designer_->step(points_.data());
    write(io, n, last_);
    NetLog& events = designer_->log();
    for (std::size_t i = 0; i < events.count(); ++i) io.emit(log, record_of(events[i], omega_), n + 1);
    events.clear();
  }
}

void Design::watch(Io& io, std::size_t n) {
  if (!io.connected(setpoint) || !io.connected(y)) return;
  int at_limit = 0;
  if (io.connected(u)) at_limit = io.read(u)[n] >= most_u_ ? 1 : io.read(u)[n] <= least_u_ ? -1 : 0;
  designer_->watch(io.read(y)[n], io.read(setpoint)[n], at_limit);
}

void Design::write(Io& io, std::size_t n, const Rst& rst) const {
  int channel = 0;
  const auto put = [&](const Coefficients& values, int from, int to) {
    for (int i = from; i <= to; ++i) io.write(coefficients, channel++)[n] = values[static_cast<std::size_t>(i)];
  };
  put(rst.r, 1, rst.n_r);
  put(rst.s, 0, rst.n_s);
  put(rst.t, 0, rst.n_t);
  put(designer_->anti_windup(), 1, rst.n_r);
}

void Design::finish(Io& io) {
  RecordBuilder r = controller_record(last_, sample_time_);
  const bool adapted = designer_->adapted();
  r.set("accepted", adapted);
  r.set("reason", std::string(adapted ? "a designed controller is in use" : words_of(designer_->verdict().refusal)));
  r.set("adapted", adapted);
  r.set("ladder_step", static_cast<std::int64_t>(designer_->level()));
  if (designer_->level() >= 0) {
    r.set("residual", designer_->accepted().residual);
    r.set("gain_ratio", designer_->accepted().gain_ratio);
    r.set("critical_frequency", critical_frequency_.estimate(last_));
    r.set("sensitivity_at_points", sensitivity_at_points(designer_->design(0), last_, points_.data()));
  }
  r.set("samples_on_ladder", designer_->acted(Net::ladder));
  r.set("samples_kept", designer_->acted(Net::kept));
  r.set("samples_in_retreat", designer_->acted(Net::retreat));
  r.set("samples_rate_limited", designer_->acted(Net::rate));
  io.emit(controller, r);
}

}  // namespace bodeflow::adaptive_control
