#pragma once

#include <cstdint>
#include <optional>
#include <string>

/// States of a drive and the words that move it through them.
/// Reference: IEC 61800-7-201 (CiA 402-2), controlword 0x6040, statusword 0x6041.
namespace bodeflow::drive::modbus {

enum class DriveState {
  not_ready_to_switch_on,
  switch_on_disabled,
  ready_to_switch_on,
  switched_on,
  operation_enabled,
  quick_stop_active,
  fault_reaction_active,
  fault
};

const char* name_of(DriveState state);

inline constexpr std::uint16_t kDisableVoltage = 0x0000;
inline constexpr std::uint16_t kQuickStop = 0x0002;
inline constexpr std::uint16_t kShutdown = 0x0006;
inline constexpr std::uint16_t kSwitchOn = 0x0007;
inline constexpr std::uint16_t kEnableOperation = 0x000F;
inline constexpr std::uint16_t kFaultReset = 0x0080;

inline constexpr std::uint16_t kRemoteBit = 0x0200;         ///< of the statusword: the drive obeys the controlword
inline constexpr std::uint16_t kTargetReachedBit = 0x0400;  ///< of the statusword; in quick_stop_active: the motor has stopped

/// The state that a statusword tells; nothing for a pattern that is none.
std::optional<DriveState> state_of(std::uint16_t statusword);

/// True where the output stage gives no torque for good.
bool is_off(DriveState state);

/// The controlword for the next step from `state` to operation_enabled.
std::uint16_t toward_enabled(DriveState state);

/// "0x8130: communication was lost", with the meaning where CiA 301/402 gives one that is common.
std::string fault_text(unsigned code);

}  // namespace bodeflow::drive::modbus
