#include <fmt/format.h>

#include "report/front.hpp"
#include "report/json_fields.hpp"

namespace bodeflow::tools::report {
namespace {

using nlohmann::ordered_json;

const ordered_json& list_in(const ordered_json& json, const char* key) {
  static const ordered_json kNone = ordered_json::array();
  const auto found = json.find(key);
  return found != json.end() && found->is_array() ? *found : kNone;
}

/// The seed that the graph names; the engine's own otherwise.
std::string seed_of(const RunData& run) {
  std::string seeds;
  for (const auto& phase : run.phases)
    for (const auto& [name, value] : phase.settings) {
      if (name != "seed") continue;
      seeds += (seeds.empty() ? "" : ", ") + (phase.name.empty() ? value : phase.name + ": " + value);
    }
  return seeds.empty() ? "1 (not given)" : seeds;
}

std::string host_of(const ordered_json& manifest) {
  const auto host = manifest.find("host");
  if (host == manifest.end() || !host->is_object()) return text_in(manifest, "host");
  return fmt::format("{}, {} {}", text_in(*host, "name"), text_in(*host, "system"), text_in(*host, "machine"));
}

/// In single quotes for a shell where it needs them.
std::string shell_word(const std::string& text) {
  const bool plain =
      !text.empty() &&
      text.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./+-") == std::string::npos;
  if (plain) return text;
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? "'\\''" : std::string(1, c);
  return quoted + "'";
}

void add_plugins(Page& page, const ordered_json& manifest) {
  Table table{"Plugins", {{"Plugin", false}, {"Version", false}, {"Build", false}, {"SHA-256", false}}, {}};
  for (const auto& plugin : list_in(manifest, "plugins"))
    table.rows.push_back(
        {text_in(plugin, "name"), text_in(plugin, "version"), text_in(plugin, "build"), text_in(plugin, "sha256")});
  add_table(page.body(), table);
}

void add_inputs(Page& page, const ordered_json& manifest) {
  Table table{"Input files", {{"File", false}, {"Blocks", false}, {"Bytes"}, {"SHA-256", false}}, {}};
  for (const auto& input : list_in(manifest, "inputs")) {
    if (!input.is_object()) continue;
    std::string blocks;
    for (const auto& block : list_in(input, "blocks"))
      if (block.is_string()) blocks += (blocks.empty() ? "" : ", ") + block.get<std::string>();
    const auto size = input.find("size");
    const std::string hash = text_in(input, "sha256");
    table.rows.push_back({text_in(input, "path"), blocks,
                          size != input.end() && size->is_number_unsigned() ? counted(size->get<std::uint64_t>()) : "–",
                          hash.empty() ? text_in(input, "error") : hash});
  }
  add_table(page.body(), table);
}

/// Everything of an event but its time and name, as "key: value, ...".
std::string details_of(const ordered_json& event) {
  std::string details;
  for (const auto& [key, value] : event.items()) {
    if (key == "time" || key == "event" || (value.is_string() && value.get_ref<const std::string&>().empty())) continue;
    const std::string text = value.is_string()         ? value.get<std::string>()
                             : value.is_number_float() ? shown(value.get<double>())
                                                       : value.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
    details += (details.empty() ? "" : ", ") + key + ": " + shortened(text, 200);
  }
  return details;
}

void add_events(Page& page, const RunData& run) {
  constexpr std::size_t kMost = 500;
  Table table{"Events", {{"Time", false}, {"Event", false}, {"Details", false}}, {}};
  for (std::size_t n = 0; n < std::min(run.events.size(), kMost); ++n)
    table.rows.push_back({text_in(run.events[n], "time"), text_in(run.events[n], "event"), details_of(run.events[n])});
  if (table.rows.empty()) return;
  open_details(page.body(), fmt::format("Events ({})", run.events.size()));
  add_table(page.body(), table);
  close_details(page.body());
}

void add_log(Page& page, const RunData& run) {
  constexpr std::size_t kMost = 500;
  if (run.log.empty()) return;
  std::string text;
  for (std::size_t n = 0; n < std::min(run.log.size(), kMost); ++n)
    text += fmt::format("{} {} {}\n", run.log[n].time, run.log[n].level, shortened(run.log[n].text, 500));
  const std::size_t more = run.log.size() - std::min(run.log.size(), kMost) + run.log_lines_left_out;
  if (more > 0) text += fmt::format("… {} more lines in log.txt\n", more);
  open_details(page.body(), fmt::format("Log ({})", run.log.size() + run.log_lines_left_out));
  page.body().element("pre", text);
  close_details(page.body());
}

}  // namespace

void add_provenance(Page& page, const RunData& run) {
  const ordered_json& manifest = run.manifest;
  page.open_section("Provenance");
  Table table{"Run", {{"", false}, {"", false}}, {}};
  const auto add = [&](const char* name, const std::string& value) {
    if (!value.empty()) table.rows.push_back({name, value});
  };
  add("bodeflow", text_in(manifest, "bodeflow"));
  add("ABI", text_in(manifest, "abi"));
  add("Seed", seed_of(run));
  add("Vector level", text_in(manifest, "vector_level"));
  add("Host", host_of(manifest));
  add("Started", text_in(manifest, "started"));
  add("Ended", text_in(manifest, "ended"));
  add("Graph file", text_in(manifest, "graph_file"));
  add_table(page.body(), table);
  add_plugins(page, manifest);
  add_inputs(page, manifest);
  page.paragraph("To repeat the run and compare every output bit for bit:");
  page.body().element("pre",
                      "bodeflow rerun " + shell_word(std::filesystem::absolute(run.directory).lexically_normal().string()));
  if (!run.graph_text.empty()) {
    open_details(page.body(), "Graph as expanded (graph.yaml)");
    page.body().element("pre", shortened(run.graph_text, 100'000));
    close_details(page.body());
  }
  add_events(page, run);
  add_log(page, run);
  page.close_section();
}

}  // namespace bodeflow::tools::report
