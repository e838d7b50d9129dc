#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <map>
#include <thread>

#include "commands/interrupt.hpp"
#include "commands/lab_options.hpp"
#include "console/json_output.hpp"
#include "record/pacing.hpp"

namespace bodeflow::tools {
namespace {

using nlohmann::json;

struct TopCommand {
  LabOptions lab;
  bool json = false;
  bool once = false;
  double every_s = 1.0;
};

std::string host_name(const json& name) {
  const std::string text = name.is_string() ? name.get<std::string>() : "";
  return text.empty() ? "launcher" : text;
}

/// Messages and bytes of a link at the last look, for its rates.
struct Before {
  double messages = 0.0, bytes = 0.0;
};

class Screen {
 public:
  /// Takes a look for the rates of the next one.
  void note(const std::vector<json>& runs) {
    std::map<std::string, Before> seen;
    for (const json& run : runs)
      for (const json& host : run.value("hosts", json::array()))
        for (const json& link : host.value("links", json::array()))
          seen[key(run, host, link)] = {link.value("messages", 0.0), link.value("bytes", 0.0)};
    before_ = std::move(seen);
  }

  void print(const std::vector<json>& runs, double elapsed_s) const {
    if (isatty(STDOUT_FILENO) == 1) fmt::print("\033[H\033[J");
    if (runs.empty()) fmt::print("No graph runs over hosts in this lab.\n");
    for (const json& run : runs) print_run(run, elapsed_s);
    std::fflush(stdout);
  }

 private:
  static std::string key(const json& run, const json& host, const json& link) {
    return run.value("run", "") + "/" + host.value("host", "") + "/" + title(link);
  }

  static std::string title(const json& link) {
    return fmt::format("{} {}: {}", link.value("sends", false) ? "to" : "from", host_name(link.value("other", json())),
                       link.value("connection", ""));
  }

  void print_run(const json& run, double elapsed_s) const {
    const std::string phase = run.value("phase", "");
    fmt::print("{}{}, run {}\n", bold(run.value("graph", "")), phase.empty() ? "" : ", phase " + phase, run.value("run", ""));
    std::size_t width = std::string_view("connection").size();
    for (const json& host : run.value("hosts", json::array()))
      for (const json& link : host.value("links", json::array())) width = std::max(width, title(link).size());
    fmt::print("    {:<{}} {:>7} {:>9} {:>8} {:>8} {:>8} {:>4} {:>7} {:>8}\n", "connection", width, "msg/s", "kB/s", "queue kB",
               "p50 ms", "p99 ms", "gaps", "reconn.", "waited s");
    for (const json& host : run.value("hosts", json::array())) {
      const double silent = host.value("silent_s", 0.0);
      fmt::print("  {} at {:.2f} s, {:.3g} times real time{}\n", bold(host_name(host.value("host", json()))),
                 host.value("time_s", 0.0), host.value("rate", 0.0),
                 silent > 0.7 ? fmt::format(", nothing heard of it for {:.1f} s", silent) : std::string());
      if (const std::string kept = record::pacing_text(host.value("pacing", json())); !kept.empty()) fmt::print("    {}\n", kept);
      for (const json& link : host.value("links", json::array())) print_link(key(run, host, link), link, width, elapsed_s);
    }
  }

  /// Rates need an earlier look, latency is measured where messages arrive: a dash where there is none.
  void print_link(const std::string& own, const json& link, std::size_t width, double elapsed_s) const {
    const auto before = before_.find(own);
    const auto rate = [&](const char* name, double Before::*last, double scale, int digits) {
      if (before == before_.end()) return std::string("-");
      return fmt::format("{:.{}f}", std::max(0.0, link.value(name, 0.0) - before->second.*last) / elapsed_s * scale, digits);
    };
    const auto latency = [&](const char* name) {
      return link.value("sends", false) ? std::string("-") : fmt::format("{:.3f}", link.value(name, 0.0) * 1e3);
    };
    const double still = link.value("stalled_s", 0.0);
    fmt::print("    {:<{}} {:>7} {:>9} {:>8.1f} {:>8} {:>8} {:>4} {:>7} {:>8.2f}{}\n", title(link), width,
               rate("messages", &Before::messages, 1.0, 0), rate("bytes", &Before::bytes, 1e-3, 1),
               link.value("queued_bytes", 0.0) * 1e-3, latency("latency_p50_s"), latency("latency_p99_s"), link.value("gaps", 0),
               link.value("reconnects", 0), link.value("waited_s", 0.0),
               still > 0.7 ? fmt::format(" stands still for {:.1f} s", still) : std::string());
  }

  std::map<std::string, Before> before_;
};

std::vector<json> look(transport::Board& board) {
  std::vector<json> runs;
  for (const std::string& text : board.texts())
    if (json run = json::parse(text, nullptr, false); run.is_object()) runs.push_back(std::move(run));
  return runs;
}

int top(const TopCommand& command) {
  const auto participant = command.lab.join();
  if (!participant) return participant.error();
  auto board = transport::open_board(*participant, lab::kRunsBoard, false);
  if (!board) {
    say_error(board.error().text);
    return kDevice;
  }
  const std::atomic<bool>& stop = stop_on_interrupt();
  Screen screen;
  const auto wait = [&] {
    for (double slept = 0.0; slept < command.every_s && !stop; slept += 0.1)
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
  };
  wait();
  if (!command.json) {  // rates need two looks
    screen.note(look(**board));
    wait();
  }
  while (!stop) {
    const std::vector<json> runs = look(**board);
    if (command.json)
      print_json(nlohmann::ordered_json(runs));
    else
      screen.print(runs, command.every_s);
    screen.note(runs);
    if (command.once) break;
    wait();
  }
  return kDone;
}

}  // namespace

void add_top(CLI::App& app, Session& session) {
  auto* command =
      app.add_subcommand("top", "Show the runs of the lab: every host and connection, with rates, queues, latency, gaps");
  auto options = std::make_shared<TopCommand>();
  command->add_flag("--json", options->json, "As JSON");
  command->add_flag("--once", options->once, "Look once");
  command->add_option("--every", options->every_s, "Seconds between looks")->check(CLI::Range(0.2, 60.0));
  options->lab.add_to(*command);
  command->callback([&session, options] { session.action = [options] { return top(*options); }; });
}

}  // namespace bodeflow::tools
