#include "relay_block.hpp"

#include <algorithm>
#include <cmath>

#include "block_settings.hpp"
#include "plan_record.hpp"

namespace bodeflow::adaptive_control {
namespace {

constexpr double kDecade = 6.3;       // lowest over highest frequency of fitting of a plan
constexpr double kHighest = 1.1;      // highest over omega_-180
constexpr double kLeastAngle = 0.05;  // rad a sample: below it the narrow filters are not centred

/// What section 7.4 makes of a relay experiment.
Plan plan_of(const RelayResult& r, int points, double bandwidth_share, double gain_share, double sample_time) {
  Plan plan;
  const double highest = std::min(kHighest * r.omega, 2.8 / sample_time);
  const double lowest = std::min(std::max(highest / kDecade, kLeastAngle / sample_time), 0.5 * highest);
  for (int j = 0; j < points; ++j) plan.omega.push_back(lowest * std::pow(highest / lowest, j / (points - 1.0)));
  plan.delay = std::min(r.delay, kMostDelay);
  plan.bandwidth = bandwidth_share * r.omega;
  plan.desired_delay_s = std::max(r.zero_samples - 1, 0) * sample_time;
  plan.start_gain = gain_share / std::abs(r.response);
  return plan;
}

}  // namespace

void Relay::describe(Describe& d) {
  d.id("adaptive_control.relay")
      .summary("Lets a plant oscillate by a relay and reads its response at a phase of about -180 degrees.")
      .cost_ns(10);
  d.doc(
      "u = offset + amplitude while y is below the set point, offset - amplitude above it. After settling_cycles, the period "
      "over "
      "`cycles` whole cycles gives omega_-180, and the discrete Fourier transform of u and y over them G there; the describing "
      "function pi a / (4 d), given beside, is off by 5 to 11 % on the thesis' examples. `plan` has what section 7.4 makes of "
      "it: "
      "frequencies of fitting over about a decade up to omega_-180, the estimators' delay from the first response, a bandwidth "
      "and a "
      "gain to start with. The plant must oscillate within bounds: limit it by largest_output. After the experiment u = offset.");
  d.reference(
      "K. J. Astrom, T. Hagglund, Automatic tuning of simple regulators with specifications on phase and amplitude margins, "
      "1984");
  d.reference("P.-O. Kallen, Frequency Domain Adaptive Control, Lund 1992, sections 7.2 and 7.4");
  d.parameter("amplitude", 1.0).unit("").above(0).doc("of u");
  d.parameter("offset", 0.0).unit("").doc("of u");
  d.parameter("hysteresis", 0.0).unit("").range(0, 1e300).doc("of y, about three times its noise");
  d.parameter("settling_cycles", std::int64_t{3}).range(0, 1000).doc("before the measured ones");
  d.parameter("cycles", std::int64_t{4}).range(1, 1000).doc("that are measured");
  d.optional<double>("largest_output").unit("").above(0).doc("distance of y from the set point that ends the experiment");
  d.parameter("plan.points", std::int64_t{3}).range(2, kMostPoints).doc("frequencies of fitting");
  d.parameter("plan.bandwidth", 0.75).above(0).doc("of the demands over omega_-180");
  d.parameter("plan.gain", 0.35).above(0).doc("loop gain at omega_-180 of the controller to start with");
  d.parameter("unit", "").doc("unit of u");
  d.stream_in(setpoint).doc("of y; it also gives the sample rate");
  d.stream_in(y).doc("output of the plant");
  d.stream_out(u).doc("input of the plant");
  d.message_out(result).record_type("relay_result");
  d.message_out(plan).record_type("adaptive_plan");
}

void Relay::configure(const Parameters& p) {
  settings_.amplitude = p.number("amplitude");
  settings_.offset = p.number("offset");
  settings_.hysteresis = p.number("hysteresis");
  settings_.settling_cycles = static_cast<int>(p.integer("settling_cycles"));
  settings_.cycles = static_cast<int>(p.integer("cycles"));
  if (p.has("largest_output")) settings_.largest_output = p.number("largest_output");
  points_ = static_cast<int>(p.integer("plan.points"));
  bandwidth_share_ = p.number("plan.bandwidth");
  gain_share_ = p.number("plan.gain");
  unit_ = p.text("unit");
  value_or_fail(RelayExperiment::make(settings_));
}

void Relay::resolve(Facts& f) {
  for (const In<double>& input : {setpoint, y}) {
    if (f.in(input).known && f.in(input).channels != 1) {
      fail(std::string("'") + input.name + "' has " + std::to_string(f.in(input).channels) + " channels; needed: one");
    }
  }
  if (!f.in(setpoint).known) return;
  StreamFacts& out = f.out(u);
  out.known = true;
  out.channels = 1;
  out.rate = f.in(setpoint).rate;
  out.length = f.in(setpoint).length;
  out.clock = f.in(setpoint).clock;
  out.unit = unit_;
}

void Relay::activate(const Activation& a) {
  sample_time_ = 1.0 / a.rate.hz();
  reset();
}

void Relay::reset() { experiment_ = value_or_fail(RelayExperiment::make(settings_)); }

void Relay::process(Io& io) {
  const auto command = io.read(setpoint), in = io.read(y);
  const auto out = io.write(u);
  require_finite(command, "setpoint", io.position());
  require_finite(in, "y", io.position());
  for (std::size_t n = 0; n < io.count(); ++n) out[n] = experiment_->step(in[n], command[n]);
}

void Relay::finish(Io& io) {
  const RelayResult r = value_or_fail(experiment_->result(sample_time_));
  RecordBuilder record("relay_result");
  record.set("omega_180", r.omega);
  record.set("gain", std::abs(r.response));
  record.set("phase", std::arg(r.response));
  record.set("describing_function_gain", r.describing_gain);
  record.set("output_amplitude", r.output_amplitude);
  record.set("samples_without_response", static_cast<std::int64_t>(r.zero_samples));
  io.emit(result, record);
  io.emit(plan, write_plan(plan_of(r, points_, bandwidth_share_, gain_share_, sample_time_)));
}

}  // namespace bodeflow::adaptive_control
