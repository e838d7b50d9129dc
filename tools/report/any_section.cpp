#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/numbers.hpp"
#include "report/sections.hpp"

namespace bodeflow::tools::report {
namespace {

constexpr std::size_t kMostText = 300;  ///< characters of an attribute
constexpr std::size_t kMostItems = 12;  ///< of a list
constexpr std::size_t kFewValues = 12;  ///< an array that stands in the table itself
constexpr std::size_t kMostCharts = 12;
constexpr std::uint64_t kMostColumns = 8;  ///< of a matrix that is shown as such

std::string item_text(const nlohmann::ordered_json& value) {
  if (value.is_string()) return shortened(value.get<std::string>(), kMostText);
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (value.is_number_integer()) return value.dump();
  if (value.is_number()) return shown(value.get<double>(), 6);
  return "–";
}

std::string attribute_text(const nlohmann::ordered_json& value) {
  if (!value.is_array()) return item_text(value);
  std::string text;
  for (std::size_t n = 0; n < std::min(value.size(), kMostItems); ++n) text += (n == 0 ? "" : ", ") + item_text(value[n]);
  if (value.size() > kMostItems) text += fmt::format(" … ({} in all)", value.size());
  return text.empty() ? "none" : text;
}

/// "sample_rate" as "Sample rate".
std::string title_of(const std::string& name) {
  if (name == "aic" || name == "mdl") return name == "aic" ? "AIC" : "MDL";
  std::string title = name;
  for (char& c : title)
    if (c == '_') c = ' ';
  if (!title.empty() && title[0] >= 'a' && title[0] <= 'z') title[0] = static_cast<char>(title[0] - 'a' + 'A');
  return shortened(title, 60);
}

/// A number, or a list of numbers.
bool is_numeric(const nlohmann::ordered_json& value) {
  return value.is_number() || (value.is_array() && !value.empty() && value.front().is_number());
}

/// Of attributes whose unit is fixed by their name.
std::string unit_of(const std::string& name) {
  if (name == "sample_rate" || name == "band") return " Hz";
  if (name == "sample_time" || name == "delay" || name == "standard_deviation" || name == "largest_delay") return " s";
  if (name == "resolution") return " Hz";
  if (name == "period" || name == "shift" || name == "dropped_samples") return " samples";
  return "";
}

std::string shape_text(const Array& array) {
  std::string text;
  for (const std::uint64_t size : array.shape) text += (text.empty() ? "" : " × ") + counted(size);
  return text.empty() ? "1" : text;
}

std::string value_text(const Array& array, std::size_t n) {
  if (!array.is_complex()) return shown(array.re[n], 6);
  return fmt::format("{} {} {}j", shown(array.re[n]), array.im[n] < 0.0 ? "−" : "+", shown(std::abs(array.im[n])));
}

void add_arrays(Page& page, const Record& record) {
  if (record.arrays.empty()) return;
  Table table{"Arrays", {{"Array", false}, {"Unit", false}, {"Shape", false}, {"Values", false}}, {}};
  for (const auto& [name, array] : record.arrays) {
    std::string values;
    if (array.size() <= kFewValues) {
      for (std::size_t n = 0; n < array.size(); ++n) values += (n == 0 ? "" : ", ") + value_text(array, n);
    } else {
      Extent extent;
      for (std::size_t n = 0; n < array.size(); ++n) extent.add(array.is_complex() ? std::abs(array.at(n)) : array.re[n]);
      if (!extent.empty())
        values = fmt::format("{}{} to {}", array.is_complex() ? "magnitudes " : "", shown(extent.low), shown(extent.high));
    }
    table.rows.push_back({name, array.unit, shape_text(array), values});
  }
  add_table(page.body(), table);
}

void add_matrix(Page& page, const std::string& name, const Array& array) {
  Table table{with_unit(name, array.unit), {{"", false}}, {}};
  for (std::uint64_t j = 0; j < array.shape[1]; ++j) table.columns.push_back({std::to_string(j + 1)});
  for (std::uint64_t i = 0; i < array.shape[0]; ++i) {
    std::vector<std::string> row{std::to_string(i + 1)};
    for (std::uint64_t j = 0; j < array.shape[1]; ++j) row.push_back(value_text(array, i * array.shape[1] + j));
    table.rows.push_back(std::move(row));
  }
  add_table(page.body(), table);
}

/// What the curves of a record stand over: its frequencies or times, where they have that many values; the index otherwise.
std::pair<std::string, std::vector<double>> abscissa(const Record& record, std::size_t count) {
  for (const auto& [name, title] : {std::pair{"frequency", "Frequency"}, {"time", "Time"}, {"t", "Time"}})
    if (const Array* array = record.array(name, {count})) return {with_unit(title, array->unit), array->re};
  std::vector<double> index(count);
  for (std::size_t n = 0; n < count; ++n) index[n] = static_cast<double>(n);
  return {"Index", std::move(index)};
}

Chart curve_of(const Record& record, const std::string& name, const Array& array) {
  Chart chart;
  chart.title = with_unit(array.is_complex() ? "|" + name + "|" : name, array.unit);
  chart.name = fmt::format("{}_{}", record.key, name);
  chart.description = fmt::format("The {} values of the array over {}.", array.size(), "its index, frequency or time");
  Series series;
  std::tie(chart.x_title, series.x) = abscissa(record, array.size());
  chart.x_logarithmic = chart.x_title.rfind("Frequency", 0) == 0 && is_logarithmic(series.x);
  for (std::size_t n = 0; n < array.size(); ++n) series.y.push_back(array.is_complex() ? std::abs(array.at(n)) : array.re[n]);
  Panel panel;
  panel.y.title = with_unit(name, array.unit);
  panel.height = 250.0;
  panel.series.push_back(thinned(series, chart.x_logarithmic));
  chart.panels.push_back(std::move(panel));
  return chart;
}

}  // namespace

Facts facts_of(const Record& record, const std::vector<std::string>& shown_elsewhere) {
  Facts facts;
  for (const auto& [name, value] : record.attributes.items()) {
    const bool elsewhere = std::find(shown_elsewhere.begin(), shown_elsewhere.end(), name) != shown_elsewhere.end();
    if (name == "warnings" || elsewhere) continue;
    if (name == "sample_time" && value.is_number() && value.get<double>() == 0.0)
      facts.emplace_back("Time", "continuous");
    else
      facts.emplace_back(title_of(name), is_numeric(value) ? attribute_text(value) + unit_of(name) : attribute_text(value));
  }
  return facts;
}

void add_attributes(Page& page, const Record& record, const std::vector<std::string>& shown_elsewhere) {
  add_facts(page.body(), facts_of(record, shown_elsewhere));
}

void add_curves(Page& page, const Record& record, const std::vector<std::string>& shown_elsewhere, std::size_t length) {
  std::vector<Chart> charts;
  for (const auto& [name, array] : record.arrays) {
    const bool elsewhere = std::find(shown_elsewhere.begin(), shown_elsewhere.end(), name) != shown_elsewhere.end();
    const bool fits = array.shape.size() == 1 && array.size() > kFewValues && (length == 0 || array.size() == length);
    if (fits && !elsewhere && charts.size() < kMostCharts) charts.push_back(curve_of(record, name, array));
  }
  page.grid(charts);
}

void add_delay_estimate(Page& page, const Record& record) {
  const double delay = record.number("delay"), deviation = record.number("standard_deviation");
  if (std::isfinite(delay))
    page.body()
        .open("p")
        .element("b", fmt::format("Delay {}{}", shown(delay, "s", 6),
                                  std::isfinite(deviation) ? ", standard deviation " + shown(deviation, "s", 3) : ""))
        .close("p");
  add_any(page, record);
}

void add_any(Page& page, const Record& record) {
  add_attributes(page, record, {});
  add_arrays(page, record);
  for (const auto& [name, array] : record.arrays)
    if (array.shape.size() == 2 && array.size() > 1 && array.shape[0] <= kMostColumns && array.shape[1] <= kMostColumns)
      add_matrix(page, name, array);
  add_curves(page, record, {"frequency", "time", "t"}, 0);
}

}  // namespace bodeflow::tools::report
