#include "induction_motor_block.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "bench_properties.hpp"
#include "motor_form.hpp"
#include "motor_network.hpp"

namespace bodeflow::drive {
namespace {

constexpr double kTwoPi = 6.283185307179586477;
constexpr double kWarmSteps = 1000.0;     // of the stator resistance in a thermal time
constexpr double kSlowestWarmStep = 1e6;  // [s]

std::vector<std::string> axis_names(const std::string& quantity, int axes) {
  std::vector<std::string> names = {quantity + "_alpha", quantity + "_beta"};
  names.resize(static_cast<std::size_t>(axes));
  return names;
}

/// Axes of the motor that a stream feeds.
int axes_of(const StreamFacts& facts, bool is_legs) {
  const int one = is_legs ? 5 : 1, two = is_legs ? 7 : 2;
  if (facts.channels == one) return 1;
  if (facts.channels == two) return 2;
  fail(std::string(is_legs ? "'legs'" : "'voltage'") + " has " + std::to_string(facts.channels) +
       " channels, allowed: " + std::to_string(one) + " (alpha alone) or " + std::to_string(two));
}

double finite_or_fail(Io& io, In<double> port, int channel, std::size_t n) {
  const double value = io.read(port, channel)[n];
  if (!std::isfinite(value)) {
    fail(std::string("'") + port.name + "' is not finite at sample " + std::to_string(io.position() + n - 1));
  }
  return value;
}

}  // namespace

void InductionMotor::describe(Describe& d) {
  d.id("drive.induction_motor")
      .summary("Simulates an induction motor, at standstill or turning, between the switching instants of its inverter.")
      .role("plant")
      .realtime_safe()
      .cost_ns(150);
  d.doc(
      "Samples are taken at the start of each period (carrier-synchronous), so the motor waits for the voltage of the period "
      "before and stands in a loop with its inverter as it is. Vectors are in the stator frame, amplitude-invariant (peak values "
      "of a phase of the star); torque = 3/2 pole_pairs lm/lr (psi_a i_b - psi_b i_a). One channel of voltage is the alpha axis "
      "alone, where no torque arises and the rotor stands still. At standstill and without saturation the solution is exact for "
      "any switching; else a Runge-Kutta method of order 4 steps from one switching instant to the next. README.md has the "
      "equations of the hidden physics.");
  d.reference(
      "P. Castaldi, M. Montanari, A. Tilli, Induction motor model identification via frequency-domain Frisch scheme, "
      "IFAC 2002, equation (16)");
  d.stream_in(legs).optional().doc("switching instants and link voltage of drive.inverter");
  d.stream_in(voltage).optional().doc(
      "in place of legs: mean voltage of each period, alpha-beta [V]; holds where both are connected");
  d.stream_in(load_torque).optional().doc("torques against the rotation [Nm]; channels add up");
  d.stream_out(current).doc("stator current [A]");
  d.stream_out(torque).doc("at the air gap [Nm]");
  d.stream_out(speed).doc("of the shaft [rad/s, mechanical]");
  d.stream_out(position).doc("of the shaft [rad, mechanical], not wrapped");
  d.stream_out(flux).doc("linked with the rotor, in the stator frame [Wb]");
  d.message_in(properties)
      .optional()
      .record_type("bench_properties")
      .doc(
          "hidden properties that replace parameters: rs, rr, ls, lr, lm, saturation_current, saturation_share, bar_height, "
          "iron_loss_resistance, resistance_drift, contact_resistance, rectifying_resistance");
  describe_motor_form(d);
  d.parameter("pole_pairs", std::int64_t{1}).range(1, 1000).doc("electrical over mechanical speed");
  d.parameter("standstill", false).doc("the rotor is locked; with one channel of voltage it stands still anyway");
  d.optional<double>("inertia").unit("kg m^2").above(0).doc("of rotor and load; needed where the rotor may turn");
  d.parameter("friction", 0.0).unit("Nm s/rad").range(0, 1e6).doc("torque over speed");
  d.parameter("initial_speed", 0.0).unit("rad/s").range(-1e5, 1e5).doc("of the shaft at the first sample");
  d.parameter("saturation_current", 0.0)
      .unit("A")
      .range(0, 1e6)
      .doc("isat of psi = lm ((1 - share) i + share isat tanh(i / isat)), peak magnetising current; 0: linear");
  d.parameter("saturation_share", 0.75).unit("1").range(0, 0.99).doc("share of that law");
  d.parameter("bar_height", 0.0)
      .unit("m")
      .range(0, 1)
      .doc("height of the rotor bars: the field diffuses into them; 0: no skin effect");
  d.parameter("bar_share", 0.6).unit("1").above(0).range(0, 1).doc("of the rotor resistance that lies in the slots");
  d.parameter("bar_conductivity", 2.7e7).unit("S/m").above(0).below(1e9).doc("of the bars; warm aluminium");
  d.parameter("iron_loss_resistance", 0.0)
      .unit("ohm")
      .range(0, 1e6)
      .doc("parallel to the magnetising inductance; 0: no iron loss");
  d.parameter("resistance_drift", 0.0)
      .unit("1")
      .range(-0.9, 10)
      .doc("final relative rise of rs: rs (1 + drift (1 - exp(-t / thermal_time)))");
  d.parameter("thermal_time", 300.0).unit("s").above(0).below(1e9).doc("time constant of the drift");
  d.parameter("contact_resistance", 0.0)
      .unit("ohm")
      .range(0, 1e6)
      .doc("of a loose terminal of phase a: comes and goes at random, each state lasting 0.4 s in the mean; 0: firm");
  d.parameter("rectifying_resistance", 0.0)
      .unit("ohm")
      .range(0, 1e6)
      .doc("of a corroded terminal of phase a: the drop is this times |i|; 0: none");
  d.optional<std::int64_t>("seed").range(0, 9e18).doc(
      "fixes the loose terminal; without it the run's seed and the block's name do");
}

void InductionMotor::configure(const Parameters& p) {
  given_.electrical = read_motor_form(p);
  given_.hidden = {p.number("saturation_current"), p.number("saturation_share"), p.number("bar_height"),
                   p.number("bar_share"),          p.number("bar_conductivity"), p.number("iron_loss_resistance"),
                   p.number("resistance_drift"),   p.number("thermal_time")};
  given_.mechanics = {static_cast<double>(p.integer("pole_pairs")), p.has("inertia") ? p.number("inertia") : 0.0,
                      p.number("friction"), p.number("initial_speed"), p.boolean("standstill")};
  given_faults_ = {p.number("contact_resistance"), p.number("rectifying_resistance")};
  own_seed_ = p.has("seed");
  if (own_seed_) seed_ = static_cast<std::uint64_t>(p.integer("seed"));
}

/// The setup with the rotor locked where nothing can turn it.
MotorSetup InductionMotor::setup_for(int axes) const {
  MotorSetup setup = given_;
  setup.mechanics.locked = given_.mechanics.locked || axes == 1;
  return setup;
}

void InductionMotor::resolve(Facts& f) {
  f.delay(legs, 1);
  f.delay(voltage, 1);
  f.delay(load_torque, 1);
  const bool is_legs = !f.in(voltage).known;
  const StreamFacts& u = is_legs ? f.in(legs) : f.in(voltage);
  axes_ = 0;
  if (!u.known) return;
  if (is_legs && !u.note("drive.averaged").empty()) {
    fail("the inverter has mode: averaged; allowed: connect its output 'voltage', or take mode: switching");
  }
  axes_ = axes_of(u, is_legs);
  given_.period_s = 1.0 / u.rate.hz();
  const auto motor = make_motor(setup_for(axes_));
  if (!motor) fail(motor.error().text);
  const auto state = [&](Out<double> port, int channels, const char* name, const char* unit) {
    StreamFacts& y = f.out(port);
    y.known = true;
    y.channels = channels;
    y.rate = u.rate;
    y.length = u.length;
    y.clock = u.clock;
    y.unit = unit;
    if (channels == axes_ && port.index != speed.index) y.channel_names = axis_names(name, axes_);
    state_notes(u, y, axes_);
  };
  state(current, axes_, "i", "A");
  state(torque, 1, "", "Nm");
  state(speed, 1, "", "rad/s");
  state(position, 1, "", "rad");
  state(flux, axes_, "psi", "Wb");
  f.out(torque).channel_names = {"torque"};
  f.out(speed).channel_names = {"speed"};
  f.out(position).channel_names = {"position"};
}

/// The lines of the excitation, and the modes of a motor that is known to stand still.
void InductionMotor::state_notes(const StreamFacts& from, StreamFacts& to, int axes) const {
  for (const char* name : {"excitation.period", "excitation.experiment", "excitation.frequencies"}) {
    if (from.notes.count(name) != 0) to.notes[name] = from.note(name);
  }
  const auto network = motor_network(given_.electrical, given_.hidden);
  if (!network || !setup_for(axes).mechanics.locked) return;
  const LoopVector rates = modes_of(network->inductance, network->resistance).rates;
  std::vector<double>& modes = to.notes["plant.modes"] = from.note("plant.modes");
  for (const double rate : rates) modes.push_back(rate / kTwoPi);
  std::sort(modes.begin(), modes.end());
  const std::vector<double> before = from.note("plant.settling_time");
  to.notes["plant.settling_time"] = {std::max(5.0 / rates[0], before.empty() ? 0.0 : before[0])};
}

void InductionMotor::advise(const Facts& f, Advice& a) {
  if (f.in(legs).channels > 0 && f.in(voltage).channels > 0) {
    a.warn("both 'legs' and 'voltage' are connected: the motor takes 'voltage', without the switching");
  }
}

void InductionMotor::activate(const Activation& a) {
  if (!own_seed_) seed_ = a.seed;
  if (axes_ == 0) fail("the motor has no supply: connect an inverter to 'legs', or a voltage to 'voltage'");
  reset();
  const double step_s = std::clamp(given_.hidden.thermal_time / kWarmSteps, given_.period_s, kSlowestWarmStep);
  warm_every_ = static_cast<std::uint64_t>(std::round(step_s / given_.period_s));
}

void InductionMotor::reset() {
  setup_ = setup_for(axes_);
  auto made = make_motor(setup_);
  if (!made) fail(made.error().text);
  motor_ = std::move(*made);
  take_faults(given_faults_);
  periods_ = 0;
}

/// The motor goes on with its winding currents, speed and position; eddy currents begin at zero.
void InductionMotor::receive(int, const RecordView& record, Io&) {
  MotorSetup changed = setup_;
  MotorParameters& e = changed.electrical;
  HiddenPhysics& h = changed.hidden;
  constexpr double kMost = 1e6;
  for (const auto& [name, value] : {std::pair{"rs", &e.rs}, {"rr", &e.rr}, {"ls", &e.ls}, {"lr", &e.lr}, {"lm", &e.lm}}) {
    take_property(record, name, 0.0, kMost, *value);
  }
  take_property(record, "saturation_current", 0.0, kMost, h.saturation_current);
  take_property(record, "saturation_share", 0.0, 0.99, h.saturation_share);
  take_property(record, "bar_height", 0.0, 1.0, h.bar_height);
  take_property(record, "iron_loss_resistance", 0.0, kMost, h.iron_loss_resistance);
  take_property(record, "resistance_drift", -0.9, 10.0, h.resistance_drift);
  auto made = make_motor(changed);
  if (!made) fail("bench_properties: " + made.error().text);
  MotorState state = motor_->state();
  state.currents.conservativeResize(2, 2);
  motor_ = std::move(*made);
  motor_->set_state(state);
  setup_ = changed;
  if (setup_.hidden.resistance_drift != 0.0) warm();
  ContactFaults faults = faults_;
  take_property(record, "contact_resistance", 0.0, kMost, faults.loose_ohm);
  take_property(record, "rectifying_resistance", 0.0, kMost, faults.rectifying_ohm);
  take_faults(faults);
}

void InductionMotor::take_faults(const ContactFaults& faults) {
  faults_ = faults;
  contact_.reset();
  if (faults_.loose_ohm != 0.0 || faults_.rectifying_ohm != 0.0) contact_.emplace(faults_, given_.period_s, seed_);
}

void InductionMotor::process(Io& io) {
  for (std::size_t n = 0; n < io.count(); ++n) {
    if (periods_ > 0) advance(io, n);
    ++periods_;
    write(io, n);
  }
}

void InductionMotor::advance(Io& io, std::size_t n) {
  if (setup_.hidden.resistance_drift != 0.0 && periods_ % warm_every_ == 0) warm();
  if (contact_) motor_->set_drop(contact_->drop(motor_->outputs().current.alpha));
  double load = 0.0;
  for (int c = 0; c < io.channels(load_torque); ++c) load += finite_or_fail(io, load_torque, c, n);
  if (!io.connected(voltage)) return advance_legs(io, n, load);
  motor_->advance({finite_or_fail(io, voltage, 0, n), axes_ == 2 ? finite_or_fail(io, voltage, 1, n) : 0.0}, load);
}

void InductionMotor::advance_legs(Io& io, std::size_t n, double load) {
  const int count = axes_ == 2 ? 3 : 2;
  std::array<Pulse, 3> pulses;
  for (int leg = 0; leg < count; ++leg) {
    Pulse& p = pulses[static_cast<std::size_t>(leg)];
    p = {io.read(legs, 2 * leg)[n], io.read(legs, 2 * leg + 1)[n]};
    if (!(p.on >= 0.0 && p.on <= p.off && p.off <= setup_.period_s)) {
      fail("'legs' has instants outside the order 0 <= on <= off <= period at sample " + std::to_string(io.position() + n - 1));
    }
  }
  if (count == 2) pulses[2] = pulses[1];
  motor_->advance(pulses, finite_or_fail(io, legs, 2 * count, n), load);
}

void InductionMotor::warm() {
  const double time_s = static_cast<double>(periods_) * setup_.period_s;
  const double rise = setup_.hidden.resistance_drift * -std::expm1(-time_s / setup_.hidden.thermal_time);
  motor_->set_stator_resistance(setup_.electrical.rs * (1.0 + rise));
}

void InductionMotor::write(Io& io, std::size_t n) const {
  const MotorOutputs y = motor_->outputs();
  if (!std::isfinite(y.current.alpha + y.current.beta + y.speed)) {
    fail("the motor has left the range of numbers at sample " + std::to_string(io.position() + n) +
         ": a voltage, a load torque or a speed beyond all machines, or an inertia too small for the PWM period");
  }
  io.write(current, 0)[n] = y.current.alpha;
  io.write(flux, 0)[n] = y.flux.alpha;
  if (axes_ == 2) {
    io.write(current, 1)[n] = y.current.beta;
    io.write(flux, 1)[n] = y.flux.beta;
  }
  io.write(torque)[n] = y.torque;
  io.write(speed)[n] = y.speed;
  io.write(position)[n] = y.position;
}

}  // namespace bodeflow::drive
