#include "connection_parameters.hpp"

namespace bodeflow::drive::modbus {

void describe_connection(Describe& d) {
  d.required<File>("map").doc("the register map of the drive, a YAML file: README.md of the plugin has its keys");
  d.parameter("connection", "tcp").choices({"tcp", "rtu"}).doc("Modbus TCP, or RTU on a serial line");
  d.parameter("host", std::string("127.0.0.1")).doc("TCP: address or name of the drive");
  d.parameter("port", std::int64_t{502}).range(1, 65535).doc("TCP: port");
  d.optional<std::string>("device").doc("RTU: the serial line, such as /dev/ttyUSB0");
  d.parameter("baud", std::int64_t{19200}).range(50, 4'000'000).doc("RTU: bits per second");
  d.parameter("parity", "even").choices({"none", "even", "odd"}).doc("RTU");
  d.parameter("stop_bits", std::int64_t{1}).range(1, 2).doc("RTU: 2 where there is no parity, says the standard");
  d.parameter("unit_id", std::int64_t{1}).range(1, 255).doc("of the drive on its line or behind its gateway; RTU: 1 to 247");
  d.parameter("timeout", 0.1).unit("s").range(0.001, 60).doc("for a whole answer");
  d.parameter("retries", std::int64_t{0})
      .range(0, 10)
      .doc("how often a question is asked again whose answer did not come or was damaged");
}

Endpoint read_connection(const Parameters& p) {
  Endpoint e;
  e.tcp = p.text("connection") == "tcp";
  e.host = p.text("host");
  e.port = static_cast<int>(p.integer("port"));
  if (p.has("device")) e.device = p.text("device");
  e.baud = static_cast<int>(p.integer("baud"));
  e.parity = p.text("parity") == "none" ? 'N' : p.text("parity") == "even" ? 'E' : 'O';
  e.stop_bits = static_cast<int>(p.integer("stop_bits"));
  e.unit_id = static_cast<int>(p.integer("unit_id"));
  e.timeout_s = p.number("timeout");
  e.retries = static_cast<int>(p.integer("retries"));
  constexpr int kLastUnit = 247;
  if (!e.tcp && e.device.empty()) fail("connection: rtu needs device: the serial line");
  if (e.tcp && e.host.empty()) fail("connection: tcp needs host");
  if (!e.tcp && e.unit_id > kLastUnit) fail("unit_id is " + std::to_string(e.unit_id) + ", allowed on a serial line: 1 to 247");
  return e;
}

}  // namespace bodeflow::drive::modbus
