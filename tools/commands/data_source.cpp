#include "commands/data_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "commands/one_off.hpp"
#include "graph/load.hpp"
#include "phases/run.hpp"
#include "phases/services.hpp"

namespace bodeflow::tools {
namespace {

std::string ending_of(const std::string& file) {
  std::string ending = std::filesystem::path(file).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

bool is_one_of(const std::string& word, std::initializer_list<const char*> words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// Touchstone: .s1p to .s99p.
bool is_touchstone(const std::string& ending) {
  return ending.size() >= 4 && ending.size() <= 5 && ending.compare(0, 2, ".s") == 0 && ending.back() == 'p' &&
         std::all_of(ending.begin() + 2, ending.end() - 1, [](char c) { return c >= '0' && c <= '9'; });
}

/// What a source block says of a file when it is set up: nothing where it takes it.
struct Probe {
  std::string refusal;
  std::string found;        ///< what it logged
  double duration_s = 0.0;  ///< of its longest stream
};

Probe probe(const std::string& block, Registry& registry) {
  Probe probe;
  const auto graph = graph::load_text("bodeflow: 1\nblocks:\n  data: " + block + "\n", "data", {}, registry);
  if (!graph) return {graph.error().front().text, ""};
  phases::Services services([&](const std::string&, int level, const std::string& text) {
    if (level == BF_LOG_INFO) probe.found = text;
  });
  const auto prepared = phases::prepare(graph->phases.front(), registry, services.host(), {});
  if (!prepared) {
    probe.refusal = without_block(prepared.error().front().text, "data");
    return probe;
  }
  for (const StreamFacts& facts : prepared->facts.blocks.front().outputs)
    if (facts.rate.known()) probe.duration_s = std::max(probe.duration_s, static_cast<double>(facts.length) / facts.rate.hz());
  return probe;
}

/// Of samples; a missing rate is refused in words of the command line.
Probe probe_samples(const DataOptions& options, Registry& registry) {
  Probe found = probe(data_block(options, DataKind::time_series), registry);
  if (found.refusal.empty() || !options.rate.empty()) return found;
  DataOptions with_rate = options;
  with_rate.rate = "1 Hz";
  if (probe(data_block(with_rate, DataKind::time_series), registry).refusal.empty())
    found.refusal = options.file +
                    ": no sampling rate and no time column (`t` or `time` with a unit of time, such as `t [s]`); give the "
                    "samples per second: --rate 2500Hz";
  return found;
}

}  // namespace

std::string yaml_text(const std::string& text) {
  std::string safe = nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  for (std::size_t at = 0; (at = safe.find("${", at)) != std::string::npos; at += 3) safe.insert(at, "$");
  return safe;
}

std::string yaml_text(const std::vector<std::string>& texts) {
  std::string list;
  for (const auto& text : texts) list += (list.empty() ? "" : ", ") + yaml_text(text);
  return "[" + list + "]";
}

std::string data_block(const DataOptions& options, DataKind kind) {
  const std::string file = yaml_text(std::filesystem::absolute(options.file).lexically_normal().string());
  if (kind == DataKind::frequency_response) return fmt::format("{{block: acquisition.frequency_response, file: {}}}", file);
  std::string text = fmt::format("{{block: acquisition.file, file: {}", file);
  if (!options.inputs.empty())
    text += fmt::format(", input: {}, output: {}", yaml_text(options.inputs), yaml_text(options.outputs));
  if (!options.rate.empty()) text += fmt::format(", rate: {}", yaml_text(options.rate));
  return text + "}";
}

tl::expected<double, std::string> duration_of(const DataOptions& options, Registry& registry) {
  const Probe found = probe_samples(options, registry);
  if (!found.refusal.empty()) return tl::unexpected(found.refusal);
  return found.duration_s;
}

void add_columns_to(CLI::App& command, DataOptions& options) {
  const auto add = [&](const char* name, std::vector<std::string>& columns, const char* what) {
    command.add_option(name, columns, what)->type_name("NAME")->allow_extra_args(false);
  };
  add("--input", options.inputs, "Column that excites the plant");
  add("--output", options.outputs, "Column that the plant answers with");
}

tl::expected<DataKind, std::string> data_kind(const DataOptions& options, Registry& registry) {
  std::error_code error;
  if (!std::filesystem::exists(options.file, error)) return tl::unexpected(options.file + ": no such file");
  const std::string ending = ending_of(options.file);
  if (is_one_of(ending, {".frd", ".zma", ".u58"}) || is_touchstone(ending)) return DataKind::frequency_response;
  std::string refusal;
  if (is_one_of(ending, {".csv", ".txt", ".tsv", ".dat", ".uff", ".unv"})) {
    refusal = probe(data_block(options, DataKind::frequency_response), registry).refusal;
    if (refusal.empty()) return DataKind::frequency_response;
  }
  if (!options.inputs.empty() && !options.outputs.empty()) return DataKind::time_series;
  const DataOptions all{options.file, {}, {}, options.rate};
  const Probe samples = probe_samples(all, registry);
  if (samples.refusal.empty())
    return tl::unexpected(fmt::format("{} is missing: which column is the {}? {}",
                                      options.inputs.empty() ? "--input" : "--output",
                                      options.inputs.empty() ? "input" : "output", samples.found));
  std::string text = samples.refusal;
  if (!refusal.empty()) text += "\nas a frequency response: " + refusal;
  return tl::unexpected(text);
}

}  // namespace bodeflow::tools
