#include "friction_feed_forward_block.hpp"

#include <algorithm>

#include "sensor_stream.hpp"

namespace bodeflow::drive {

void FrictionFeedForward::describe(Describe& d) {
  d.id("drive.friction_feed_forward")
      .summary("Gives the torque that dry friction takes, by the sign of the measured speed.")
      .realtime_safe()
      .cost_ns(2);
  d.doc(
      "out = torque s(speed / threshold), s limited to +-1 and straight between: below the threshold the torque falls with the "
      "speed, so that noise around rest does not make it jump. It compensates friction while the axis moves; an axis that sticks "
      "is not helped.");
  d.parameter("torque", 0.0).unit("Nm").range(0, 1e6).live().doc("that the friction takes; 0: none");
  d.parameter("threshold", 0.1).unit("rad/s").above(0).below(1e6).doc("speed from which on the whole torque is given");
  d.stream_in(speed).doc("measured [rad/s]");
  d.stream_out(out).same_as(speed).doc("torque [Nm]");
}

void FrictionFeedForward::configure(const Parameters& p) {
  threshold_ = p.number("threshold");
  change(p);
}

void FrictionFeedForward::change(const Parameters& p) { torque_ = p.number("torque"); }

void FrictionFeedForward::resolve(Facts& f) {
  if (!f.in(speed).known) return;
  check_unit(f.in(speed), "rad/s");
  StreamFacts& y = f.out(out);
  y.unit = "Nm";
  y.channel_units.clear();
  y.notes.erase("noise.std");
}

void FrictionFeedForward::process(Io& io) {
  for (int c = 0; c < io.channels(speed); ++c) {
    const auto v = io.read(speed, c);
    const auto y = io.write(out, c);
    check_finite(v, c, io.position());
    for (std::size_t n = 0; n < v.size(); ++n) y[n] = torque_ * std::clamp(v[n] / threshold_, -1.0, 1.0);
  }
}

}  // namespace bodeflow::drive
