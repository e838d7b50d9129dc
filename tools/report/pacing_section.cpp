#include "report/pacing_section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/json_fields.hpp"

namespace bodeflow::tools::report {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t kMostCharts = 8;
constexpr double kLeast = 0.5;  // where the axes of a histogram begin: half a chunk, half a microsecond

/// How one phase was paced, on one host where there are several.
struct Paced {
  std::string host, phase;
  std::uint64_t repeat = 0;
  const ordered_json* pacing = nullptr;

  std::string title() const {
    std::string title = phase;
    if (repeat > 0) title += fmt::format("{}repetition {}", title.empty() ? "" : ", ", repeat + 1);
    if (!host.empty()) title += fmt::format("{}{}", title.empty() ? "" : " on ", host);
    return title;
  }
};

std::vector<Paced> paced_of(const ordered_json& manifest) {
  std::vector<Paced> all;
  for (const char* list : {"phases", "hosts"}) {
    const auto entries = manifest.find(list);
    if (entries == manifest.end() || !entries->is_array()) continue;
    for (const auto& entry : *entries) {
      if (!entry.is_object() || !entry.contains("pacing") || !entry["pacing"].is_object()) continue;
      all.push_back({text_in(entry, "host"), text_in(entry, "phase"), count_in(entry, "repeat"), &entry["pacing"]});
    }
  }
  return all;
}

/// Chunks by lateness, by octaves from one microsecond; without series where nothing was counted.
Chart histogram(const Paced& paced) {
  Chart chart;
  chart.name = paced.title().empty() ? "lateness" : "lateness_" + paced.title();
  chart.title = paced.title().empty() ? "Lateness of the chunks" : paced.title();
  chart.description = "Number of chunks over how late they began, both axes logarithmic.";
  chart.x_title = "Lateness [µs]";
  chart.x_logarithmic = true;
  const auto bins = paced.pacing->find("bins");
  if (bins == paced.pacing->end() || !bins->is_array()) return chart;
  Series series;
  series.solid = true;
  double most = 0.0;
  std::size_t last = 0;
  for (std::size_t k = 0; k < bins->size(); ++k) {
    if (!(*bins)[k].is_number_unsigned() || (*bins)[k].get<std::uint64_t>() == 0) continue;
    const double chunks = (*bins)[k].get<double>(), low = std::ldexp(kLeast, static_cast<int>(std::min<std::size_t>(k, 60)));
    most = std::max(most, chunks);
    if (!series.x.empty() && last + 1 != k) {
      series.x.push_back(low);
      series.y.push_back(kNaN);
    }
    const std::pair<double, double> corners[] = {{low, kLeast}, {low, chunks}, {2 * low, chunks}, {2 * low, kLeast}};
    for (const auto& [x, y] : corners) {
      series.x.push_back(x);
      series.y.push_back(y);
    }
    last = k;
  }
  if (series.x.empty()) return chart;
  series.low.assign(series.y.size(), kLeast);
  series.high = series.y;
  Panel panel;
  panel.y = {Scale::logarithmic, 0, 1, {}, {}, "Chunks"};
  panel.range = Extent{kLeast, 2 * std::max(most, 1.0)};
  panel.height = 220.0;
  panel.series.push_back(std::move(series));
  chart.panels.push_back(std::move(panel));
  return chart;
}

/// Threads went on without the priority: the system's refusal begins with it.
bool was_refused(const Paced& paced, double priority) {
  const auto texts = paced.pacing->find("not_permitted");
  if (!std::isfinite(priority) || texts == paced.pacing->end() || !texts->is_array()) return false;
  const std::string begin = fmt::format("priority {:.0f}", priority);
  return std::any_of(texts->begin(), texts->end(),
                     [&](const auto& text) { return text.is_string() && text.template get<std::string>().starts_with(begin); });
}

std::string settings_of(const Paced& paced) {
  std::string text = text_in(*paced.pacing, "clock");
  if (text == "realtime") text += ", on_overrun: " + text_in(*paced.pacing, "on_overrun");
  const double priority = number_in(*paced.pacing, "priority");
  text += std::isfinite(priority) ? fmt::format(", priority {:.0f}", priority) : ", without priority";
  if (was_refused(paced, priority)) text += " (not permitted)";
  const auto cores = paced.pacing->find("cores");
  if (cores != paced.pacing->end() && cores->is_array() && !cores->empty()) text += ", cores " + cores->dump();
  return text;
}

Table table_of(const std::vector<Paced>& all) {
  Table table{"How late chunks began [µs]",
              {{"Phase", false},
               {"Host", false},
               {"Clock", false},
               {"Chunks"},
               {"Median"},
               {"99 %"},
               {"Greatest"},
               {"Overruns"},
               {"Chunks left out"}},
              {}};
  const bool hosts = std::any_of(all.begin(), all.end(), [](const Paced& paced) { return !paced.host.empty(); });
  for (const Paced& paced : all) {
    table.rows.push_back({paced.phase.empty() ? "the run" : paced.phase, paced.host, settings_of(paced),
                          counted(count_in(*paced.pacing, "chunks")), shown(1e6 * number_in(*paced.pacing, "median_s"), 3),
                          shown(1e6 * number_in(*paced.pacing, "p99_s"), 3), shown(1e6 * number_in(*paced.pacing, "max_s")),
                          counted(count_in(*paced.pacing, "overruns")), counted(count_in(*paced.pacing, "skipped"))});
    if (!hosts) table.rows.back().erase(table.rows.back().begin() + 1);
  }
  if (!hosts) table.columns.erase(table.columns.begin() + 1);
  return table;
}

void add_not_permitted(Page& page, const std::vector<Paced>& all) {
  std::vector<std::string> told;
  for (const Paced& paced : all) {
    const auto texts = paced.pacing->find("not_permitted");
    if (texts == paced.pacing->end() || !texts->is_array()) continue;
    for (const auto& text : *texts) {
      if (!text.is_string()) continue;
      const std::string note = (paced.host.empty() ? "" : paced.host + ": ") + text.get<std::string>();
      if (std::find(told.begin(), told.end(), note) != told.end()) continue;
      page.note(note);
      told.push_back(note);
    }
  }
}

}  // namespace

void add_pacing(Page& page, const RunData& run) {
  const std::vector<Paced> all = paced_of(run.manifest);
  if (all.empty()) return;
  page.open_section("Pacing", "real time");
  add_table(page.body(), table_of(all));
  add_not_permitted(page, all);
  std::vector<Chart> charts;
  for (const Paced& paced : all)
    if (Chart chart = histogram(paced); !chart.panels.empty() && charts.size() < kMostCharts) charts.push_back(std::move(chart));
  const bool realtime =
      std::any_of(all.begin(), all.end(), [](const Paced& paced) { return count_in(*paced.pacing, "chunks") > 0; });
  if (realtime)
    page.paragraph(
        "A chunk is late by the time from its place on the clock to its begin. An overrun is a chunk whose time had come before "
        "its thread was through with the one before.");
  else
    page.paragraph("A device paced the run: the engine had no times to be late against.");
  page.grid(charts, "Chunks by lateness: below 1 µs, then by octaves.");
  page.close_section();
}

}  // namespace bodeflow::tools::report
