#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/numbers.hpp"
#include "report/sections.hpp"

namespace bodeflow::tools::report {
namespace {

constexpr std::size_t kMostRows = 100;

/// "expected_cost" as "Expected cost".
std::string title_of(const std::string& name) {
  std::string title = name;
  std::replace(title.begin(), title.end(), '_', ' ');
  if (!title.empty() && title[0] >= 'a' && title[0] <= 'z') title[0] = static_cast<char>(title[0] - 'a' + 'A');
  return title;
}

bool all_positive(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double x) { return x > 0.0 || !std::isfinite(x); });
}

Series over(const Array& x, const Array& y, const std::string& name, int colour) {
  Series series;
  series.name = name;
  series.colour = colour;
  series.x = x.re;
  series.y = y.re;
  series.markers = x.size() <= kMostMarkers;
  return series;
}

/// A column of an order scan over the order; the cost has the expected one beside it.
Chart scan_chart(const Record& record, const Array& order, const std::string& name, const Array& values) {
  Chart chart;
  chart.title = title_of(name);
  chart.name = fmt::format("{}_{}", record.key, name);
  chart.description = fmt::format("{} of each order that was tried.", chart.title);
  chart.x_title = "Order";
  Panel panel;
  panel.y.scale = all_positive(values.re) ? Scale::logarithmic : Scale::linear;
  panel.y.title = with_unit(chart.title, values.unit);
  panel.height = 220.0;
  const Array* expected = name == "cost" ? record.array("expected_cost", order.shape) : nullptr;
  panel.series.push_back(over(order, values, expected == nullptr ? "" : "cost", 0));
  if (expected != nullptr) panel.series.push_back(over(order, *expected, "expected", 1));
  chart.panels.push_back(std::move(panel));
  return chart;
}

}  // namespace

bool add_order_scan(Page& page, const Record& record) {
  const Array* order = record.array("order");
  if (order == nullptr || order->is_complex() || order->shape.size() != 1 || order->size() == 0) return false;
  const double chosen = record.number("chosen");
  const std::string rule = record.text("rule");
  if (std::isfinite(chosen))
    page.body()
        .open("p")
        .element("b", fmt::format("Order {:.0f} is taken{}.", chosen, rule.empty() ? "" : ": " + rule))
        .close("p");
  Table table{"Orders", {{"Order"}}, {}};
  std::vector<Chart> charts;
  std::vector<const Array*> columns;
  for (const auto& [name, array] : record.arrays) {
    if (&array == order || array.is_complex() || array.shape != order->shape) continue;
    table.columns.push_back({with_unit(title_of(name), array.unit)});
    columns.push_back(&array);
    if (order->size() > 1 && name != "parameter_count" && name != "expected_cost")
      charts.push_back(scan_chart(record, *order, name, array));
  }
  for (std::size_t n = 0; n < std::min(order->size(), kMostRows); ++n) {
    std::vector<std::string> row{shown(order->re[n]) + (order->re[n] == chosen ? " (taken)" : "")};
    for (const Array* column : columns) row.push_back(shown(column->re[n], 6));
    table.rows.push_back(std::move(row));
  }
  add_table(page.body(), table);
  page.grid(charts);
  add_attributes(page, record, {"chosen", "rule"});
  return true;
}

bool add_whiteness(Page& page, const Record& record) {
  const Array* frequency = record.array("frequency");
  if (frequency == nullptr || frequency->is_complex() || frequency->shape.size() != 1 || frequency->size() == 0) return false;
  const Array* power = record.array("power", frequency->shape);
  if (power == nullptr) return false;
  const double probability = record.number("probability");
  if (std::isfinite(probability))
    page.body()
        .open("p")
        .element("b", fmt::format("{}: white noise leaves as much with a probability of {}.",
                                  probability < 0.01 ? "The residual is not white" : "Nothing speaks against a white residual",
                                  probability < 1e-4 ? "below 0.01 %" : percent(probability)))
        .close("p");
  Chart chart;
  chart.title = "Power of the residual by bands";
  chart.name = record.key + "_power";
  chart.description = "Mean power of the residual in each band of frequencies, 1 being that of the noise.";
  chart.x_title = "Frequency [Hz]";
  Panel panel;
  panel.y = {all_positive(power->re) ? Scale::logarithmic : Scale::linear, 0, 1, {}, {}, "Power / expected"};
  panel.height = 220.0;
  panel.series.push_back(over(*frequency, *power, "", 0));
  panel.levels.push_back({1.0, "white noise"});
  chart.panels.push_back(std::move(panel));
  page.figure(chart, "A band well above 1 is where the model or the stated noise lacks something.");
  add_attributes(page, record, {"probability"});
  return true;
}

bool add_residual(Page& page, const Record& record) {
  const Array* band = record.array("band");
  if (band == nullptr || band->is_complex() || band->shape.size() != 2 || band->shape[1] != 2) return false;
  const std::size_t bands = band->shape[0];
  const auto outputs = record.texts("output_names");
  const Array* error = record.array("band_relative_error", {bands, outputs.size()});
  const Array* residual = record.array("band_residual", {bands, outputs.size()});
  if (outputs.empty() || error == nullptr) return false;
  Table table{"By bands", {{"From [Hz]"}, {"to [Hz]"}}, {}};
  for (const auto& output : outputs) {
    table.columns.push_back({output + ": relative error"});
    if (residual != nullptr) table.columns.push_back({output + ": residual / its std"});
  }
  for (std::size_t b = 0; b < std::min(bands, kMostRows); ++b) {
    std::vector<std::string> row{shown(band->re[2 * b]), shown(band->re[2 * b + 1])};
    for (std::size_t i = 0; i < outputs.size(); ++i) {
      row.push_back(percent(error->re[b * outputs.size() + i]));
      if (residual != nullptr) row.push_back(shown(residual->re[b * outputs.size() + i], 3));
    }
    table.rows.push_back(std::move(row));
  }
  add_table(page.body(), table);
  page.paragraph(residual != nullptr
                     ? "Root mean squares. A residual over its standard deviation is about 1 where noise is all that is left."
                     : "Root mean squares over the lines of each band.");
  const Array* frequency = record.array("frequency");
  if (frequency == nullptr || frequency->shape.size() != 1) return true;
  const Array* line_error = record.array("relative_error", {frequency->shape[0], outputs.size()});
  if (line_error == nullptr) return true;
  std::vector<Chart> charts;
  for (std::size_t i = 0; i < outputs.size() && i < 12; ++i) {
    Chart chart;
    chart.title = outputs[i];
    chart.name = fmt::format("{}_error_{}", record.key, i + 1);
    chart.description = "Distance of model and data over the data's magnitude, line by line.";
    chart.x_title = "Frequency [Hz]";
    chart.x_logarithmic = is_logarithmic(frequency->re);
    Series series;
    series.x = frequency->re;
    for (std::size_t k = 0; k < frequency->size(); ++k) series.y.push_back(line_error->re[k * outputs.size() + i]);
    Panel panel;
    panel.y = {all_positive(series.y) ? Scale::logarithmic : Scale::linear, 0, 1, {}, {}, "|G − model| / |G|"};
    panel.height = 220.0;
    panel.series.push_back(thinned(series, chart.x_logarithmic));
    chart.panels.push_back(std::move(panel));
    charts.push_back(std::move(chart));
  }
  page.grid(charts);
  return true;
}

}  // namespace bodeflow::tools::report
