#include "voltage_sensor_block.hpp"

#include <algorithm>

#include "bench_properties.hpp"
#include "sensor_stream.hpp"

namespace bodeflow::drive {

void VoltageSensor::describe(Describe& d) {
  d.id("drive.voltage_sensor")
      .summary("Measures voltages as a resistive divider does: ratio error, offset, noise.")
      .realtime_safe()
      .in_place()
      .cost_ns(15);
  d.doc(
      "y[n] = (1 + ratio_error) x[n] + offset + noise e[n], in volts before the divider. From drive.inverter x[n] is the mean "
      "terminal voltage of PWM period n: a model from y to currents at the start of the periods holds its input over the period. "
      "Each channel has noise of its own.");
  d.parameter("ratio_error", 0.0).unit("1").range(-1, 1e3).doc("relative error of the divider's ratio");
  d.parameter("offset", 0.0).unit("V").range(-1e6, 1e6).doc("output at no voltage");
  d.parameter("noise", 0.0).unit("V").range(0, 1e6).doc("standard deviation of the white normal noise");
  d.optional<std::int64_t>("seed").range(0, 9e18).doc("fixes the noise; without it the run's seed and the block's name do");
  d.stream_in(in).doc("true voltages [V]");
  d.stream_out(out).same_as(in).doc("measured voltages [V]");
  d.message_in(properties)
      .optional()
      .record_type("bench_properties")
      .doc("hidden voltage_ratio_error, voltage_offset, voltage_noise");
}

void VoltageSensor::configure(const Parameters& p) {
  declared_.gain = 1 + p.number("ratio_error");
  declared_.offset = p.number("offset");
  declared_.noise_std = p.number("noise");
  own_seed_ = p.has("seed");
  if (own_seed_) seed_ = static_cast<std::uint64_t>(p.integer("seed"));
}

void VoltageSensor::resolve(Facts& f) {
  const StreamFacts& x = f.in(in);
  if (!x.known) return;
  check_unit(x, "V");
  channels_ = x.channels;
  rate_hz_ = x.rate.hz();
  add_noise_note(f.out(out), declared_, false);
}

void VoltageSensor::activate(const Activation& a) {
  if (!own_seed_) seed_ = a.seed;
  reset();
}

void VoltageSensor::receive(int, const RecordView& record, Io& io) {
  check_at_start(io.position());
  double ratio_error = actual_.gain - 1;
  take_property(record, "voltage_ratio_error", -1, 1e3, ratio_error);
  actual_.gain = 1 + ratio_error;
  take_property(record, "voltage_offset", -1e6, 1e6, actual_.offset);
  take_property(record, "voltage_noise", 0, 1e6, actual_.noise_std);
}

void VoltageSensor::process(Io& io) {
  for (int c = 0; c < channels_; ++c) {
    const auto x = io.read(in, c);
    const auto y = io.write(out, c);
    check_finite(x, c, io.position());
    if (y.data() != x.data()) std::copy(x.begin(), x.end(), y.begin());
    add_errors(actual_, rate_hz_, io.position(), random_[static_cast<std::size_t>(c)], y);
  }
}

void VoltageSensor::reset() {
  actual_ = declared_;
  random_.clear();
  for (int c = 0; c < channels_; ++c) random_.push_back(numerics::Random::stream(seed_, static_cast<std::uint64_t>(c)));
}

}  // namespace bodeflow::drive
