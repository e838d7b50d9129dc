#include "current_sensor_block.hpp"

#include <algorithm>

#include "bench_properties.hpp"
#include "records/signals.hpp"
#include "sensor_stream.hpp"

namespace bodeflow::drive {
namespace {

constexpr double kLongest_s = 100.0;
constexpr double kHighestHum_hz = 1e6;

}  // namespace

void CurrentSensor::describe(Describe& d) {
  d.id("drive.current_sensor")
      .summary("Measures currents as Hall sensors do: lag, delay, gain, offset, mains hum, noise.")
      .realtime_safe()
      .in_place()
      .cost_ns(40);
  d.doc(
      "y[n] = g[n] x_s[n] + offset - correction + hum sin(2 pi hum_frequency n / rate + hum_phase) + noise e[n], g[n] = gain (1 "
      "+ "
      "wobble sin(2 pi wobble_frequency n / rate)), x_s the current behind a lag "
      "and a "
      "transport delay, exp(-s delay) / (1 + s lag). Samples are taken synchronously with the carrier, at the start of each PWM "
      "period, where the ripple of the current crosses zero. What lies between the samples is not known to the sensor: lag and "
      "delay are right to 8e-5 up to a tenth of the sampling rate, to 5e-6 up to a hundredth. Each channel has noise of its own; "
      "lag, delay, gain, offset and hum are the same in all.");
  d.parameter("gain", 1.0).unit("1").range(-1e6, 1e6).doc("1 for a sensor that is right");
  d.parameter("offset", 0.0).unit("A").range(-1e6, 1e6).doc("output at no current");
  d.parameter("lag", 0.0).unit("s").range(0, kLongest_s).doc("time constant of the sensor");
  d.parameter("delay", 0.0).unit("s").range(0, kLongest_s).doc("transport delay");
  d.parameter("noise", 0.0).unit("A").range(0, 1e6).doc("standard deviation of the white normal noise");
  d.parameter("hum", 0.0).unit("A").range(0, 1e6).doc("peak value of the mains hum");
  d.parameter("hum_frequency", 50.0).unit("Hz").range(0, kHighestHum_hz).doc("of the hum");
  d.parameter("hum_phase", 0.0).unit("rad").range(-7, 7).doc("of the hum, at the first sample");
  d.parameter("correction", 0.0)
      .unit("A")
      .range(-1e6, 1e6)
      .live()
      .doc("subtracted from the output: a known offset is taken away");
  d.parameter("wobble", 0.0).unit("1").range(0, 1).doc("relative amplitude of the gain, which goes up and down");
  d.parameter("wobble_frequency", 0.7).unit("Hz").range(0, kHighestHum_hz).doc("of the wobble");
  d.optional<std::int64_t>("seed").range(0, 9e18).doc("fixes the noise; without it the run's seed and the block's name do");
  d.stream_in(in).doc("true currents [A]");
  d.stream_out(out).same_as(in).doc("measured currents [A]");
  d.message_in(properties)
      .optional()
      .record_type("bench_properties")
      .doc(
          "hidden current_gain, current_offset, current_lag, current_delay, current_noise, current_hum, current_hum_frequency, "
          "current_wobble, current_wobble_frequency");
}

void CurrentSensor::configure(const Parameters& p) {
  declared_.errors = {p.number("gain"),          p.number("offset"),    p.number("noise"),  p.number("hum"),
                      p.number("hum_frequency"), p.number("hum_phase"), p.number("wobble"), p.number("wobble_frequency")};
  declared_.lag_s = p.number("lag");
  declared_.delay_s = p.number("delay");
  change(p);
  own_seed_ = p.has("seed");
  if (own_seed_) seed_ = static_cast<std::uint64_t>(p.integer("seed"));
}

void CurrentSensor::resolve(Facts& f) {
  const StreamFacts& x = f.in(in);
  if (!x.known) return;
  check_unit(x, "A");
  channels_ = x.channels;
  rate_hz_ = x.rate.hz();
  add_noise_note(f.out(out), declared_.errors, declared_.lag_s > 0 || declared_.delay_s > 0);
}

void CurrentSensor::advise(const Facts& f, Advice& a) {
  const std::vector<double> lines = f.in(in).note("excitation.frequencies");
  const double highest_hz = 0.1 * f.in(in).rate.hz();
  if (lines.empty() || (declared_.lag_s == 0 && declared_.delay_s == 0) || lines.back() <= highest_hz) return;
  a.warn("lag and delay are right up to a tenth of the sampling rate, " + records::short_number(highest_hz) +
         " Hz, and the excitation goes up to " + records::short_number(lines.back()) + " Hz; excite lower lines");
}

void CurrentSensor::activate(const Activation& a) {
  if (!own_seed_) seed_ = a.seed;
  reset();
}

void CurrentSensor::receive(int, const RecordView& record, Io& io) {
  check_at_start(io.position());
  take_property(record, "current_gain", -1e6, 1e6, actual_.errors.gain);
  take_property(record, "current_offset", -1e6, 1e6, actual_.errors.offset);
  take_property(record, "current_lag", 0, kLongest_s, actual_.lag_s);
  take_property(record, "current_delay", 0, kLongest_s, actual_.delay_s);
  take_property(record, "current_noise", 0, 1e6, actual_.errors.noise_std);
  take_property(record, "current_hum", 0, 1e6, actual_.errors.hum_amplitude);
  take_property(record, "current_hum_frequency", 0, kHighestHum_hz, actual_.errors.hum_frequency_hz);
  take_property(record, "current_wobble", 0, 1, actual_.errors.wobble);
  take_property(record, "current_wobble_frequency", 0, kHighestHum_hz, actual_.errors.wobble_frequency_hz);
  set_dynamics();
}

void CurrentSensor::change(const Parameters& p) { correction_ = p.number("correction"); }

void CurrentSensor::process(Io& io) {
  for (int c = 0; c < channels_; ++c) {
    const auto x = io.read(in, c);
    const auto y = io.write(out, c);
    check_finite(x, c, io.position());
    dynamics_[static_cast<std::size_t>(c)].run(x, y);
    add_errors(actual_.errors, rate_hz_, io.position(), random_[static_cast<std::size_t>(c)], y);
    if (correction_ != 0) std::transform(y.begin(), y.end(), y.begin(), [this](double v) { return v - correction_; });
  }
}

void CurrentSensor::reset() {
  actual_ = declared_;
  set_dynamics();
  random_.clear();
  for (int c = 0; c < channels_; ++c) random_.push_back(numerics::Random::stream(seed_, static_cast<std::uint64_t>(c)));
}

void CurrentSensor::set_dynamics() {
  auto made = SensorDynamics::make(actual_.lag_s * rate_hz_, actual_.delay_s * rate_hz_);
  if (!made) fail(made.error().text);
  dynamics_.assign(static_cast<std::size_t>(channels_), *made);
}

}  // namespace bodeflow::drive
