#include "inverter_block.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "bench_properties.hpp"
#include "records/signals.hpp"

namespace bodeflow::drive {
namespace {

using records::short_number;

constexpr double kLongestDeadTime = 0.2;  // of a PWM period: pulse and gap of two dead times need 0.25

void require_axes(const StreamFacts& facts, const char* port, int channels) {
  if (!facts.known || facts.channels == channels) return;
  fail(std::string("'") + port + "' has " + std::to_string(facts.channels) + " channels, 'reference' has " +
       std::to_string(channels) + "; allowed: the same number");
}

}  // namespace

void Inverter::describe(Describe& d) {
  d.id("drive.inverter")
      .summary("Switches a DC link to three phases: symmetric PWM with dead time.")
      .role("actuator")
      .realtime_safe()
      .cost_ns(40);
  d.doc(
      "One sample a PWM period, at its start. `reference` and `voltage` are amplitude-invariant alpha-beta vectors (peak values, "
      "per phase of a star); one channel is alpha alone, with legs b and c switched alike. Channels of `legs`: a_on, a_off, "
      "b_on, "
      "b_off (c_on, c_off) in seconds from the start of the period, and the link voltage. Dead time moves the edges by the sign "
      "of each leg's `current`. Over-modulation clips the duties; a record at the end says how often.");
  d.reference(
      "S.-G. Jeong, M.-H. Park, The analysis and compensation of dead-time effects in PWM inverters, 1991, "
      "doi:10.1109/41.88903");
  d.stream_in(reference).doc("voltage wanted, mean of the coming period: 1 or 2 channels [V]");
  d.stream_in(current).optional().doc("true current of the motor at the start of the period; needed with dead time");
  d.stream_in(measured_current).optional().doc("current as a sensor sees it; needed for the compensation");
  d.stream_out(legs).doc("switching instants and link voltage, for drive.induction_motor");
  d.stream_out(voltage).doc("mean terminal voltage of the period [V]");
  d.message_in(properties)
      .optional()
      .record_type("bench_properties")
      .doc("hidden properties that replace parameters: dead_time, link_ripple");
  d.message_out(report).record_type("modulation").doc("at the end: periods, how many were over-modulated");
  d.optional<double>("pwm").unit("Hz").above(0).doc("PWM frequency; where given, the streams must have this rate");
  d.parameter("dc_link", 540.0).unit("V").above(0).below(1e6).doc("voltage of the DC link");
  d.parameter("mode", "switching")
      .choices({"switching", "averaged"})
      .doc("averaged: the motor takes `voltage`, without the ripple of the PWM");
  d.parameter("modulation", "sine")
      .choices({"sine", "min_max"})
      .doc("min_max adds the zero sequence -(max + min) / 2: linear up to dc_link / sqrt 3 in place of dc_link / 2");
  d.parameter("dead_time", 0.0).unit("s").range(0, 1).doc("at most a fifth of the PWM period");
  d.parameter("compensation", "none")
      .choices({"none", "sign"})
      .live()
      .doc("sign: each pulse longer or shorter by compensation_time, by the sign of the leg's measured current");
  d.optional<double>("compensation_time").unit("s").range(0, 1).live().doc("the dead_time where it is left out");
  d.parameter("link_ripple", 0.0)
      .unit("1")
      .range(0, 0.5)
      .doc("relative amplitude of a ripple of the link at link_ripple_frequency, which the modulation does not know");
  d.parameter("link_ripple_frequency", 100.0).unit("Hz").range(0, 1e6).doc("twice the mains for a single-phase supply");
  d.parameter("computation_delay", std::int64_t{0})
      .range(0, 1000)
      .doc("PWM periods from reference and measurement to the switching");
}

void Inverter::configure(const Parameters& p) {
  pwm_hz_ = p.has("pwm") ? p.number("pwm") : 0.0;
  given_.dc_link_v = p.number("dc_link");
  given_.dead_time_s = p.number("dead_time");
  given_.min_max = p.text("modulation") == "min_max";
  averaged_ = p.text("mode") == "averaged";
  delay_ = p.integer("computation_delay");
  declared_ripple_ = p.number("link_ripple");
  ripple_hz_ = p.number("link_ripple_frequency");
  change(p);
}

void Inverter::change(const Parameters& p) {
  compensated_ = p.text("compensation") == "sign";
  compensation_time_s_ = p.has("compensation_time") ? p.number("compensation_time") : given_.dead_time_s;
}

void Inverter::resolve(Facts& f) {
  const StreamFacts& u = f.in(reference);
  f.delay(reference, delay_);
  f.delay(measured_current, delay_);
  if (!u.known) return;
  if (u.channels > 2) fail("'reference' has " + std::to_string(u.channels) + " channels, allowed: 1 (alpha) or 2 (alpha, beta)");
  if (pwm_hz_ > 0 && std::abs(u.rate.hz() - pwm_hz_) > 1e-9 * pwm_hz_) {
    fail("'reference' has " + short_number(u.rate.hz()) + " samples/s, pwm is " + short_number(pwm_hz_) +
         " Hz; allowed: one sample a PWM period (filters.hold raises the rate)");
  }
  const double longest = kLongestDeadTime / u.rate.hz();
  if (std::max(given_.dead_time_s, compensation_time_s_) > longest) {
    fail("dead_time and compensation_time: at most a fifth of the PWM period, " + short_number(longest * 1e6) + " us");
  }
  require_axes(f.in(current), "current", u.channels);
  require_axes(f.in(measured_current), "measured_current", u.channels);
  StreamFacts& v = f.out(voltage);
  v = u;
  v.unit = "V";
  v.channel_units.clear();
  v.channel_names = u.channels == 1 ? std::vector<std::string>{"u_alpha"} : std::vector<std::string>{"u_alpha", "u_beta"};
  StreamFacts& edges = f.out(legs);
  edges = u;
  edges.unit.clear();
  for (const char* name : {"excitation.amplitudes", "excitation.crest_factor", "noise.std"}) edges.notes.erase(name);
  edges.channel_names = {"a_on", "a_off", "b_on", "b_off"};
  edges.channel_units = {"s", "s", "s", "s"};
  if (u.channels == 2) {
    edges.channel_names.insert(edges.channel_names.end(), {"c_on", "c_off"});
    edges.channel_units.insert(edges.channel_units.end(), {"s", "s"});
  }
  edges.channel_names.push_back("link");
  edges.channel_units.push_back("V");
  edges.channels = static_cast<int>(edges.channel_names.size());
  if (averaged_) edges.notes["drive.averaged"] = {1.0};
}

void Inverter::advise(const Facts& f, Advice& a) {
  if (given_.dead_time_s > 0 && f.in(current).channels == 0) a.warn("dead_time needs the motor's current at 'current'");
  if (compensated_ && f.in(measured_current).channels == 0) a.warn("the compensation needs a current at 'measured_current'");
}

void Inverter::activate(const Activation& a) {
  given_.period_s = 1.0 / a.rate.hz();
  reset();
}

void Inverter::reset() {
  modulation_ = given_;
  ripple_ = declared_ripple_;
  periods_ = limited_ = 0;
  largest_ = 0.0;
}

void Inverter::receive(int, const RecordView& record, Io&) {
  take_property(record, "dead_time", 0.0, kLongestDeadTime * given_.period_s, modulation_.dead_time_s);
  take_property(record, "link_ripple", 0.0, 0.5, ripple_);
}

void Inverter::require_currents(Io& io) const {
  if (modulation_.dead_time_s > 0 && !io.connected(current)) {
    fail("dead_time moves the edges by the sign of the motor's current: connect it to 'current'");
  }
  if (compensated_ && !io.connected(measured_current)) {
    fail("compensation: sign needs a current: connect a sensor, or the motor's current, to 'measured_current'");
  }
}

AlphaBeta Inverter::read_vector(Io& io, In<double> port, std::size_t n) const {
  const AlphaBeta v{io.read(port, 0)[n], vector_ ? io.read(port, 1)[n] : 0.0};
  if (!std::isfinite(v.alpha) || !std::isfinite(v.beta)) {
    fail(std::string("'") + port.name + "' is not finite at sample " + std::to_string(io.position() + n));
  }
  return v;
}

void Inverter::process(Io& io) {
  require_currents(io);
  vector_ = io.channels(reference) == 2;
  if (compensated_ && compensation_time_s_ > kLongestDeadTime * modulation_.period_s) {
    fail("compensation_time = " + short_number(compensation_time_s_) + " s, allowed: at most a fifth of the PWM period");
  }
  modulation_.compensation_time_s = compensated_ ? compensation_time_s_ : 0.0;
  for (std::size_t n = 0; n < io.count(); ++n) {
    const AlphaBeta u = read_vector(io, reference, n);
    const AlphaBeta i = io.connected(current) ? read_vector(io, current, n) : AlphaBeta{};
    const AlphaBeta measured = compensated_ ? read_vector(io, measured_current, n) : AlphaBeta{};
    const Switching s = switching(modulation_, u, i, measured);
    const double rise = 1.0 + link_rise(io.position() + n);
    write_legs(io, n, s, rise);
    io.write(voltage, 0)[n] = rise * s.mean_voltage.alpha;
    if (vector_) io.write(voltage, 1)[n] = rise * s.mean_voltage.beta;
    limited_ += s.limited ? 1 : 0;
    largest_ = std::max(largest_, std::hypot(u.alpha, u.beta));
  }
  periods_ += static_cast<std::int64_t>(io.count());
}

double Inverter::link_rise(std::uint64_t period) const {
  if (ripple_ == 0.0) return 0.0;
  const double cycles = ripple_hz_ * (static_cast<double>(period) * modulation_.period_s);
  return ripple_ * std::sin(2.0 * std::numbers::pi * (cycles - std::floor(cycles)));
}

void Inverter::write_legs(Io& io, std::size_t n, const Switching& s, double rise) const {
  const int count = vector_ ? 3 : 2;
  for (int leg = 0; leg < count; ++leg) {
    const Pulse& pulse = s.legs[static_cast<std::size_t>(leg)];
    io.write(legs, 2 * leg)[n] = pulse.on;
    io.write(legs, 2 * leg + 1)[n] = pulse.off;
  }
  io.write(legs, 2 * count)[n] = rise * modulation_.dc_link_v;
}

void Inverter::finish(Io& io) {
  const double range = linear_range(modulation_);
  if (limited_ > 0) {
    log_warning("over-modulation in " + std::to_string(limited_) + " of " + std::to_string(periods_) +
                " PWM periods: the largest reference was " + short_number(largest_) + " V, given whole up to " +
                short_number(range) + " V");
  }
  RecordBuilder r("modulation");
  r.set("periods", periods_);
  r.set("limited_periods", limited_);
  r.set("largest_reference", largest_);
  r.set("linear_range", range);
  io.emit(report, r);
}

}  // namespace bodeflow::drive
