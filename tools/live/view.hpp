#pragma once

#include <chrono>
#include <deque>
#include <filesystem>
#include <map>
#include <mutex>

#include "live/server.hpp"
#include "observe/watch.hpp"

namespace bodeflow::tools::live {

/// The live page of one run: what `bodeflow run --live` serves. Its functions may be called on any thread.
class View {
 public:
  /// Port 0: any that is free. Error: why not.
  static tl::expected<std::unique_ptr<View>, std::string> open(int port, const graph::Graph& graph);
  /// Waits shortly (at most kGrace) for a page that looks on to fetch the end, then serves no more.
  ~View();
  View(const View&) = delete;
  View& operator=(const View&) = delete;

  static constexpr std::chrono::milliseconds kGrace{2000};

  /// Where the page is; behind # stands what gives the right to change parameters.
  std::string address() const;
  observe::Watch& watch() { return watch_; }

  void begins(const std::filesystem::path& directory);
  /// A message that people are shown at the end of the list; of `level` BF_LOG_INFO and above.
  void log(const std::string& source, int level, const std::string& text);
  /// `status` as in manifest.json.
  void ends(const std::string& status, const std::string& reason);

 private:
  using Clock = std::chrono::steady_clock;
  struct Message {
    std::string source, text;
    const char* level = "info";
  };
  struct Drawn {
    std::uint64_t version = 0;
    std::string html;
  };

  explicit View(const graph::Graph& graph);
  std::vector<Route> routes();
  Reply page() const;
  Reply state(const Request& request);
  Reply graph_drawing();
  Reply record(const Request& request);
  Reply change(const Request& request);

  std::string title_, clock_;
  std::string token_, nonce_;
  Clock::time_point opened_ = Clock::now();
  observe::Watch watch_;

  std::mutex mutex_;  ///< of what follows
  std::string status_ = "starting", reason_, directory_;
  bool ended_ = false, end_seen_ = false;
  std::optional<Clock::time_point> asked_;  ///< when the state was asked for last
  std::deque<Message> log_;
  std::map<std::string, Drawn> drawn_;

  std::unique_ptr<Server> server_;  ///< last: it ends first
};

}  // namespace bodeflow::tools::live
