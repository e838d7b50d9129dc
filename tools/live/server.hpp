#pragma once

#include <functional>
#include <memory>
#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace bodeflow::tools::live {

/// A request that came from this machine, to this server by its name, of allowed size.
struct Request {
  std::string key;    ///< ?key=...
  std::string token;  ///< X-Bodeflow-Token
  std::string body;   ///< POST: application/json
};

struct Reply {
  int status = 200;
  std::string type = "application/json";
  std::string body;
  std::string script_nonce;  ///< of the one script that the page may run; empty: none
};

/// What is answered to GET or POST of a path. Called on the server's threads.
struct Route {
  const char* method = "GET";
  const char* path = "/";
  std::function<Reply(const Request&)> answer;
};

/// An HTTP server on 127.0.0.1, for people at this machine alone.
///
/// What it costs is bounded, whatever is sent: four threads of low priority, sixteen connections that wait, one request a
/// connection of at most kMostRequest bytes within kMostTime_s; no compressed bodies, no ranges. Requests under another name than
/// localhost (DNS rebinding) and those that a page of another origin sends are refused; so is a change by anything but POST with
/// JSON.
class Server {
 public:
  static constexpr std::size_t kMostRequest = 16 * 1024;
  static constexpr double kMostTime_s = 5.0;

  /// Port 0: any that is free. Error: why the port can't be had.
  static tl::expected<std::unique_ptr<Server>, std::string> open(int port, const std::vector<Route>& routes);
  /// Ends at once: connections that are open are cut.
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  int port() const;

 private:
  Server();
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace bodeflow::tools::live
