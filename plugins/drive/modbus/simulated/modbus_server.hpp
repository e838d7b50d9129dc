#pragma once

#include <atomic>
#include <bodeflow/numerics/error.hpp>
#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "simulated_drive.hpp"

struct _modbus;
struct _modbus_mapping_t;

namespace bodeflow::drive::simulated {

/// What goes wrong between the drive and its client.
enum class Disturbance {
  none,
  silent,      ///< questions are lost
  half_frame,  ///< an answer breaks off
  reset,       ///< the connection is reset
  exception,   ///< every question is answered by exception 4, device failure
  damaged,     ///< an answer with a wrong checksum (RTU) or to another question (TCP)
  slow,        ///< answers come 30 ms late
  gone         ///< connections end, new ones are refused
};

/// A simulated drive as Modbus server (slave), by libmodbus, in real time.
class ModbusServer {
 public:
  /// Listens on that address; port 0 takes any that is free. Errors: an address or port that can't be had.
  static numerics::Expected<std::unique_ptr<ModbusServer>> tcp(const std::string& address, int port, int unit_id);
  /// A serial line that is a pseudo terminal: `line()` is the end for the client. Errors: no pseudo terminal.
  static numerics::Expected<std::unique_ptr<ModbusServer>> rtu(int unit_id);
  ~ModbusServer();
  ModbusServer(const ModbusServer&) = delete;
  ModbusServer& operator=(const ModbusServer&) = delete;

  /// Answers and lets the drive's time pass until `stop`.
  void serve(const std::atomic<bool>& stop);

  /// The next `count` questions meet this disturbance; a negative count: all.
  void disturb(Disturbance kind, int count = -1);

  /// Calls `look` with the drive, while nobody else touches it.
  template <class Look>
  auto with_drive(Look&& look) {
    const std::lock_guard lock(mutex_);
    return look(drive_);
  }

  int port() const { return port_; }
  const std::string& line() const { return line_; }

 private:
  ModbusServer(_modbus* context, int unit_id, bool is_tcp);
  void catch_up();
  void wait(int milliseconds);
  void accept_client();
  void drop(int socket);
  void answer(int socket);
  void reply(const std::uint8_t* question, int length);
  int read_exception(int address, int count);
  bool disturbed(int socket, const std::uint8_t* question, int length);
  void send_damaged(int socket, const std::uint8_t* question) const;
  void send_raw(int socket, const std::uint8_t* bytes, std::size_t count) const;
  void close_all();

  using Clock = std::chrono::steady_clock;

  std::mutex mutex_;
  SimulatedDrive drive_;
  _modbus* context_;
  _modbus_mapping_t* mapping_ = nullptr;
  int unit_id_;
  bool is_tcp_;
  int listener_ = -1, port_ = 0;
  int other_end_ = -1;  // of the pseudo terminal, kept open
  std::string line_;
  std::vector<int> sockets_;
  Clock::time_point now_ = Clock::now();
  Disturbance kind_ = Disturbance::none;
  int left_ = 0;
};

}  // namespace bodeflow::drive::simulated
