#include "cia402.hpp"

#include <cstdio>
#include <utility>

namespace bodeflow::drive::modbus {

const char* name_of(DriveState state) {
  switch (state) {
    case DriveState::not_ready_to_switch_on:
      return "not_ready_to_switch_on";
    case DriveState::switch_on_disabled:
      return "switch_on_disabled";
    case DriveState::ready_to_switch_on:
      return "ready_to_switch_on";
    case DriveState::switched_on:
      return "switched_on";
    case DriveState::operation_enabled:
      return "operation_enabled";
    case DriveState::quick_stop_active:
      return "quick_stop_active";
    case DriveState::fault_reaction_active:
      return "fault_reaction_active";
    case DriveState::fault:
      break;
  }
  return "fault";
}

std::optional<DriveState> state_of(std::uint16_t statusword) {
  switch (statusword & 0x004FU) {  // bit 5, quick stop, means nothing in these
    case 0x0000:
      return DriveState::not_ready_to_switch_on;
    case 0x0040:
      return DriveState::switch_on_disabled;
    case 0x000F:
      return DriveState::fault_reaction_active;
    case 0x0008:
      return DriveState::fault;
    default:
      break;
  }
  switch (statusword & 0x006FU) {
    case 0x0021:
      return DriveState::ready_to_switch_on;
    case 0x0023:
      return DriveState::switched_on;
    case 0x0027:
      return DriveState::operation_enabled;
    case 0x0007:
      return DriveState::quick_stop_active;
    default:
      return std::nullopt;
  }
}

bool is_off(DriveState state) {
  return state == DriveState::not_ready_to_switch_on || state == DriveState::switch_on_disabled ||
         state == DriveState::ready_to_switch_on || state == DriveState::fault;
}

std::uint16_t toward_enabled(DriveState state) {
  switch (state) {
    case DriveState::switch_on_disabled:
      return kShutdown;
    case DriveState::ready_to_switch_on:
      return kSwitchOn;
    case DriveState::switched_on:
    case DriveState::operation_enabled:
      return kEnableOperation;
    default:
      return kDisableVoltage;
  }
}

std::string fault_text(unsigned code) {
  static constexpr std::pair<unsigned, const char*> kKnown[] = {
      {0x2310, "continuous over current"},        {0x2340, "short circuit"},
      {0x3210, "DC link over-voltage"},           {0x3220, "DC link under-voltage"},
      {0x4210, "the device is too hot"},          {0x4310, "the drive is too hot"},
      {0x7121, "the motor is blocked"},           {0x7305, "the encoder has failed"},
      {0x7500, "communication was lost"},         {0x8130, "communication was lost"},
      {0x8400, "the speed is off its set point"}, {0x8611, "following error"}};
  char number[16];
  std::snprintf(number, sizeof number, "0x%04x", code);
  for (const auto& [known, text] : kKnown) {
    if (known == code) return std::string(number) + ": " + text;
  }
  return number;
}

}  // namespace bodeflow::drive::modbus
