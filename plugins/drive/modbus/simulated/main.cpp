// bodeflow-simulated-drive: a drive on Modbus that is not there. README.md tells how to use it.
#include <signal.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <map>
#include <thread>

#include "modbus_server.hpp"

using namespace bodeflow::drive::simulated;

namespace {

std::atomic<bool> stop{false};

struct Injection {
  std::string kind;
  double after_s = 1.0;
};

const std::map<std::string, Disturbance> kDisturbances{{"silent", Disturbance::silent},   {"half_frame", Disturbance::half_frame},
                                                       {"reset", Disturbance::reset},     {"exception", Disturbance::exception},
                                                       {"damaged", Disturbance::damaged}, {"slow", Disturbance::slow},
                                                       {"gone", Disturbance::gone}};

std::string kinds() {
  std::string all = "drive_fault, speed";
  for (const auto& [name, kind] : kDisturbances) all += ", " + name;
  return all;
}

Injection parse_injection(const std::string& text) {
  const std::size_t at = text.find('@');
  Injection injection;
  injection.kind = text.substr(0, at);
  if (kDisturbances.count(injection.kind) == 0 && injection.kind != "drive_fault" && injection.kind != "speed")
    throw CLI::ValidationError("--inject", "'" + injection.kind + "', allowed: " + kinds());
  if (at != std::string::npos && !CLI::detail::lexical_cast(text.substr(at + 1), injection.after_s))
    throw CLI::ValidationError("--inject", "'" + text + "', allowed: KIND@SECONDS");
  return injection;
}

void inject(ModbusServer& server, const std::string& kind) {
  constexpr std::uint16_t kOverCurrent = 0x2310;
  static constexpr double kImpossible = 2500.0;  // rpm
  if (kind == "drive_fault") {
    server.with_drive([](SimulatedDrive& d) { d.trip(kOverCurrent); });
  } else if (kind == "speed") {
    server.with_drive([](SimulatedDrive& d) { d.show_speed(kImpossible); });
  } else {
    server.disturb(kDisturbances.at(kind));
  }
  std::printf("           injected: %s\n", kind.c_str());
}

/// Prints what happens and injects what is due.
void watch(ModbusServer& server, const std::vector<Injection>& injections) {
  double enabled_at = -1.0;
  std::vector<bool> done(injections.size(), false);
  while (!stop) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    std::vector<std::string> events;
    double now = 0.0;
    server.with_drive([&](SimulatedDrive& d) {
      events = d.take_events();
      now = d.time_s();
      if (enabled_at < 0.0 && d.state() == State::enabled) enabled_at = now;
    });
    for (const std::string& event : events) std::puts(event.c_str());
    for (std::size_t i = 0; i < injections.size(); ++i) {
      if (done[i] || enabled_at < 0.0 || now < enabled_at + injections[i].after_s) continue;
      done[i] = true;
      inject(server, injections[i].kind);
    }
    std::fflush(stdout);
  }
}

int run(int argc, char** argv) {
  CLI::App app(
      "A simulated drive on Modbus: an induction motor of 1.5 kW with speed control, states after CiA 402 and a watchdog");
  std::string address = "127.0.0.1", link;
  int port = 1502, unit = 1;
  std::vector<std::string> wanted;
  app.add_option("--address", address, "where to listen")->capture_default_str();
  app.add_option("--port", port, "TCP port; 0: any that is free")->capture_default_str()->check(CLI::Range(0, 65535));
  app.add_option("--unit", unit, "unit id")->capture_default_str()->check(CLI::Range(1, 247));
  app.add_option("--rtu", link, "RTU on a pseudo terminal instead of TCP; a link to it is made at this path");
  app.add_option("--inject", wanted, "KIND@SECONDS after the first enabling; kinds: " + kinds());
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  std::vector<Injection> injections;
  try {
    for (const std::string& text : wanted) injections.push_back(parse_injection(text));
  } catch (const CLI::ValidationError& error) {
    std::fprintf(stderr, "bodeflow-simulated-drive: %s\n", error.what());
    return 2;
  }
  auto server = link.empty() ? ModbusServer::tcp(address, port, unit) : ModbusServer::rtu(unit);
  if (!server) {
    std::fprintf(stderr, "bodeflow-simulated-drive: %s\n", server.error().text.c_str());
    return 5;
  }
  if (!link.empty() && ::symlink((*server)->line().c_str(), link.c_str()) != 0) {
    std::fprintf(stderr, "bodeflow-simulated-drive: %s: a link can't be made there\n", link.c_str());
    return 5;
  }
  if (link.empty()) {
    std::printf("listening on %s:%d, unit %d\n", address.c_str(), (*server)->port(), unit);
  } else {
    std::printf("listening on %s (%s), unit %d\n", link.c_str(), (*server)->line().c_str(), unit);
  }
  std::fflush(stdout);
  struct sigaction end {};
  end.sa_handler = [](int) { stop = true; };
  ::sigaction(SIGINT, &end, nullptr);
  ::sigaction(SIGTERM, &end, nullptr);
  std::thread serving([&] { (*server)->serve(stop); });
  watch(**server, injections);
  serving.join();
  if (!link.empty()) ::unlink(link.c_str());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "bodeflow-simulated-drive: %s\n", e.what());
    return 1;
  }
}
