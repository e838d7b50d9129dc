#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "system/command.hpp"
#include "transport/processes.hpp"

namespace bodeflow::test {

/// An answer of the page's server.
struct Answer {
  int status = 0;  ///< 0: none came
  std::string body;

  nlohmann::json json() const { return nlohmann::json::parse(body, nullptr, false); }
};

/// `bodeflow run GRAPH --live` in a process of its own, and what a browser would ask it.
class LiveRun {
 public:
  /// Returns when the address is printed.
  LiveRun(const Folder& folder, const std::string& graph, const std::string& out, const std::vector<std::string>& more = {});

  int port() const { return port_; }
  const std::string& address() const { return address_; }
  const std::string& token() const { return token_; }
  Process& process() { return process_; }

  Answer get(const std::string& path) const;
  nlohmann::json state() const { return get("/state").json(); }
  /// The state, as soon as it is so; null: not within twenty seconds.
  template <class Condition>
  nlohmann::json state_when(Condition condition) const {
    for (int i = 0; i < 400; ++i) {
      const auto now = state();
      if (now.is_object() && condition(now)) return now;
      pause();
    }
    return nullptr;
  }
  /// Asks for a change in the phase that runs.
  Answer change(const std::string& block, const std::string& parameter, const std::string& value) const;
  /// What comes back for these bytes on a connection of their own; "" where it is closed without an answer.
  std::string raw(const std::string& bytes) const;
  /// An open connection on which these bytes were sent; -1: none.
  int hold(const std::string& bytes) const;
  /// A well-formed request with other headers than a browser of ours sends.
  Answer request(const std::string& method, const std::string& path, const std::vector<std::string>& headers,
                 const std::string& body = "") const;

 private:
  static void pause();

  Process process_;
  int port_ = 0;
  std::string address_, token_;
};

}  // namespace bodeflow::test
