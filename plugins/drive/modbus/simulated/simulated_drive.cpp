#include "simulated_drive.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <numbers>
#include <stdexcept>

namespace bodeflow::drive::simulated {
namespace {

constexpr double kRpm = 30.0 / std::numbers::pi;  // rpm per rad/s
constexpr double kLongestAdvance = 10.0;
constexpr double kMagnetising = 0.15;      // s, two time constants of the rotor
constexpr double kQuickStopRamp = 4000.0;  // rpm/s
constexpr double kStandstill = 5.0;        // rpm
constexpr double kLargestTarget = 1500.0;  // rpm
constexpr double kLargestLoad = 10.0;      // Nm
constexpr std::uint16_t kVendor = 0xB0DE;
constexpr std::uint16_t kCommunicationLost = 0x8130;
constexpr std::int16_t kProfileVelocity = 3;
constexpr std::uint16_t kMostRamp = 10'000, kMostWatchdog = 10'000;

// Addresses.
constexpr int kVendorAt = 0x00, kProductAt = 0x01, kControlwordAt = 0x10, kModeAt = 0x11, kWatchdogAt = 0x12, kRampAt = 0x13,
              kTargetAt = 0x20, kLoadAt = 0x22, kStatuswordAt = 0x30, kFaultAt = 0x31, kSpeedAt = 0x32, kCurrentAt = 0x34,
              kTorqueAt = 0x35, kLinkAt = 0x37, kOutputAt = 0x38, kArmAt = 0x50, kDoneAt = 0x51, kTraceAt = 0x1000;
constexpr int kTraceEvery = 4;  // periods: 1 kHz
constexpr std::size_t kTraceWords = 2 * 1000;

FieldOrientedControl::Setup machine() {
  FieldOrientedControl::Setup s;
  s.motor = {4.85, 3.805, 0.274, 0.274, 0.258};  // a four-pole machine of 1.5 kW
  return s;
}

std::uint32_t bits_of(double value) {
  const auto number = static_cast<float>(value);
  std::uint32_t bits = 0;
  std::memcpy(&bits, &number, sizeof bits);
  return bits;
}

std::uint16_t high(std::uint32_t bits) { return static_cast<std::uint16_t>(bits >> 16U); }
std::uint16_t low(std::uint32_t bits) { return static_cast<std::uint16_t>(bits & 0xFFFFU); }

std::uint32_t tenths(double value) { return static_cast<std::uint32_t>(static_cast<std::int32_t>(std::lround(10.0 * value))); }

std::uint16_t short_of(double value) {
  return static_cast<std::uint16_t>(static_cast<std::int16_t>(std::lround(std::clamp(value, -32768.0, 32767.0))));
}

}  // namespace

const char* name_of(State state) {
  static constexpr const char* kNames[] = {"switch_on_disabled", "ready_to_switch_on",    "switched_on", "operation_enabled",
                                           "quick_stop_active",  "fault_reaction_active", "fault"};
  return kNames[static_cast<int>(state)];
}

SimulatedDrive::SimulatedDrive() : control_setup_(machine()), control_(control_setup_) {
  MotorSetup setup;
  setup.electrical = control_setup_.motor;
  setup.mechanics = {control_setup_.pole_pairs, control_setup_.inertia, 0.002, 0.0, false};
  setup.period_s = control_setup_.period_s;
  auto motor = make_motor(setup);
  if (!motor) throw std::logic_error(motor.error().text);
  motor_ = std::move(*motor);
}

bool SimulatedDrive::output_stage_on() const {
  return state_ == State::enabled || state_ == State::quick_stop || state_ == State::fault_reaction ||
         (state_ == State::switched_on && enable_wanted_);
}

double SimulatedDrive::speed_rpm() const { return motor_->outputs().speed * kRpm; }

void SimulatedDrive::enter(State state) {
  if (state == state_) return;
  char line[160];
  std::snprintf(line, sizeof line, "%9.3f s  %s -> %s, %.1f rpm", time_s_, name_of(state_), name_of(state), speed_rpm());
  events_.emplace_back(line);
  state_ = state;
  enable_wanted_ = false;
  if (output_stage_on()) return;
  control_.reset();
  magnetised_s_ = 0.0;
}

void SimulatedDrive::set_fault(std::uint16_t code) {
  fault_code_ = code;
  char line[64];
  std::snprintf(line, sizeof line, "%9.3f s  fault 0x%04x", time_s_, code);
  events_.emplace_back(line);
}

void SimulatedDrive::react(std::uint16_t code) {
  set_fault(code);
  enter(output_stage_on() ? State::fault_reaction : State::fault);
}

void SimulatedDrive::trip(std::uint16_t code) {
  set_fault(code);
  enter(State::fault);
}

void SimulatedDrive::command(std::uint16_t word) {
  const bool reset = (word & 0x80U) != 0 && (controlword_ & 0x80U) == 0;
  controlword_ = word;
  if (state_ == State::fault && reset) {
    fault_code_ = 0;
    enter(State::switch_on_disabled);
    return;
  }
  if (state_ == State::fault || state_ == State::fault_reaction || (word & 0x80U) != 0) return;
  if ((word & 0x02U) == 0) return enter(State::switch_on_disabled);  // disable voltage
  if ((word & 0x04U) == 0) {                                         // quick stop
    if (state_ == State::enabled) return enter(State::quick_stop);
    if (state_ != State::quick_stop) enter(State::switch_on_disabled);
    return;
  }
  if (state_ == State::quick_stop) return;
  if ((word & 0x01U) == 0) return enter(State::ready);  // shutdown
  if (state_ == State::switch_on_disabled) return;      // shutdown comes first
  if ((word & 0x08U) == 0) return enter(State::switched_on);
  if (state_ == State::ready) enter(State::switched_on);
  if (state_ == State::switched_on) enable_wanted_ = mode_ == kProfileVelocity;
}

void SimulatedDrive::advance(double seconds) {
  owed_s_ += std::clamp(seconds, 0.0, kLongestAdvance);
  const double period = control_setup_.period_s;
  for (; owed_s_ >= period; owed_s_ -= period) step();
}

double SimulatedDrive::target_rpm() const { return state_ == State::enabled ? target_rpm_ : 0.0; }

void SimulatedDrive::step() {
  const double period = control_setup_.period_s;
  time_s_ += period;
  silent_s_ += period;
  const MotorOutputs y = motor_->outputs();
  AlphaBeta voltage{};
  if (output_stage_on()) {
    const double ramp = (state_ == State::enabled ? ramp_rpm_s_ : kQuickStopRamp) * period;
    reference_rpm_ += std::clamp(target_rpm() - reference_rpm_, -ramp, ramp);
    magnetised_s_ += period;
    voltage = control_.voltage(y, reference_rpm_ / kRpm);
  } else {
    reference_rpm_ = y.speed * kRpm;
    // With all switches open the current dies through the diodes: a resistance much larger than the winding's.
    constexpr double kDiodes = 40.0;
    voltage = {-kDiodes * y.current.alpha, -kDiodes * y.current.beta};
  }
  // A brake holds against the motion, it does not turn the motor.
  const double load = load_nm_ * std::tanh(y.speed);
  motor_->advance(voltage, load);
  if (tracing_ && steps_ % kTraceEvery == 0) record();
  ++steps_;
  step_state();
}

void SimulatedDrive::step_state() {
  if (state_ == State::switched_on && enable_wanted_ && magnetised_s_ >= kMagnetising) enter(State::enabled);
  const bool stands = std::abs(speed_rpm()) < kStandstill && std::abs(reference_rpm_) < kStandstill;
  if (state_ == State::quick_stop && stands) enter(State::switch_on_disabled);
  if (state_ == State::fault_reaction && stands) enter(State::fault);
  const bool listens = state_ == State::enabled || (state_ == State::switched_on && enable_wanted_);
  if (listens && watchdog_ms_ > 0 && silent_s_ * 1e3 > watchdog_ms_) react(kCommunicationLost);
}

void SimulatedDrive::record() {
  const MotorOutputs y = motor_->outputs();
  trace_.push_back(short_of(10.0 * y.speed * kRpm));
  trace_.push_back(short_of(100.0 * y.torque));
  tracing_ = trace_.size() < kTraceWords;
}

std::uint16_t SimulatedDrive::statusword() const {
  constexpr unsigned kWords[] = {0x0040, 0x0021, 0x0023, 0x0027, 0x0007, 0x000F, 0x0008};
  unsigned word = kWords[static_cast<int>(state_)] | 0x0200U;
  if (state_ == State::ready || state_ == State::switched_on) word |= 0x0010U;
  if (output_stage_on()) word |= 0x0010U;
  if (std::abs(speed_rpm() - target_rpm()) < kStandstill) word |= 0x0400U;
  return static_cast<std::uint16_t>(word);
}

std::optional<std::uint16_t> SimulatedDrive::read(int address) const {
  const MotorOutputs y = motor_->outputs();
  const double speed = shown_speed_rpm_.value_or(y.speed * kRpm);
  switch (address) {
    case kVendorAt:
      return kVendor;
    case kProductAt:
      return product_;
    case kControlwordAt:
      return controlword_;
    case kModeAt:
      return static_cast<std::uint16_t>(mode_);
    case kWatchdogAt:
      return stuck_watchdog_.value_or(watchdog_ms_);
    case kRampAt:
      return static_cast<std::uint16_t>(ramp_rpm_s_);
    case kTargetAt:
      return high(tenths(target_rpm_));
    case kTargetAt + 1:
      return low(tenths(target_rpm_));
    case kLoadAt:
      return low(bits_of(load_nm_));
    case kLoadAt + 1:
      return high(bits_of(load_nm_));
    case kStatuswordAt:
      return statusword();
    case kFaultAt:
      return fault_code_;
    case kSpeedAt:
      return high(tenths(speed));
    case kSpeedAt + 1:
      return low(tenths(speed));
    case kCurrentAt:
      return short_of(100.0 * std::hypot(y.current.alpha, y.current.beta) / std::numbers::sqrt2);
    case kTorqueAt:
      return low(bits_of(y.torque));
    case kTorqueAt + 1:
      return high(bits_of(y.torque));
    case kLinkAt:
      return short_of(5400.0);
    case kOutputAt:
      return output_stage_on() ? 1 : 0;
    case kArmAt:
      return tracing_ ? 1 : 0;
    case kDoneAt:
      return trace_.size() >= kTraceWords ? 1 : 0;
    default:
      break;
  }
  if (address < kTraceAt || address >= kTraceAt + static_cast<int>(kTraceWords)) return std::nullopt;
  const auto at = static_cast<std::size_t>(address - kTraceAt);
  return at < trace_.size() ? trace_[at] : std::uint16_t{0};
}

SimulatedDrive::Written SimulatedDrive::write(int address, const std::uint16_t* words, int count) {
  const auto width = [](int at) {
    if (at == kTargetAt || at == kLoadAt) return 2;
    return at == kControlwordAt || at == kModeAt || at == kWatchdogAt || at == kRampAt || at == kArmAt ? 1 : 0;
  };
  for (const bool really : {false, true}) {
    for (int at = address; at < address + count; at += width(at)) {
      if (width(at) == 0 || at + width(at) > address + count) return Written::no_such_register;
      if (!store(at, words + (at - address), width(at), really)) return Written::bad_value;
    }
  }
  return Written::done;
}

/// One quantity; false where the value is not allowed. Nothing changes unless `really`.
bool SimulatedDrive::store(int address, const std::uint16_t* words, int, bool really) {
  const std::uint16_t word = words[0];
  switch (address) {
    case kControlwordAt:
      if (really) command(word);
      return true;
    case kModeAt:
      if (really) mode_ = static_cast<std::int16_t>(word);
      return word == kProfileVelocity || word == 0;
    case kWatchdogAt:
      if (really) watchdog_ms_ = word;
      return word <= kMostWatchdog;
    case kRampAt:
      if (really) ramp_rpm_s_ = word;
      return word > 0 && word <= kMostRamp;
    case kTargetAt: {
      const double target = static_cast<std::int32_t>(static_cast<std::uint32_t>(words[0]) << 16U | words[1]) / 10.0;
      if (!(std::abs(target) <= kLargestTarget)) return false;
      if (really) target_rpm_ = target;
      return true;
    }
    case kLoadAt: {
      const auto bits = static_cast<std::uint32_t>(words[1]) << 16U | words[0];
      float load = 0.0F;
      std::memcpy(&load, &bits, sizeof load);
      if (!(load >= 0.0F && load <= kLargestLoad)) return false;
      if (really) load_nm_ = static_cast<double>(load);
      return true;
    }
    case kArmAt:
      if (really && word == 1) {
        trace_.clear();
        tracing_ = true;
      }
      return word <= 1;
    default:
      return false;
  }
}

}  // namespace bodeflow::drive::simulated
