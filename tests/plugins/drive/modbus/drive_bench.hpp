#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "poller.hpp"
#include "register_map_file.hpp"
#include "simulated/modbus_server.hpp"

namespace bodeflow::test {

namespace modbus = drive::modbus;
namespace simulated = drive::simulated;

/// A simulated drive that serves on a thread.
class DriveBench {
 public:
  explicit DriveBench(bool is_tcp = true, int unit_id = 1)
      : is_tcp_(is_tcp),
        server_(is_tcp ? simulated::ModbusServer::tcp("127.0.0.1", 0, unit_id).value()
                       : simulated::ModbusServer::rtu(unit_id).value()),
        thread_([this] { server_->serve(stop_); }) {}
  ~DriveBench() {
    stop_ = true;
    thread_.join();
  }
  DriveBench(const DriveBench&) = delete;
  DriveBench& operator=(const DriveBench&) = delete;

  simulated::ModbusServer& server() { return *server_; }

  /// How a client reaches it, with set point target_speed and measurement speed.
  modbus::SessionSetup setup() const {
    modbus::SessionSetup s;
    s.map = modbus::read_register_map(BODEFLOW_SOURCE_DIR "/graphs/drive/maps/simulated_drive.yaml").value();
    s.map.file = "simulated_drive.yaml";
    s.endpoint.tcp = is_tcp_;
    s.endpoint.port = server_->port();
    s.endpoint.device = server_->line();
    s.endpoint.parity = 'N';      // a pseudo terminal has none
    s.endpoint.timeout_s = 0.25;  // on a machine that is busy with other tests too
    s.set_points = {s.map.find("target_speed").value()};
    s.measurements = {s.map.find("speed").value()};
    s.watchdog_s = 0.8;
    return s;
  }

  bool enabled() {
    return server_->with_drive([](auto& d) { return d.state() == simulated::State::enabled; });
  }
  double speed() {
    return server_->with_drive([](auto& d) { return d.speed_rpm(); });
  }
  std::uint16_t fault_code() {
    return server_->with_drive([](auto& d) { return d.fault_code(); });
  }
  bool output_stage_on() {
    return server_->with_drive([](auto& d) { return d.output_stage_on(); });
  }

  /// Waits until that is so; false: not within the time.
  static bool wait(const std::function<bool()>& is_so, double seconds = 5.0) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    while (!is_so()) {
      if (std::chrono::steady_clock::now() > end) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return true;
  }

  /// True when the motor stands and has no voltage, or will within the time: what every fault must end in.
  bool stops() {
    return wait([this] { return !output_stage_on() && std::abs(speed()) < 5.0; });
  }

 private:
  bool is_tcp_;
  std::atomic<bool> stop_{false};
  std::unique_ptr<simulated::ModbusServer> server_;
  std::thread thread_;
};

/// A client that polls every 5 ms.
class DriveClient {
 public:
  explicit DriveClient(modbus::SessionSetup setup) {
    auto session = modbus::Session::open(std::move(setup));
    if (!session) {
      failure_ = session.error().text;
      return;
    }
    poller_ = std::make_unique<modbus::Poller>(std::move(*session), modbus::Polled{});
  }

  /// Polls until that is so; "" or the error that came.
  std::string run_until(const std::function<bool(const modbus::Polled&)>& is_so, double rpm = 0.0,
                        modbus::DriveCommand command = modbus::DriveCommand::enable, double seconds = 5.0) {
    if (!poller_) return failure_;
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    modbus::Polled newest;
    while (std::chrono::steady_clock::now() < end) {
      const auto done = poller_->exchange(command, {rpm}, newest);
      if (!done) return done.error().text;
      if (!newest.measurements.empty() && is_so(newest)) return "";
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return "the time is over";
  }

  /// Enables the drive and runs it up to 300 rpm.
  std::string run_up() {
    return run_until([](const modbus::Polled& p) { return p.measurements[0] > 295.0; }, 300.0);
  }
  /// Polls until an error comes.
  std::string failure() {
    return run_until([](const modbus::Polled&) { return false; }, 300.0);
  }

  bool open() const { return poller_ != nullptr; }
  modbus::Poller& poller() { return *poller_; }

 private:
  std::string failure_;
  std::unique_ptr<modbus::Poller> poller_;
};

}  // namespace bodeflow::test
