#pragma once

#include <bodeflow/numerics/error.hpp>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "register_map.hpp"

struct _modbus;

namespace bodeflow::drive::modbus {

/// Where a drive is.
struct Endpoint {
  bool tcp = true;
  std::string host = "127.0.0.1";
  int port = 502;
  std::string device;  ///< of a serial line
  int baud = 19200;
  char parity = 'E';  ///< N, E, O
  int data_bits = 8;
  int stop_bits = 1;
  int unit_id = 1;
  double timeout_s = 0.1;  ///< for a whole answer
  int retries = 0;         ///< of a question whose answer did not come or was damaged
};

/// "127.0.0.1:502 unit 1", "/dev/ttyUSB0 unit 3".
std::string name_of(const Endpoint& endpoint);

/// A connection to one drive as Modbus client (master), by libmodbus. One thread at a time.
class Link {
 public:
  /// Errors: a host that is not known, a connection that is refused or does not come about, a serial line that can't be opened.
  static numerics::Expected<std::unique_ptr<Link>> open(const Endpoint& endpoint);

  /// Reads as many registers as `to` has places, at most 125. Errors: no answer, an exception of the drive, a damaged answer.
  numerics::Expected<void> read(Table table, int address, std::span<std::uint16_t> to);
  /// Writes holding registers, at most 123; one alone by function 6, several by function 16. Errors: as of `read`.
  numerics::Expected<void> write(int address, std::span<const std::uint16_t> words);

  /// Ends the connection and makes it anew; many drives take one client at a time. Errors: as of `open`.
  numerics::Expected<void> reconnect();

  const Endpoint& endpoint() const { return endpoint_; }
  std::int64_t retried() const { return retried_; }
  /// True when the last error was that of the connection, not an exception of the drive.
  bool broken() const { return broken_; }

 private:
  struct Close {
    void operator()(_modbus* context) const;
  };

  Link(const Endpoint& endpoint, _modbus* context) : endpoint_(endpoint), context_(context) {}
  numerics::Expected<void> connect();
  template <class Ask>
  numerics::Expected<void> transact(const std::string& what, Ask&& ask);

  Endpoint endpoint_;
  std::unique_ptr<_modbus, Close> context_;
  std::int64_t retried_ = 0;
  bool broken_ = false;
};

}  // namespace bodeflow::drive::modbus
