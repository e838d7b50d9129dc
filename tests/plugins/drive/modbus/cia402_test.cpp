#include "cia402.hpp"

#include "catch.hpp"

using namespace bodeflow::drive::modbus;

TEST_CASE("the state is told by the statusword whatever its other bits are") {
  const std::pair<unsigned, DriveState> kStates[] = {
      {0x0000, DriveState::not_ready_to_switch_on}, {0x0040, DriveState::switch_on_disabled},
      {0x0021, DriveState::ready_to_switch_on},     {0x0023, DriveState::switched_on},
      {0x0027, DriveState::operation_enabled},      {0x0007, DriveState::quick_stop_active},
      {0x000F, DriveState::fault_reaction_active},  {0x0008, DriveState::fault}};
  for (const auto& [word, state] : kStates) {
    for (const unsigned others : {0x0000U, 0xFF90U, 0x0610U, 0x8080U}) {
      CHECK(state_of(static_cast<std::uint16_t>(word | others)) == state);
    }
  }
  CHECK(state_of(0x0060) == DriveState::switch_on_disabled);  // bit 5 means nothing there
  CHECK_FALSE(state_of(0x0001).has_value());
  CHECK_FALSE(state_of(0x0067).has_value());
  CHECK_FALSE(state_of(0x004F).has_value());
}

TEST_CASE("the way to operation_enabled goes by shutdown and switch on and enable operation") {
  CHECK(toward_enabled(DriveState::switch_on_disabled) == 0x0006);
  CHECK(toward_enabled(DriveState::ready_to_switch_on) == 0x0007);
  CHECK(toward_enabled(DriveState::switched_on) == 0x000F);
  CHECK(toward_enabled(DriveState::operation_enabled) == 0x000F);
  CHECK(toward_enabled(DriveState::quick_stop_active) == 0x0000);
  CHECK(toward_enabled(DriveState::fault) == 0x0000);
}

TEST_CASE("common fault codes are put in words") {
  CHECK(fault_text(0x2310) == "0x2310: continuous over current");
  CHECK(fault_text(0x1234) == "0x1234");
}
