#include "commands/response_change.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "commands/data_source.hpp"

namespace bodeflow::tools {
namespace {

namespace fs = std::filesystem;

bool is_run(const std::string& path) {
  std::error_code error;
  return fs::is_directory(path, error) || fs::path(path).extension() == ".json";
}

/// A run whose results have a response (of that name), and no model where no name is given. What else is wrong with the file is
/// for the block that reads it.
bool run_holds_response(const std::string& path, const std::string& name) {
  std::error_code error;
  std::ifstream file(fs::is_directory(path, error) ? fs::path(path) / "result.json" : fs::path(path));
  const auto result = nlohmann::json::parse(file, nullptr, false);
  if (!result.is_object() || !result.contains("results") || !result["results"].is_object()) return false;
  bool response = false, model = false;
  for (const auto& [key, record] : result["results"].items()) {
    if (!record.is_object() || !record.contains("type")) continue;
    if (record["type"] == "frequency_response" && (name.empty() || key == name)) response = true;
    if (record["type"] == "model") model = true;
  }
  return response && (!model || !name.empty());
}

std::string source_block(const std::string& path, const std::string& name) {
  if (!is_run(path)) return data_block(DataOptions{path, {}, {}, ""}, DataKind::frequency_response);
  return fmt::format("{{block: acquisition.result, type: frequency_response, file: {}{}}}",
                     yaml_text(fs::absolute(path).lexically_normal().string()), name.empty() ? "" : ", name: " + yaml_text(name));
}

std::string short_name(const std::string& given) {
  fs::path path = fs::absolute(given).lexically_normal();
  if (!path.has_filename() || path.filename() == "result.json") path = path.parent_path();
  return path.filename().string();
}

}  // namespace

tl::expected<bool, std::string> is_response(const std::string& path, const std::string& name, Registry& registry) {
  if (is_run(path)) return run_holds_response(path, name);
  const auto kind = data_kind(DataOptions{path, {}, {}, ""}, registry);
  if (kind && *kind == DataKind::frequency_response) return true;
  return tl::unexpected(path + ": neither a frequency response nor a run; samples over time go to --data" +
                        (kind ? "" : "\n" + kind.error()));
}

std::string response_change_graph(const std::string& before, const std::string& after, const ResponseChangeOptions& options) {
  std::string blocks =
      fmt::format("  before: {}\n  after: {}\n", source_block(before, options.name), source_block(after, options.name));
  std::string connections = "  - before -> compare.before\n  - after -> compare.after\n";
  for (std::size_t i = 0; i < options.repeats.size(); ++i) {
    blocks += fmt::format("  repeat_{}: {}\n", i + 1, source_block(options.repeats[i], options.name));
    connections += fmt::format("  - repeat_{} -> compare.repeat\n", i + 1);
  }
  const std::string scatter = options.scatter.empty() ? "" : ", scatter: {relative: " + yaml_text(options.scatter) + "}";
  blocks += fmt::format("  compare: {{block: validation.change{}}}\n", scatter);
  return fmt::format(
      "bodeflow: 1\ntitle: {}\nsummary: {{show: [compare]}}\nrun: {{clock: simulated}}\nblocks:\n{}connections:\n{}",
      yaml_text(fmt::format("What has changed from {} to {}", short_name(before), short_name(after))), blocks, connections);
}

}  // namespace bodeflow::tools
