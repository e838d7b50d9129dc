#include "axis_block.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "bench_properties.hpp"
#include "sensor_stream.hpp"

namespace bodeflow::drive {
namespace {

constexpr double kMostSteps = 2000.0;  // of the integrator in a sample

constexpr double kMost = 1e6;

/// Parameters of the block that a record of properties may replace.
template <class P, class H, class F>
auto numbers_of(P& p, H& h, F& flutter) {
  struct Number {
    const char* name;
    const char* unit;
    double fallback, least, most;
    decltype(&flutter) value;
    const char* doc;
  };
  return std::array<Number, 18>{{
      {"motor_inertia", "kg m^2", 1e-3, 0, kMost, &p.motor_inertia, "of the motor"},
      {"load_inertia", "kg m^2", 2e-3, 0, kMost, &p.load_inertia, "of the load"},
      {"stiffness", "Nm/rad", 40, 0, 1e9, &p.stiffness, "of the coupling"},
      {"damping", "Nm s/rad", 0.02, 0, kMost, &p.damping, "in the coupling, over the difference of the speeds"},
      {"motor_viscosity", "Nm s/rad", 0.01, 0, kMost, &p.motor_viscosity, "friction over speed in the motor's bearing"},
      {"load_viscosity", "Nm s/rad", 0.01, 0, kMost, &p.load_viscosity, "friction over speed in the load's bearing"},
      {"motor_friction", "Nm", 0, 0, kMost, &h.motor_friction, "dry friction in the motor's bearing"},
      {"motor_stribeck", "Nm", 0, 0, kMost, &h.motor_stribeck, "dry friction there that is `breakaway` times as high at rest"},
      {"breakaway", "1", 1.6, 1, 100, &h.breakaway, "of motor_stribeck"},
      {"stribeck_speed", "rad/s", 0.5, 1e-6, kMost, &h.stribeck_speed, "at which 1/e of that rise is left"},
      {"load_friction", "Nm", 0, 0, kMost, &h.load_friction, "dry friction in the load's bearing"},
      {"backlash", "rad", 0, 0, 10, &h.backlash, "half of the gap in the coupling"},
      {"progression_angle", "rad", 0, 0, 10, &h.progression_angle,
       "twist at which the coupling's stiffness is 1.5 times that at rest; 0: linear"},
      {"cogging", "Nm", 0, 0, kMost, &h.cogging, "peak of the torque between magnets and teeth"},
      {"cogging_cycles", "1", 24, 1, 1e4, &h.cogging_cycles, "of the cogging in a turn"},
      {"turning_inertia", "1", 0, 0, 0.9, &h.turning_inertia,
       "relative swing of the load's inertia, load_inertia (1 + turning_inertia cos 2 angle)"},
      {"rub", "Nm", 0, 0, kMost, &h.rub, "dry friction of a contact that the load meets once a turn, within 0.4 rad of 0"},
      {"magnet_flutter", "1", 0, 0, 1, &flutter,
       "relative amplitude of the torque constant, which goes up and down at flutter_frequency"},
  }};
}

}  // namespace

void AxisBlock::describe(Describe& d) {
  d.id("drive.axis")
      .summary("Simulates motor and load with an elastic coupling, dry friction that sticks, and play.")
      .role("plant")
      .realtime_safe()
      .cost_ns(600);
  d.doc(
      "The torque of a sample is held until the next. motor_inertia dw/dt = torque (1 + flutter) + compensation - "
      "motor_viscosity "
      "w - coupling - cogging - dry friction; the load likewise. Dry friction holds a mass until the torque on it is larger; the "
      "coupling touches beyond half of the gap, pushes and never pulls. Between such changes of state the equations are smooth "
      "and solved by the Runge-Kutta method of order 4; each change is found by bisection. README.md has the equations.");
  d.stream_in(torque).doc("of the motor [Nm], wanted");
  d.stream_in(compensation).optional().doc("of the motor beside it [Nm], such as a friction feed-forward");
  d.stream_in(load_torque).optional().doc("on the load, against the rotation [Nm]; channels add up");
  d.stream_out(speed).doc("of the motor [rad/s]");
  d.stream_out(position).doc("of the motor [rad], not wrapped");
  d.stream_out(load_speed).doc("of the load [rad/s]");
  d.stream_out(load_position).doc("of the load [rad], not wrapped");
  d.message_in(properties)
      .optional()
      .record_type("bench_properties")
      .doc("hidden properties that replace the parameters of the same names, before the first sample");
  Setup s;
  for (const auto& n : numbers_of(s.parameters, s.physics, s.flutter)) {
    auto draft = d.parameter(n.name, n.fallback);
    draft.unit(n.unit).doc(n.doc);
    const bool positive =
        n.value == &s.parameters.motor_inertia || n.value == &s.parameters.load_inertia || n.value == &s.parameters.stiffness;
    if (positive) {
      draft.above(0).below(n.most);
    } else {
      draft.range(n.least, n.most);
    }
  }
  d.parameter("flutter_frequency", 0.7).unit("Hz").range(0, kMost).doc("of magnet_flutter");
}

void AxisBlock::configure(const Parameters& p) {
  for (const auto& n : numbers_of(given_.parameters, given_.physics, given_.flutter)) *n.value = p.number(n.name);
  flutter_hz_ = p.number("flutter_frequency");
}

void AxisBlock::resolve(Facts& f) {
  for (const In<double> port : {torque, compensation, load_torque}) f.delay(port, 1);
  const StreamFacts& u = f.in(torque);
  if (!u.known) return;
  for (const In<double> port : {torque, compensation}) {
    check_unit(f.in(port), "Nm");
    if (f.in(port).channels > 1) fail(std::string("'") + port.name + "' has several channels, allowed: 1");
  }
  check_unit(f.in(load_torque), "Nm");
  sample_s_ = 1.0 / u.rate.hz();
  for (const auto& [port, unit] : {std::pair{speed, "rad/s"}, {position, "rad"}, {load_speed, "rad/s"}, {load_position, "rad"}}) {
    StreamFacts& y = f.out(port);
    y = u;
    y.unit = unit;
    y.channel_units.clear();
    y.channel_names = {port.name};
    for (const char* name : {"excitation.amplitudes", "excitation.crest_factor", "noise.std"}) y.notes.erase(name);
  }
}

void AxisBlock::activate(const Activation&) { reset(); }

void AxisBlock::make_axis() {
  axis_ = std::make_unique<Axis>(setup_.parameters, setup_.physics, sample_s_);
  if (!(axis_->steps_per_sample() <= kMostSteps))
    fail("the axis is too fast for its sample rate: it needs " + std::to_string(axis_->steps_per_sample()) +
         " steps a sample, allowed: up to 2000; stiffness, damping and viscosities over the inertias set its rates");
}

void AxisBlock::reset() {
  setup_ = given_;
  make_axis();
  samples_ = 0;
}

void AxisBlock::receive(int, const RecordView& record, Io& io) {
  check_at_start(io.position());
  for (const auto& n : numbers_of(setup_.parameters, setup_.physics, setup_.flutter))
    take_property(record, n.name, n.least, n.most, *n.value);
  if (!(setup_.parameters.motor_inertia > 0 && setup_.parameters.load_inertia > 0 && setup_.parameters.stiffness > 0))
    fail("bench_properties: motor_inertia, load_inertia and stiffness, allowed: above 0");
  make_axis();
}

void AxisBlock::process(Io& io) {
  for (std::size_t n = 0; n < io.count(); ++n) {
    if (samples_ > 0) advance(io, n);
    ++samples_;
    const AxisState& x = axis_->state();
    if (!std::isfinite(x.motor_speed + x.load_speed + x.motor_angle + x.load_angle)) {
      fail("the axis has left the range of numbers at sample " + std::to_string(io.position() + n) +
           ": a torque beyond all axes, or more changes between sticking and sliding in a sample than can be followed");
    }
    io.write(speed)[n] = x.motor_speed;
    io.write(position)[n] = x.motor_angle;
    io.write(load_speed)[n] = x.load_speed;
    io.write(load_position)[n] = x.load_angle;
  }
}

void AxisBlock::advance(Io& io, std::size_t n) {
  const auto read = [&](In<double> port, int channel) {
    const double value = io.read(port, channel)[n];
    if (!std::isfinite(value))
      fail(std::string("'") + port.name + "' is not finite at sample " + std::to_string(io.position() + n - 1));
    return value;
  };
  double constant = 1.0;
  if (setup_.flutter != 0) {
    const double cycles = flutter_hz_ * (static_cast<double>(samples_ - 1) * sample_s_);
    constant += setup_.flutter * std::sin(2 * std::numbers::pi * (cycles - std::floor(cycles)));
  }
  AxisTorques t{constant * read(torque, 0), 0.0};
  if (io.connected(compensation)) t.motor += read(compensation, 0);
  for (int c = 0; c < io.channels(load_torque); ++c) t.load += read(load_torque, c);
  axis_->advance(t);
}

}  // namespace bodeflow::drive
