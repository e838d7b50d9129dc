#pragma once

#include <bodeflow/numerics/error.hpp>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "cia402.hpp"
#include "link.hpp"
#include "register_groups.hpp"

namespace bodeflow::drive::modbus {

enum class DriveCommand { enable, disable, quick_stop };

/// What a client wants of its drive and how.
struct SessionSetup {
  RegisterMap map;
  Endpoint endpoint;
  std::vector<std::size_t> set_points;    ///< places in the map
  std::vector<std::size_t> measurements;  ///< places in the map
  bool drives = true;                     ///< false: reads alone, writes nothing
  bool reset_faults = false;              ///< a fault that is there at the start is reset
  bool arm_trace = false;                 ///< once operation is enabled
  double watchdog_s = 0.5;                ///< the drive's own
  double enable_time_s = 3.0;             ///< longest way to operation_enabled
  double stop_time_s = 3.0;               ///< longest way to a standstill
};

/// What one cycle read.
struct Polled {
  std::uint16_t statusword = 0;
  DriveState state = DriveState::not_ready_to_switch_on;
  double fault_code = 0.0;
  std::vector<double> measurements;
};

/// How a stop ended: whether the drive itself confirmed that its output stage is off, and the sentence for the user.
struct Stopped {
  bool confirmed = false;
  std::string text;
};

/// One drive under control of one client: state machine, set points, measurements. Blocks while it waits for answers.
class Session {
 public:
  /// Connects and checks that the device is the one of the map. Errors: those of Link, registers that are absent, an identity
  /// that differs, a drive that somebody else has enabled.
  static numerics::Expected<std::unique_ptr<Session>> open(SessionSetup setup);

  /// One cycle: the next controlword and the set points (their safe values until operation is enabled) are written, statusword,
  /// fault and measurements are read. Errors: those of Link; a fault; a state that was left without command; a limit that a
  /// measurement violates; a value that is not finite; no way to operation_enabled in time. The caller then stops.
  numerics::Expected<Polled> cycle(DriveCommand command, const std::vector<double>& set_points);

  /// Quick stop until the motor stands, then the output stage off; on a new connection where the old one is broken. Where the
  /// drive can't be reached the text says that its own watchdog is left to act.
  Stopped stop();

  std::int64_t retried() const { return link_->retried(); }
  /// What was read last.
  const Polled& polled() const { return polled_; }

 private:
  Session(SessionSetup setup, std::unique_ptr<Link> link);
  numerics::Expected<void> write_value(std::size_t place, double value);
  numerics::Expected<void> write_verified(const RegisterValue& wanted, const std::string& what);
  numerics::Expected<void> program_watchdog();
  numerics::Expected<void> prepare();
  numerics::Expected<std::uint16_t> next_word(DriveCommand command);
  numerics::Expected<void> write_set_points(DriveCommand command, const std::vector<double>& set_points);
  numerics::Expected<void> poll();
  numerics::Expected<void> take_statusword(double value);
  numerics::Expected<void> read_state();
  numerics::Expected<void> judge(DriveCommand command, DriveState before);
  numerics::Expected<void> check_measurements() const;
  numerics::Expected<void> stop_steps();
  numerics::Expected<bool> stands();
  std::string fault() const;

  SessionSetup s_;
  std::unique_ptr<Link> link_;
  std::size_t controlword_, statusword_;
  std::vector<RegisterGroup> written_, read_;
  std::vector<std::uint16_t> words_;
  std::vector<double> values_;  // as read_ gives them: statusword, measurements, fault code
  Polled polled_;
  std::uint16_t last_word_ = 0;
  bool prepared_ = false;     // watchdog and setup stand as they should
  bool was_enabled_ = false;  // since the last command to enable
  bool armed_ = false;
  bool has_written_ = false;
  double enabling_since_s_ = -1.0;
};

}  // namespace bodeflow::drive::modbus
