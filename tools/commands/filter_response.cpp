#include "commands/filter_response.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <bodeflow/units.hpp>
#include <cmath>
#include <complex>
#include <cstdlib>
#include <numbers>

#include "commands/run_graph.hpp"
#include "commands/vector_level.hpp"
#include "console/json_output.hpp"

namespace bodeflow::tools {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t kRows = 24;         // of the table of frequencies
constexpr std::size_t kMostFilters = 8;   // of a bank that are printed
constexpr std::size_t kFewFilters = 3;    // whose phases are printed too
constexpr std::size_t kMostSamples = 16;  // of the impulse response

/// A folder that is gone with its content when the object is.
class Scratch {
 public:
  Scratch() : path_(fs::temp_directory_path() / fmt::format("bodeflow-describe-{}", getpid())) {}
  ~Scratch() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

bool tells_its_response(const BlockDescription& block) {
  return std::any_of(block.ports.begin(), block.ports.end(), [](const auto& port) {
    return port.kind == BF_MESSAGE && port.direction == BF_OUT && port.record_type == "filter";
  });
}

/// Why the settings can't be; empty: they can.
std::string overrides_of(const BlockDescription& block, const std::vector<std::string>& sets,
                         std::vector<std::pair<std::string, std::string>>& overrides) {
  for (const std::string& text : sets) {
    const auto equal = text.find('=');
    if (equal == std::string::npos || equal == 0) return fmt::format("--set '{}': expected PARAM=VALUE, such as order=4", text);
    const std::string name = text.substr(0, equal);
    if (block.parameter(name) < 0) return fmt::format("--set {}: {} has no parameter '{}'", name, block.id, name);
    overrides.emplace_back("blocks.filter." + name, text.substr(equal + 1));
  }
  return "";
}

/// Input samples until the block fires: a decimator takes `factor` of them.
double samples_of_a_firing(const std::vector<std::pair<std::string, std::string>>& overrides) {
  double samples = 1.0;
  for (const auto& [name, value] : overrides) {
    if (name == "blocks.filter.factor") samples = std::max(1.0, std::atof(value.c_str()));
  }
  return samples;
}

std::string graph_text(const BlockDescription& block, double rate_hz, double samples) {
  return fmt::format(
      "bodeflow: 1\ntitle: {}\nrun: {{clock: simulated, duration: {} s}}\nblocks:\n"
      "  source: {{block: generators.step, sample_rate: {} Hz}}\n  filter: {{block: {}}}\nconnections:\n  - source -> filter\n",
      block.id, samples / rate_hz, rate_hz, block.id);
}

std::complex<double> complex_at(const Json& data, std::size_t i) {
  const auto number = [](const Json& value) { return value.is_number() ? value.get<double>() : std::nan(""); };
  return {number(data[i][0]), number(data[i][1])};
}

void print_frequencies(const Json& record, const std::vector<std::string>& names, std::size_t shown) {
  const Json &f = record["arrays"]["frequency"]["data"], &h = record["arrays"]["response"]["data"];
  fmt::print("\n{}\n  {:>12}", bold("Frequency response"), "f [Hz]");
  for (std::size_t i = 0; i < shown; ++i) {
    fmt::print("  {:>14}", shown == 1 ? "[dB]" : names[i]);
    if (shown <= kFewFilters) fmt::print(" {:>9}", "[deg]");
  }
  fmt::print("\n");
  const double first = f.front().get<double>(), last = f.back().get<double>();
  double next = first;
  for (std::size_t k = 0; k < f.size(); ++k) {
    const double hz = f[k].get<double>();
    if (hz < next * (1 - 1e-9) && k + 1 < f.size()) continue;
    next *= std::pow(last / first, 1.0 / (kRows - 1));
    fmt::print("  {:>12.6g}", hz);
    for (std::size_t i = 0; i < shown; ++i) {
      const auto value = complex_at(h, k * names.size() + i);
      fmt::print("  {:>14.3f}", 20 * std::log10(std::abs(value)));
      if (shown <= kFewFilters) fmt::print(" {:>9.2f}", std::arg(value) * 180 / std::numbers::pi);
    }
    fmt::print("\n");
  }
}

void print_impulse(const Json& record, const std::vector<std::string>& names, std::size_t shown) {
  const Json& h = record["arrays"]["impulse"]["data"];
  const std::size_t samples = h.size() / names.size();
  fmt::print("\n{}\n", bold(fmt::format("Impulse response, first {} of {} samples", std::min(samples, kMostSamples), samples)));
  for (std::size_t i = 0; i < shown; ++i) {
    fmt::print("  {}", shown == 1 ? "" : names[i] + ": ");
    for (std::size_t n = 0; n < std::min(samples, kMostSamples); ++n)
      fmt::print(" {:.6g}", h[n * names.size() + i].get<double>());
    fmt::print("\n");
  }
}

void print_record(const Json& record, const std::string& rate) {
  const auto names = record["attributes"]["names"].get<std::vector<std::string>>();
  const std::size_t shown = std::min(names.size(), kMostFilters);
  fmt::print("\n{}, at {}\n", record["attributes"]["kind"].get<std::string>(), rate);
  print_frequencies(record, names, shown);
  print_impulse(record, names, shown);
  if (shown < names.size()) fmt::print("  {} more filters: --json has all\n", names.size() - shown);
}

int refuse(const std::string& text, int code) {
  say_error(text);
  return code;
}

}  // namespace

int print_filter_response(const Session& session, Registry& registry, const BlockDescription& block,
                          const ConfiguredBlock& configured) {
  if (!tells_its_response(block))
    return refuse(
        fmt::format("--set and --rate: {} is no block that tells its response (one that sends the record 'filter')", block.id),
        kUsage);
  if (configured.rate.empty()) return refuse("--rate is missing: the sample rate of the input, such as --rate '10 kHz'", kUsage);
  const auto rate = convert(configured.rate, "Hz");
  if (!rate || !(*rate > 0))
    return refuse(fmt::format("--rate '{}': expected a frequency above 0, such as '10 kHz'", configured.rate), kUsage);
  graph::LoadOptions load;
  if (const std::string wrong = overrides_of(block, configured.sets, load.overrides); !wrong.empty())
    return refuse(wrong, kUsage);
  const auto graph =
      graph::load_text(graph_text(block, *rate, samples_of_a_firing(load.overrides)), "describe.yaml", load, registry);
  if (!graph) {
    for (const auto& problem : graph.error()) say_error(problem.text);
    return kRejected;
  }
  const Scratch scratch;
  RunGraph options;
  options.out = scratch.path();
  options.graph_name = "describe";
  options.vector_level = processor_vector_level();
  options.command = {{"threads", 0}, {"chunk", 0}};
  options.executable = session.executable;
  options.plugin_path = session.plugin_path;
  options.own_graph = true;
  const RanGraph ran = run_graph(*graph, registry, options);
  if (ran.exit_code != kDone) return ran.exit_code;
  const Json record = ran.result["results"].value("filter", Json());
  if (record.is_null()) return refuse(fmt::format("{} filters nothing with these settings", block.id), kUsage);
  configured.json ? print_json(record) : print_record(record, configured.rate);
  return kDone;
}

}  // namespace bodeflow::tools
