#include "graph/run_settings.hpp"

#include <fmt/format.h>

#include <charconv>

#include "graph/keys.hpp"
#include "graph/scalar.hpp"

namespace bodeflow::graph {
namespace {

constexpr std::int64_t kLongestChunk = 1 << 20;
constexpr std::int64_t kMostThreads = 256;
constexpr std::int64_t kHighestPriority = 99;  ///< of SCHED_FIFO
constexpr std::int64_t kMostCores = 1024;      ///< of a cpu_set_t

std::optional<double> read_time(const Node& node, const std::string& where, Report& report) {
  const auto seconds = read_number(node, where, "s", report);
  if (seconds && *seconds <= 0.0) {
    report.add(node.spot, fmt::format("{}: found {}, allowed: a time above 0 s", where, quote(node.text)));
    return {};
  }
  return seconds;
}

Clock clock_named(const std::string& name) {
  return name == "simulated" ? Clock::simulated : name == "realtime" ? Clock::realtime : Clock::hardware;
}

Overrun overrun_named(const std::string& name) {
  return name == "count" ? Overrun::count : name == "skip" ? Overrun::skip : Overrun::stop;
}

std::vector<int> read_cores(const Node& node, Report& report) {
  std::vector<int> cores;
  if (!require_list(node, "run: cores", "a list of cores such as [2, 3]", report)) return cores;
  for (const Node& item : node.items)
    if (const auto core = read_integer(item, "run: cores", 0, kMostCores - 1, report)) cores.push_back(static_cast<int>(*core));
  return cores;
}

void read_real_time(const Node& node, RunSettings& run, Report& report) {
  if (const Node* n = node.find("on_overrun"))
    if (const auto name = read_choice(*n, "run: on_overrun", overruns(), report)) run.on_overrun = overrun_named(*name);
  if (const Node* n = node.find("priority"))
    if (const auto priority = read_integer(*n, "run: priority", 1, kHighestPriority, report))
      run.priority = static_cast<int>(*priority);
  if (const Node* n = node.find("cores")) run.cores = read_cores(*n, report);
}

}  // namespace

std::optional<std::uint64_t> read_seed(const Node& node, const std::string& where, Report& report) {
  const auto text = read_text(node, where, report);
  if (!text) return {};
  std::uint64_t seed = 0;
  const auto [end, error] = std::from_chars(text->data(), text->data() + text->size(), seed);
  const bool octal = text->size() > 1 && text->front() == '0';
  if (error == std::errc() && end == text->data() + text->size() && !octal) return seed;
  report.add(node.spot, fmt::format("{}: found {}, allowed: a whole number from 0 to 18446744073709551615", where, quote(*text)));
  return {};
}

void read_run(const Node& node, RunSettings& run, Report& report) {
  if (node.is_none() || !require_map(node, "run", "a map such as {duration: 2 s}", report)) return;
  check_keys(node, "run: ", run_keys(), report);
  if (const Node* n = node.find("clock"))
    if (const auto name = read_choice(*n, "run: clock", clocks(), report)) run.clock = clock_named(*name);
  if (const Node* n = node.find("duration"))
    if (const auto t = read_time(*n, "run: duration", report)) run.duration_s = *t;
  if (const Node* n = node.find("seed"))
    if (const auto seed = read_seed(*n, "run: seed", report)) run.seed = *seed;
  if (const Node* n = node.find("chunk"))
    if (const auto chunk = read_integer(*n, "run: chunk", 1, kLongestChunk, report)) run.chunk = *chunk;
  if (const Node* n = node.find("latency"))
    if (const auto t = read_time(*n, "run: latency", report)) run.latency_s = *t;
  if (const Node* n = node.find("threads"))
    if (const auto threads = read_integer(*n, "run: threads", 1, kMostThreads, report)) run.threads = static_cast<int>(*threads);
  read_real_time(node, run, report);
  if (const Node* n = node.find("watchdog"))
    if (const auto t = read_time(*n, "run: watchdog", report)) run.watchdog_s = *t;
  if (const Node* n = node.find("tolerance"))
    if (const auto t = read_time(*n, "run: tolerance", report)) run.tolerance_s = *t;
  if (const Node* n = node.find("launcher_lost"))
    if (const auto name = read_choice(*n, "run: launcher_lost", {"stop", "continue"}, report))
      run.survives_launcher = *name == "continue";
  if (const Node* n = node.find("restart"))
    if (const auto name = read_choice(*n, "run: restart", {"true", "false"}, report)) run.restart = *name == "true";
  if (const Node* n = node.find("gaps"))
    if (const auto name = read_choice(*n, "run: gaps", {"nan", "hold"}, report))
      run.gaps = *name == "hold" ? Gaps::hold : Gaps::nan;
}

}  // namespace bodeflow::graph
