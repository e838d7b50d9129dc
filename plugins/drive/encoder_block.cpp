#include "encoder_block.hpp"

#include <cmath>
#include <numbers>

#include "bench_properties.hpp"
#include "sensor_stream.hpp"

namespace bodeflow::drive {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kMostCounts = 9007199254740992.0;  // beyond 2^53 counts are no longer whole numbers of their own

}  // namespace

void Encoder::describe(Describe& d) {
  d.id("drive.encoder")
      .summary("Measures an angle as an incremental encoder does: whole counts, and speed by their differences.")
      .realtime_safe()
      .cost_ns(10);
  d.doc(
      "counts[n] = floor(resolution (x[n] - index_offset) / (2 pi)), x the mechanical angle at the start of PWM period n; "
      "speed[n] = "
      "(counts[n] - counts[n-1]) 2 pi rate / resolution in mechanical rad/s, 0 at the first sample. The speed is the mean over "
      "the last "
      "period, so it is half a sample late, and comes in steps of 2 pi rate / resolution. There is no noise but this rounding.");
  d.required<std::int64_t>("resolution").range(1, 1e9).doc("counts a turn: four times the lines of an encoder with two tracks");
  d.parameter("index_offset", 0.0).unit("rad").range(-1e3, 1e3).doc("angle at which the counter stands at 0");
  d.stream_in(in).doc("angle [rad], mechanical, not wrapped; one channel");
  d.stream_out(counts).same_as(in).doc("position in counts");
  d.stream_out(speed).same_as(in).doc("speed [rad/s], mechanical");
  d.message_in(properties).optional().record_type("bench_properties").doc("hidden encoder_index_offset");
}

void Encoder::configure(const Parameters& p) {
  counts_per_rad_ = static_cast<double>(p.integer("resolution")) / kTurn;
  declared_index_rad_ = index_rad_ = p.number("index_offset");
}

void Encoder::resolve(Facts& f) {
  const StreamFacts& x = f.in(in);
  if (!x.known) return;
  check_unit(x, "rad");
  if (x.channels != 1) fail("the input has " + std::to_string(x.channels) + " channels, allowed: 1");
  rate_hz_ = x.rate.hz();
  for (const auto& [port, unit] : {std::pair{counts, "1"}, {speed, "rad/s"}}) {
    StreamFacts& y = f.out(port);
    y.unit = unit;
    y.channel_names = {port.name};
    y.channel_units.clear();
    y.notes.erase("noise.std");
  }
}

void Encoder::receive(int, const RecordView& record, Io& io) {
  check_at_start(io.position());
  take_property(record, "encoder_index_offset", -1e3, 1e3, index_rad_);
}

void Encoder::process(Io& io) {
  const auto x = io.read(in);
  const auto c = io.write(counts), v = io.write(speed);
  check_finite(x, 0, io.position());
  const double rad_s_per_count = rate_hz_ / counts_per_rad_;
  for (std::size_t n = 0; n < x.size(); ++n) {
    c[n] = std::floor(counts_per_rad_ * (x[n] - index_rad_));
    if (std::abs(c[n]) > kMostCounts) fail("sample " + std::to_string(io.position() + n) + " is beyond 2^53 counts");
    v[n] = started_ ? (c[n] - last_) * rad_s_per_count : 0.0;
    last_ = c[n];
    started_ = true;
  }
}

void Encoder::reset() {
  index_rad_ = declared_index_rad_;
  started_ = false;
}

}  // namespace bodeflow::drive
