#include "link.hpp"

#include <modbus/modbus.h>
#include <netdb.h>
#include <sys/select.h>

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "records/signals.hpp"

namespace bodeflow::drive::modbus {
namespace {

using numerics::Expected;
using numerics::refused;

std::string exception_text(int error) {
  const int code = error - MODBUS_ENOBASE;
  static constexpr const char* kNames[] = {"",
                                           "illegal function",
                                           "illegal data address",
                                           "illegal data value",
                                           "device failure",
                                           "acknowledge",
                                           "device busy",
                                           "negative acknowledge",
                                           "memory parity error",
                                           "not defined",
                                           "gateway path unavailable",
                                           "gateway target device failed to respond"};
  return "the device answers with exception " + std::to_string(code) + " (" + kNames[code] + ")";
}

bool is_exception(int error) { return error >= EMBXILFUN && error <= EMBXGTAR; }

/// Errors after which the same question may be asked again on the same connection.
bool is_passing(int error) {
  return error == ETIMEDOUT || error == EMBBADCRC || error == EMBBADDATA || error == EMBBADSLAVE || error == EMBMDATA ||
         error == EMBXSBUSY;
}

std::string reason(int error, double timeout_s) {
  if (is_exception(error)) return exception_text(error);
  switch (error) {
    case ETIMEDOUT:
      return "no whole answer within " + records::short_number(timeout_s * 1e3) + " ms";
    case ECONNREFUSED:
      return "the connection is refused: nothing listens there";
    case ECONNRESET:
    case EPIPE:
      return "the connection was reset by the device";
    case EMBBADCRC:
      return "an answer with a wrong checksum";
    case EMBBADDATA:
      return "an answer that is not one to the question";
    case EMBBADSLAVE:
      return "an answer of another unit";
    case EMBBADEXC:
    case EMBUNKEXC:
      return "an exception that Modbus does not have";
    default:
      return modbus_strerror(error);
  }
}

Expected<void> check_host(const std::string& host) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  const int status = getaddrinfo(host.c_str(), nullptr, &hints, &found);
  if (status != 0) return refused("host '" + host + "': " + gai_strerror(status));
  freeaddrinfo(found);
  return {};
}

std::string hexadecimal(int address) {
  char text[16];
  std::snprintf(text, sizeof text, "0x%04x", static_cast<unsigned>(address));
  return text;
}

}  // namespace

std::string name_of(const Endpoint& e) {
  const std::string unit = " unit " + std::to_string(e.unit_id);
  return e.tcp ? e.host + ":" + std::to_string(e.port) + unit : e.device + unit;
}

void Link::Close::operator()(_modbus* context) const {
  modbus_close(context);
  modbus_free(context);
}

Expected<std::unique_ptr<Link>> Link::open(const Endpoint& e) {
  if (e.tcp) {
    if (auto known = check_host(e.host); !known) return tl::make_unexpected(known.error());
  }
  _modbus* context = e.tcp ? modbus_new_tcp_pi(e.host.c_str(), std::to_string(e.port).c_str())
                           : modbus_new_rtu(e.device.c_str(), e.baud, e.parity, e.data_bits, e.stop_bits);
  if (context == nullptr) return refused(name_of(e) + ": " + modbus_strerror(errno));
  std::unique_ptr<Link> link(new Link(e, context));
  const auto whole = static_cast<std::uint32_t>(e.timeout_s);
  const auto micro = static_cast<std::uint32_t>(std::llround((e.timeout_s - whole) * 1e6));
  modbus_set_response_timeout(context, whole, std::min<std::uint32_t>(micro, 999'999));
  modbus_set_byte_timeout(context, 0, 0);  // the whole answer within the time, however it trickles in
  if (modbus_set_slave(context, e.unit_id) != 0) return refused(name_of(e) + ": " + modbus_strerror(errno));
  if (auto connected = link->connect(); !connected) return tl::make_unexpected(connected.error());
  return link;
}

Expected<void> Link::connect() {
  if (modbus_connect(context_.get()) != 0) {
    return refused(name_of(endpoint_) + ": " + reason(errno == EINPROGRESS ? ETIMEDOUT : errno, endpoint_.timeout_s));
  }
  if (modbus_get_socket(context_.get()) < FD_SETSIZE) return {};
  return refused(name_of(endpoint_) + ": the process has more files open than libmodbus can take");
}

Expected<void> Link::reconnect() {
  modbus_close(context_.get());
  return connect();
}

template <class Ask>
Expected<void> Link::transact(const std::string& what, Ask&& ask) {
  for (int attempt = 0;; ++attempt) {
    errno = 0;
    if (ask()) {
      broken_ = false;
      return {};
    }
    const int error = errno;
    broken_ = !is_exception(error);
    modbus_flush(context_.get());
    if (attempt < endpoint_.retries && is_passing(error)) {
      ++retried_;
      continue;
    }
    const std::string times = attempt == 0 ? "" : " (asked " + std::to_string(attempt + 1) + " times)";
    return refused(name_of(endpoint_) + ": " + what + ": " + reason(error, endpoint_.timeout_s) + times);
  }
}

Expected<void> Link::read(Table table, int address, std::span<std::uint16_t> to) {
  const int count = static_cast<int>(to.size());
  const bool holding = table == Table::holding;
  const std::string what = "reading " + std::string(holding ? "holding" : "input") + " registers " + hexadecimal(address) +
                           " to " + hexadecimal(address + count - 1);
  return transact(what, [&] {
    return (holding ? modbus_read_registers : modbus_read_input_registers)(context_.get(), address, count, to.data()) == count;
  });
}

Expected<void> Link::write(int address, std::span<const std::uint16_t> words) {
  const int count = static_cast<int>(words.size());
  const std::string what = "writing holding registers " + hexadecimal(address) + " to " + hexadecimal(address + count - 1);
  return transact(what, [&] {
    if (count == 1) return modbus_write_register(context_.get(), address, words[0]) == 1;
    return modbus_write_registers(context_.get(), address, count, words.data()) == count;
  });
}

}  // namespace bodeflow::drive::modbus
