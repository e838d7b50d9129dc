#include "report/missing_section.hpp"

#include <fmt/format.h>

#include <set>

#include "report/numbers.hpp"

namespace bodeflow::tools::report {
namespace {

using nlohmann::ordered_json;

std::string text(const ordered_json& entry, const char* key) {
  const auto found = entry.find(key);
  return found != entry.end() && found->is_string() ? found->get<std::string>() : "";
}

std::uint64_t count(const ordered_json& entry, const char* key) {
  const auto found = entry.find(key);
  return found != entry.end() && found->is_number_unsigned() ? found->get<std::uint64_t>() : 0;
}

double number(const ordered_json& entry, const char* key) {
  const auto found = entry.find(key);
  return found != entry.end() && found->is_number() ? found->get<double>() : kNaN;
}

std::vector<ordered_json> objects(const ordered_json& manifest, const char* key) {
  std::vector<ordered_json> all;
  const auto list = manifest.find(key);
  if (list == manifest.end() || !list->is_array()) return all;
  for (const auto& entry : *list)
    if (entry.is_object()) all.push_back(entry);
  return all;
}

std::string host_of(const ordered_json& entry) {
  const std::string host = text(entry, "host");
  return host.empty() ? "launcher" : host;
}

Table table_of(const std::vector<ordered_json>& gaps) {
  Table table{"Missing samples, counted from 0 in the stream",
              {{"Connection", false}, {"Missing at", false}, {"First"}, {"Last"}, {"Samples"}, {"From [s]"}, {"To [s]"}},
              {}};
  for (const ordered_json& gap : gaps) {
    const std::uint64_t first = count(gap, "first"), samples = count(gap, "count");
    if (samples == 0) continue;
    table.rows.push_back({text(gap, "connection"), host_of(gap), counted(first), counted(first + samples - 1), counted(samples),
                          shown(number(gap, "from_s"), 9), shown(number(gap, "to_s"), 9)});
  }
  return table;
}

}  // namespace

void add_missing(Page& page, const RunData& run) {
  const auto gaps = objects(run.manifest, "gaps"), restarts = objects(run.manifest, "restarts");
  if (gaps.empty() && restarts.empty()) return;
  page.open_section("Missing samples", "lost hosts");
  for (const ordered_json& restart : restarts)
    page.paragraph(
        fmt::format("Host {} was lost; its part was started again and goes on at {} s, with blocks that have forgotten "
                    "what was before.",
                    host_of(restart), shown(number(restart, "begin_s"), 9)));
  const Table table = table_of(gaps);
  if (table.rows.empty())
    page.paragraph("No connection that another host reads misses a sample.");
  else
    page.paragraph(
        "These samples do not exist. In their place stands no number, or with gaps: hold the last sample before. All "
        "others are exact.");
  add_table(page.body(), table);
  std::set<std::string> told;
  for (const ordered_json& restart : restarts)
    if (const std::string host = host_of(restart); told.insert(host).second)
      page.paragraph(
          fmt::format("What {0} recorded is not joined with the rest: it lies in restarted/{0}, positions there count "
                      "from each part's own begin.",
                      host));
  page.close_section();
}

}  // namespace bodeflow::tools::report
