#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "field_oriented_control.hpp"

namespace bodeflow::drive::simulated {

/// States after CiA 402.
enum class State { switch_on_disabled, ready, switched_on, enabled, quick_stop, fault_reaction, fault };
const char* name_of(State state);

/// An induction motor on a speed-controlled inverter with the state machine of CiA 402, a communication watchdog, a ramp, a trace
/// buffer and a bank of registers, as a drive on a field bus shows itself. graphs/drive/simulated_drive.yaml is its register map.
/// Time goes on by `advance` alone: no clock in here.
class SimulatedDrive {
 public:
  SimulatedDrive();

  /// Lets that much time pass; at most 10 s at a time count.
  void advance(double seconds);

  /// The register at that address; nothing where there is none.
  std::optional<std::uint16_t> read(int address) const;
  enum class Written { done, no_such_register, bad_value };
  /// Writes neighbouring registers: all of them or none. Values of 32 bits must be written whole.
  Written write(int address, const std::uint16_t* words, int count);
  /// A valid question has come: the communication watchdog begins anew.
  void heard() { silent_s_ = 0.0; }

  /// A fault of the drive itself: the output stage switches off at once.
  void trip(std::uint16_t code);
  /// What the registers show in place of the measured speed [rpm]; nothing: the truth.
  void show_speed(std::optional<double> rpm) { shown_speed_rpm_ = rpm; }
  /// Makes it another device.
  void set_product(std::uint16_t product) { product_ = product; }
  /// The register of the watchdog keeps this value whatever is written; nothing: what is written.
  void stick_watchdog(std::optional<std::uint16_t> milliseconds) { stuck_watchdog_ = milliseconds; }

  State state() const { return state_; }
  bool output_stage_on() const;
  double speed_rpm() const;
  std::uint16_t fault_code() const { return fault_code_; }
  double time_s() const { return time_s_; }
  /// What happened since the last call, a line each.
  std::vector<std::string> take_events() { return std::exchange(events_, {}); }

 private:
  void command(std::uint16_t word);
  void enter(State state);
  void set_fault(std::uint16_t code);
  void react(std::uint16_t code);
  void step();
  void step_state();
  double target_rpm() const;
  void record();
  std::uint16_t statusword() const;
  bool store(int address, const std::uint16_t* words, int count, bool really);

  FieldOrientedControl::Setup control_setup_;
  FieldOrientedControl control_;
  std::unique_ptr<Motor> motor_;
  State state_ = State::switch_on_disabled;
  double time_s_ = 0.0, owed_s_ = 0.0, silent_s_ = 0.0, magnetised_s_ = 0.0;
  double reference_rpm_ = 0.0, ramp_rpm_s_ = 1500.0, target_rpm_ = 0.0, load_nm_ = 0.0;
  bool enable_wanted_ = false;
  std::uint16_t controlword_ = 0, fault_code_ = 0, watchdog_ms_ = 0, product_ = 0x0192;
  std::int16_t mode_ = 0;
  std::optional<double> shown_speed_rpm_;
  std::optional<std::uint16_t> stuck_watchdog_;
  std::vector<std::uint16_t> trace_;
  std::int64_t steps_ = 0;
  bool tracing_ = false;
  std::vector<std::string> events_;
};

}  // namespace bodeflow::drive::simulated
