#include "rst_block.hpp"

#include <cmath>
#include <limits>

#include "acceptance.hpp"
#include "block_settings.hpp"

namespace bodeflow::adaptive_control {
namespace {

constexpr const char* kNoCoefficients = "neither r, s and t nor a stream at 'coefficients' is given";

int read_polynomial(const Parameters& p, const char* name, Coefficients& to) {
  const std::vector<double>& values = p.numbers(name);
  if (values.empty() || values.size() > to.size()) {
    fail(std::string(name) + " has " + std::to_string(values.size()) + " coefficients; allowed: 1 to " +
         std::to_string(to.size()));
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) fail(std::string(name) + ": not all coefficients are finite");
    to[i] = values[i];
  }
  return static_cast<int>(values.size()) - 1;
}

}  // namespace

void RstBlock::describe(Describe& d) {
  d.id("adaptive_control.rst")
      .summary("Controls a plant by R u = T u_c - S y, with limits of u and anti-windup.")
      .role("controller")
      .realtime_safe()
      .cost_ns(30);
  d.doc(
      "A_ar u = (A_ar - R) u_l - S y + T u_c with u_l = u within `min` and `max`, computed from past signals alone, so the "
      "coefficients may change at each sample: with R(1) = 0 and S(1) = T(1) a change at rest does not move u. Fixed r, s and t, "
      "or `coefficients` from adaptive_control.design. The output is the limited signal. u(n) depends on y(n): the plant, or "
      "what stands before it, needs a delay of a sample.");
  d.reference("P.-O. Kallen, Frequency Domain Adaptive Control, Lund 1992, (6.3)");
  d.optional<std::vector<double>>("r").doc("coefficients of R in descending powers of z, monic");
  d.optional<std::vector<double>>("s").doc("coefficients of S");
  d.optional<std::vector<double>>("t").doc("coefficients of T");
  d.optional<std::vector<double>>("anti_windup")
      .doc("A_ar, monic, as many coefficients as r, roots inside the unit circle; for fixed coefficients, z^n otherwise");
  d.optional<double>("min").unit("").doc("least control signal");
  d.optional<double>("max").unit("").doc("greatest control signal");
  d.parameter("unit", "").doc("unit of the control signal");
  d.stream_in(setpoint).doc("command");
  d.stream_in(y).doc("output of the plant");
  d.stream_in(coefficients).optional().doc("of adaptive_control.design, in place of r, s and t");
  d.stream_out(u).doc("limited control signal");
  d.message_out(report).record_type("control_report").doc("how often the limits were reached");
}

void RstBlock::configure(const Parameters& p) {
  fixed_ = p.has("r") || p.has("s") || p.has("t");
  if (fixed_) {
    for (const char* name : {"r", "s", "t"}) {
      if (!p.has(name)) fail(std::string("fixed coefficients need r, s and t; missing: ") + name);
    }
    rst_.n_r = read_polynomial(p, "r", rst_.r);
    rst_.n_s = read_polynomial(p, "s", rst_.s);
    rst_.n_t = read_polynomial(p, "t", rst_.t);
    if (rst_.r[0] != 1.0) fail("r is not monic: its first coefficient must be 1");
    if (rst_.n_s > rst_.n_r || rst_.n_t > rst_.n_r) fail("s and t may not have more coefficients than r");
    anti_windup_ = Coefficients{1.0};
  }
  if (p.has("anti_windup")) {
    if (!fixed_) fail("anti_windup goes with fixed coefficients; the stream `coefficients` brings its own");
    if (read_polynomial(p, "anti_windup", anti_windup_) != rst_.n_r) fail("anti_windup needs as many coefficients as r");
    if (anti_windup_[0] != 1.0 || !roots_inside(anti_windup_, rst_.n_r, 1.0)) {
      fail("anti_windup must be monic with all roots inside the unit circle");
    }
  }
  constexpr double kNone = std::numeric_limits<double>::infinity();
  least_ = p.has("min") ? p.number("min") : -kNone;
  most_ = p.has("max") ? p.number("max") : kNone;
  if (!(least_ < most_)) fail("min must be below max");
  unit_ = p.text("unit");
}

void RstBlock::resolve(Facts& f) {
  const StreamFacts& c = f.in(coefficients);
  if (c.known) {
    if (fixed_) fail("r, s and t are given, and a stream is connected to 'coefficients'; allowed: one of them");
    const std::vector<double> degrees = c.note("rst.degrees");
    if (degrees.size() != 3) fail("the stream at 'coefficients' is not one of adaptive_control.design");
    rst_.n_r = static_cast<int>(degrees[0]);
    rst_.n_s = static_cast<int>(degrees[1]);
    rst_.n_t = static_cast<int>(degrees[2]);
    const CoefficientStream layout{rst_.n_r, rst_.n_s, rst_.n_t};
    if (rst_.n_r < 0 || rst_.n_r > kMostOrder || c.channels != layout.channels()) {
      fail("the stream at 'coefficients' has " + std::to_string(c.channels) +
           " channels; needed: " + std::to_string(layout.channels()));
    }
  }
  for (const In<double>& input : {setpoint, y}) {
    if (f.in(input).known && f.in(input).channels != 1) {
      fail(std::string("'") + input.name + "' has " + std::to_string(f.in(input).channels) + " channels; needed: one");
    }
  }
  const StreamFacts& known = f.in(setpoint).known ? f.in(setpoint) : f.in(y);
  if (!known.known) return;
  StreamFacts& out = f.out(u);
  out.known = true;
  out.channels = 1;
  out.rate = known.rate;
  out.length = known.length;
  out.clock = known.clock;
  out.unit = unit_;
  out.notes[kLimitsNote] = {least_, most_};
}

void RstBlock::advise(const Facts& f, Advice& a) {
  if (!fixed_ && f.in(coefficients).channels == 0) a.warn(kNoCoefficients);
}

void RstBlock::activate(const Activation&) { reset(); }

void RstBlock::reset() {
  controller_ = RstController(least_, most_);
  samples_ = saturated_ = 0;
}

void RstBlock::process(Io& io) {
  const auto command = io.read(setpoint), measured = io.read(y);
  const auto out = io.write(u);
  const bool streamed = io.connected(coefficients);
  if (!streamed && !fixed_) fail(kNoCoefficients);
  require_finite(command, "setpoint", io.position());
  require_finite(measured, "y", io.position());
  for (std::size_t n = 0; n < io.count(); ++n) {
    if (streamed) read(io, n);
    out[n] = controller_.step(measured[n], command[n], rst_, anti_windup_);
    if (!std::isfinite(out[n])) fail("the control signal is not finite at sample " + std::to_string(io.position() + n));
    ++samples_;
    saturated_ += controller_.saturated() ? 1 : 0;
  }
}

void RstBlock::read(Io& io, std::size_t n) {
  int channel = 0;
  const auto take = [&](Coefficients& to, int from, int last) {
    for (int i = from; i <= last; ++i) to[static_cast<std::size_t>(i)] = io.read(coefficients, channel++)[n];
  };
  rst_.r[0] = anti_windup_[0] = 1.0;
  take(rst_.r, 1, rst_.n_r);
  take(rst_.s, 0, rst_.n_s);
  take(rst_.t, 0, rst_.n_t);
  take(anti_windup_, 1, rst_.n_r);
}

void RstBlock::finish(Io& io) {
  RecordBuilder r("control_report");
  r.set("samples", samples_);
  r.set("saturated_samples", saturated_);
  io.emit(report, r);
}

}  // namespace bodeflow::adaptive_control
