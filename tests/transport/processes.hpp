#pragma once

#include <chrono>
#include <map>
#include <string>
#include <vector>

/// A process of a test: its standard output goes to a file. Killed when it goes out of scope.
class Process {
 public:
  /// `timeout -k 1 60` and the command; `most_s` in place of the minute.
  explicit Process(std::vector<std::string> command, int most_s = 60);
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
  ~Process();

  /// The exit code; 124 after its time.
  int wait();
  void signal(int number) const;
  /// SIGINT to the command alone, once: `timeout` would hand it on a second time.
  void interrupt() const;
  /// What it has printed so far.
  std::string output() const;
  /// Waits until it has printed that; false: it ended or `seconds` passed before.
  bool prints(const std::string& text, double seconds = 20.0);
  /// The last value printed as `name=value`; empty: none.
  std::string value(const std::string& name) const;
  double number(const std::string& name) const;

 private:
  bool ended();

  std::string file_;
  int pid_ = -1;
  int code_ = -1;
};

/// Network namespaces joined by a bridge, with addresses 10.99.0.1 and so on; removed when it goes out of scope.
class Hosts {
 public:
  explicit Hosts(int count);
  Hosts(const Hosts&) = delete;
  Hosts& operator=(const Hosts&) = delete;
  ~Hosts();

  /// Why there are none; empty: they are there.
  const std::string& missing() const { return missing_; }
  /// The command in a host's namespace.
  std::vector<std::string> on(int host, std::vector<std::string> command) const;
  static std::string address(int host) { return "10.99.0." + std::to_string(host + 1); }
  /// The link between a host and the bridge.
  void link(int host, bool up) const;

 private:
  std::string name(int host) const { return prefix_ + std::to_string(host); }

  std::string prefix_;
  std::string missing_;
  int count_;
};

/// The command `peer what options...`, in a DDS domain that no other test of this machine uses at the same time.
std::vector<std::string> peer(const std::string& what, std::vector<std::string> options);

/// The domain of this test program.
unsigned test_domain();

/// Runs a shell command; its exit code.
int shell(const std::string& command);
