#include "register_map_file.hpp"

#include <fstream>
#include <sstream>

#include "catch.hpp"
#include "register_groups.hpp"

using namespace bodeflow::drive::modbus;

namespace {

const std::string kHead = "bodeflow_drive: 1\ndevice: d\npoll_rate: 100 Hz\n";
const std::string kWords = "registers:\n  controlword: {address: 1, access: write}\n  statusword: {address: 2}\n";

std::string problem(const std::string& text) {
  const auto map = parse_register_map(text, "map.yaml");
  return map ? "none" : map.error().text;
}

}  // namespace

TEST_CASE("the register map of the simulated drive is read with types units orders and limits") {
  const auto map = read_register_map(BODEFLOW_SOURCE_DIR "/graphs/drive/maps/simulated_drive.yaml");
  REQUIRE(map);
  CHECK(map->device == "simulated drive");
  CHECK(map->fastest_poll_hz == 200.0);
  const Register& target = map->registers.at(map->find("target_speed").value());
  CHECK(target.address == 0x20);
  CHECK(target.encoding == Encoding::int32);
  CHECK(target.order == WordOrder::high_first);
  CHECK(target.access == Access::both);
  CHECK(target.scale == 0.1);
  CHECK(target.unit == "rpm");
  CHECK(target.minimum == -1500.0);
  CHECK(target.maximum == 1500.0);
  CHECK(map->registers.at(map->find("torque").value()).order == WordOrder::low_first);
  CHECK(map->identity.at(0).value == 0xB0DE);
  CHECK(map->standstill->value == 5.0);
  CHECK(map->trace->rate_hz == 1000.0);
  CHECK(map->trace->words_per_sample() == 2);
  CHECK(map->names(true) ==
        std::vector<std::string>{"controlword", "mode", "watchdog", "ramp", "target_speed", "load_torque", "trace_arm"});
}

TEST_CASE("each error of a register map has its line and column and says what was found and what is allowed") {
  CHECK(problem(kHead + kWords) == "none");
  CHECK(problem(kHead + kWords + "  speed: {adress: 3}\n") ==
        "map.yaml:7:11: register 'speed': unknown key 'adress' (did you mean 'address'?), allowed: address, table, type, "
        "word_order, access, scale, unit, limits, safe\n"
        "map.yaml:7:3: register 'speed' has no 'address'");
  CHECK(problem(kHead + kWords + "  speed: {address: 010}\n") ==
        "map.yaml:7:20: register 'speed': address: '010' is no whole number, allowed: 0 to 65535, decimal or 0x...");
  CHECK(problem(kHead + kWords + "  speed: {address: 65535, type: int32}\n") ==
        "map.yaml:7:20: register 'speed': address is 65535, allowed: 0 to 65534, decimal or 0x...");
  CHECK(problem(kHead + kWords + "  speed: {address: 3, type: int33}\n") ==
        "map.yaml:7:29: register 'speed': type is 'int33' (did you mean 'int32'?), allowed: int16, uint16, int32, uint32, "
        "float32");
  CHECK(problem(kHead + kWords + "  speed: {address: 3, unit: rmp}\n") ==
        "map.yaml:7:29: register 'speed': unit 'rmp' is not known");
  CHECK(problem(kHead + kWords + "  speed: {address: 3, scale: 0}\n") ==
        "map.yaml:7:30: register 'speed': scale is 0, allowed: any other number");
  CHECK(problem(kHead + kWords + "  speed: {address: 3, unit: rpm, limits: [5, -5]}\n") ==
        "map.yaml:7:42: register 'speed': limits are 5 to -5, allowed: the lesser one first");
  CHECK(problem(kHead + kWords + "  speed: {address: 3, access: write, limits: [5, 9]}\n") ==
        "map.yaml:7:10: register 'speed': the safe value 0 is outside of the limits");
  CHECK(problem(kHead + kWords + "  speed: {address: 3, table: input, access: write}\n") ==
        "map.yaml:7:45: register 'speed': an input register can only be read");
  CHECK(problem(kHead + kWords + "  speed: {address: 3}\n  speed: {address: 4}\n") ==
        "map.yaml:8:3: registers: 'speed' stands twice");
  CHECK(problem(kHead + kWords + "identity: {statusword: 1, vendor: 7}\n") ==
        "map.yaml:7:27: identity: 'vendor' is no register, allowed: statusword");
  CHECK(problem(kHead + kWords + "setup: {statusword: 1}\n") ==
        "map.yaml:7:9: setup: 'statusword' can't be written, allowed: controlword");
  CHECK(problem(kHead + kWords + "  ramp: {address: 5, access: both, limits: [1, 9], safe: 1}\nsetup: {ramp: 10}\n") ==
        "map.yaml:8:15: setup: ramp is 10, allowed by its limits: 1 to 9");
  CHECK(problem(kHead + kWords + "  fault_code: {address: 5, type: float32}\n") ==
        "map.yaml:5:3: register 'fault_code', allowed: type uint16 without scale");
  CHECK(problem(kHead + kWords + "setup: {controlword: 70000}\n") ==
        "map.yaml:7:22: setup: controlword (holding register 0x0001) is to be 70000, allowed as uint16: 0 to 65535");
}

TEST_CASE("a register map without its head or without the words of CiA 402 is refused with all that is missing") {
  CHECK(problem("registers: {speed: {address: 1}}") ==
        "map.yaml:1:1: the map has no 'bodeflow_drive'\nmap.yaml:1:1: the map has no 'device'\n"
        "map.yaml:1:1: the map has no 'poll_rate'\nmap.yaml:1:12: registers: 'controlword' is missing\n"
        "map.yaml:1:12: registers: 'statusword' is missing");
  CHECK(problem("bodeflow_drive: 2\ndevice: d\npoll_rate: 100 s\n" + kWords) ==
        "map.yaml:1:17: bodeflow_drive is 2, allowed: 1 to 1, decimal or 0x...\n"
        "map.yaml:3:12: poll_rate: 100 s is a time; allowed: a frequency in Hz");
  CHECK(problem(kHead + kWords + "  watchdog: {address: 9, unit: A}\n") ==
        "map.yaml:5:3: register 'watchdog' has the unit A, allowed: s, ms, us");
  CHECK(problem("") == "map.yaml: 0 documents, allowed: one");
  CHECK(problem("[1, 2]").rfind("map.yaml:1:1: the map is a list, allowed: a map", 0) == 0);
  CHECK(problem("a: [1\nb: 2").rfind("map.yaml:2:", 0) == 0);
  CHECK(read_register_map("/no/such/map.yaml").error().text == "/no/such/map.yaml: can't be read");
}

TEST_CASE("a trace that would end beyond the last register is refused") {
  CHECK(problem(kHead + kWords +
                "  full: {address: 3}\n"
                "trace: {done: full, rate: 1 kHz, samples: 40000, address: 0, channels: {i: {type: int32}}}\n") ==
        "map.yaml:8:8: trace ends at register 80000, allowed: below 65536");
  CHECK(problem(kHead + kWords + "trace: {rate: 1 kHz, samples: 4, address: 0}\n") ==
        "map.yaml:7:8: trace has no 'done'\nmap.yaml:7:8: trace has no 'channels'");
}

TEST_CASE("neighbouring registers share a question and gaps are never read over") {
  const auto map = parse_register_map(kHead + kWords +
                                          "  a: {address: 3, type: int32}\n  b: {address: 6}\n  c: {address: 5}\n"
                                          "  d: {address: 8}\n  e: {address: 7, table: input}\n",
                                      "map.yaml");
  REQUIRE(map);
  std::vector<std::size_t> places;
  for (const char* name : {"statusword", "b", "a", "d", "e", "c"}) places.push_back(map->find(name).value());
  const auto groups = group_registers(*map, places, 125);
  REQUIRE(groups.size() == 3);
  CHECK(groups[0].address == 2);
  CHECK(groups[0].words == 5);
  CHECK(groups[0].members.size() == 4);
  CHECK(groups[0].members[1].index == 2);  // a
  CHECK(groups[0].members[1].offset == 1);
  CHECK(groups[1].address == 8);
  CHECK(groups[2].table == Table::input);
  CHECK(group_registers(*map, places, 3).size() == 4);
}

TEST_CASE("a register map with any character changed or cut anywhere is read or refused with a reason") {
  std::ifstream stream(BODEFLOW_SOURCE_DIR "/graphs/drive/maps/simulated_drive.yaml");
  std::ostringstream whole;
  whole << stream.rdbuf();
  const std::string text = whole.str();
  REQUIRE(text.size() > 1000);
  const std::string others = "{}[]:,-&*!'\"x0\n\t ";
  std::size_t refused = 0;
  for (std::size_t at = 0; at < text.size(); at += 7) {
    std::string changed = text;
    changed[at] = others[at % others.size()];
    for (const std::string& one : {changed, text.substr(0, at)}) {
      const auto map = parse_register_map(one, "map.yaml");
      if (map) continue;
      ++refused;
      CHECK(map.error().text.rfind("map.yaml:", 0) == 0);
    }
  }
  CHECK(refused > 100);
}

TEST_CASE("lists in lists without end and a list that holds itself are refused") {
  CHECK(problem(std::string(100'000, '[')).rfind("map.yaml:", 0) == 0);
  CHECK(problem("registers: &a {speed: *a}").rfind("map.yaml:", 0) == 0);
}
