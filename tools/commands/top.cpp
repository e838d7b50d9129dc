#include <fmt/format.h>
#include <unistd.h>

#include <thread>

#include "commands/interrupt.hpp"
#include "commands/lab_options.hpp"
#include "console/json_output.hpp"

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
  void print(const std::vector<json>& runs, double elapsed_s) {
    if (isatty(STDOUT_FILENO) == 1) fmt::print("\033[H\033[J");
    if (runs.empty()) fmt::print("No graph runs over hosts in this lab.\n");
    for (const json& run : runs) print_run(run, elapsed_s);
    std::fflush(stdout);
  }

 private:
  void print_run(const json& run, double elapsed_s) {
    fmt::print("{}  {}  run {}\n", bold(run.value("graph", "")), run.value("phase", ""), run.value("run", ""));
    fmt::print("  {:<12} {:<40} {:>9} {:>9} {:>9} {:>9} {:>9} {:>5} {:>7} {:>9} {}\n", "host", "connection", "msg/s", "MB/s",
               "queue kB", "p50 ms", "p99 ms", "gaps", "reconn.", "waited s", "");
    for (const json& host : run.value("hosts", json::array())) {
      fmt::print("  {:<12} at {:.3f} s, {:.3g} s a second\n", host_name(host.value("host", json())), host.value("time_s", 0.0),
                 host.value("rate", 0.0));
      for (const json& link : host.value("links", json::array()))
        print_link(run.value("run", "") + host_name(host.value("host", json())), link, elapsed_s);
    }
  }

  void print_link(const std::string& owner, const json& link, double elapsed_s) {
    const bool sends = link.value("sends", false);
    const std::string name = link.value("connection", "");
    Before& before = before_[owner + name];
    const double messages = link.value("messages", 0.0), bytes = link.value("bytes", 0.0), still = link.value("stalled_s", 0.0);
    fmt::print("  {:<12} {:<40} {:>9.0f} {:>9.2f} {:>9.1f} {:>9.3f} {:>9.3f} {:>5} {:>7} {:>9.2f} {}\n", "",
               fmt::format("{} {} {}", sends ? "to" : "from", host_name(link.value("other", json())), name),
               (messages - before.messages) / elapsed_s, (bytes - before.bytes) / elapsed_s * 1e-6,
               link.value("queued_bytes", 0.0) * 1e-3, link.value("latency_p50_s", 0.0) * 1e3,
               link.value("latency_p99_s", 0.0) * 1e3, link.value("gaps", 0), link.value("reconnects", 0),
               link.value("waited_s", 0.0), still > 0.7 ? fmt::format("stands still for {:.1f} s", still) : std::string());
    before = {messages, bytes};
  }

  std::map<std::string, Before> before_;
};

int top(const TopCommand& command) {
  const auto settings = command.lab.settings("");
  if (!settings) {
    say_error(settings.error());
    return kUsage;
  }
  const auto participant = transport::join(*settings);
  if (!participant) {
    say_error(participant.error());
    return kDevice;
  }
  auto board = transport::open_board(*participant, lab::kRunsBoard, false);
  if (!board) {
    say_error(board.error().text);
    return kDevice;
  }
  const std::atomic<bool>& stop = stop_on_interrupt();
  Screen screen;
  do {
    for (double slept = 0.0; slept < command.every_s && !stop; slept += 0.1)
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    std::vector<json> runs;
    for (const std::string& text : (*board)->texts())
      if (json run = json::parse(text, nullptr, false); run.is_object()) runs.push_back(std::move(run));
    if (command.json)
      print_json(nlohmann::ordered_json(runs));
    else
      screen.print(runs, command.every_s);
  } while (!command.once && !stop);
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
