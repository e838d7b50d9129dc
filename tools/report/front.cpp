#include "report/front.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "graph/load.hpp"
#include "report/graph_drawing.hpp"
#include "report/json_fields.hpp"

namespace bodeflow::tools::report {
namespace {

using nlohmann::ordered_json;

/// "2026-11-22T04:31:15.298Z" as "2026-11-22 04:31:15 UTC".
std::string moment(const std::string& time) {
  if (time.size() < 20 || time[10] != 'T') return time;
  return time.substr(0, 10) + " " + time.substr(11, 8) + " UTC";
}

std::string title_of(const RunData& run) {
  if (!run.title.empty()) return run.title;
  const std::string graph = text_in(run.manifest, "graph");
  return graph.empty() ? run.directory.filename().string() : graph;
}

std::string status_text(const std::string& status) { return status == "limit" ? "ended by a limit" : status; }

/// The time that the phases took together on their own clocks, and on ours; NaN where not told.
std::pair<double, double> times_of(const RunData& run) {
  double time = kNaN, wall = kNaN;
  const auto phases = run.manifest.find("phases");
  if (phases == run.manifest.end() || !phases->is_array()) return {time, wall};
  for (const auto& phase : *phases) {
    const auto add = [&](const char* key, double& sum) {
      if (phase.is_object() && phase.contains(key) && phase[key].is_number())
        sum = (std::isnan(sum) ? 0.0 : sum) + phase[key].get<double>();
    };
    add("time_s", time);
    add("wall_s", wall);
  }
  return {time, wall};
}

void add_blocks(Page& page, const GivenPhase& phase) {
  Table table{phase.name.empty() ? "Blocks and their given parameters" : fmt::format("Blocks of phase {}", phase.name),
              {{"Block", false}, {"Type", false}, {"Given parameters", false}},
              {}};
  for (const auto& block : phase.blocks) {
    std::string parameters;
    for (const auto& [name, value] : block.parameters)
      parameters += (parameters.empty() ? "" : ", ") + name + ": " + shortened(value, 200);
    table.rows.push_back({block.name, block.id, parameters.empty() ? "defaults" : parameters});
  }
  add_table(page.body(), table);
}

}  // namespace

Markup page_header(const RunData& run) {
  Markup header;
  header.open("header").element("p", {{"class", "over"}}, "bodeflow run report").element("h1", title_of(run));
  const std::string style = run.status == "complete" || run.status == "failed" ? run.status : "partial";
  header.open("p").element("span", {{"class", "badge " + style}}, status_text(run.status)).close("p");
  Facts facts;
  const auto add = [&](const char* name, const std::string& value) {
    if (!value.empty()) facts.emplace_back(name, value);
  };
  add("Graph", text_in(run.manifest, "graph"));
  add("Started", moment(text_in(run.manifest, "started")));
  const auto [time, wall] = times_of(run);
  if (std::isfinite(time)) facts.emplace_back("Duration of the experiment", shown(time, "s"));
  if (std::isfinite(wall)) facts.emplace_back("Computing time", shown(wall, "s", 3));
  facts.emplace_back("Results", counted(run.records.size()));
  add_facts(header, facts);
  return header.close("header").trusted("\n");
}

std::vector<Warning> warnings_of(const RunData& run) {
  std::vector<Warning> warnings;
  if (run.status != "complete") {
    const std::string reason =
        run.reason.empty() ? "The run did not come to its end: results may be missing or partial." : run.reason;
    warnings.push_back({"Run: " + status_text(run.status), reason, true});
  }
  for (const auto& problem : run.problems) warnings.push_back({"This report", problem, true});
  const std::size_t first = warnings.size();
  const auto add = [&](const std::string& source, const std::string& text, bool bad) {
    const auto known = std::find_if(warnings.begin() + static_cast<std::ptrdiff_t>(first), warnings.end(),
                                    [&](const Warning& warning) { return warning.text == text; });
    if (known == warnings.end())
      warnings.push_back({source, text, bad});
    else if (!bad && known->source.find(source) == std::string::npos)
      known->source += ", " + source;
  };
  for (const auto& record : run.records)
    for (const auto& text : record.texts("warnings")) add(record.key, text, false);
  for (const auto& line : run.log) {
    if (line.level != "warning" && line.level != "error") continue;
    const auto colon = line.text.find(": ");
    const std::string source = colon == std::string::npos ? "Log" : line.text.substr(0, colon);
    const std::string text = colon == std::string::npos ? line.text : line.text.substr(colon + 2);
    add(source, text, line.level == "error");
  }
  return warnings;
}

void add_warnings(Page& page, const std::vector<Warning>& warnings) {
  constexpr std::size_t kMost = 100;
  if (warnings.empty()) return;
  page.open_section("Warnings", counted(warnings.size()));
  page.body().open("ul", {{"class", "warnings"}});
  for (std::size_t n = 0; n < std::min(warnings.size(), kMost); ++n)
    page.body()
        .open("li", {{"class", warnings[n].bad ? "bad" : "warn"}})
        .element("b", warnings[n].source)
        .text(warnings[n].text)
        .close("li");
  page.body().close("ul").trusted("\n");
  if (warnings.size() > kMost) page.paragraph(fmt::format("{} more stand in log.txt and result.json.", warnings.size() - kMost));
  page.close_section();
}

void add_what_was_done(Page& page, const RunData& run, const Registry& registry) {
  if (run.phases.empty()) return;
  page.open_section("What was done");
  const auto graph = graph::load_text(run.graph_text, (run.directory / "graph.yaml").string(), {}, registry);
  for (const auto& given : run.phases) {
    if (!given.name.empty()) page.heading("Phase " + given.name);
    Facts settings;
    // What the summary shows is no part of what was done.
    for (const auto& [name, value] : given.settings)
      if (name != "summary") settings.emplace_back(name, shortened(value, 200));
    add_facts(page.body(), settings);
    if (graph)
      for (const auto& phase : graph->phases)
        if (phase.name == given.name)
          if (const auto wide = draw_phase(phase, kWide))
            page.drawing(*wide, *draw_phase(phase, kNarrow), phase.name.empty() ? "graph" : "graph_" + phase.name,
                         "Streams are solid, records dashed");
    add_blocks(page, given);
    if (!graph && !given.connections.empty()) {
      std::string text;
      for (const auto& connection : given.connections) text += connection + "\n";
      page.body().element("pre", text);
    }
  }
  if (!graph) page.paragraph("The graph is not drawn: this machine lacks plugins of the run, or they have changed.");
  page.close_section();
}

}  // namespace bodeflow::tools::report
