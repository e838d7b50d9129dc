#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/numbers.hpp"
#include "report/sections.hpp"

namespace bodeflow::tools::report {
namespace {

/// A way in which the noise was estimated, as the record names it.
struct Estimate {
  const char* name;
  const char* suffix;
};
constexpr Estimate kEstimates[] = {{"first pass", "first"}, {"without outliers", "second"}, {"pooled periods", "pooled"}};

const Array* estimate_of(const Record& record, const char* signal, const char* suffix, std::size_t bands) {
  return record.array(std::string(signal) + "_" + suffix, {bands});
}

void add_estimates(Page& page, const Record& record, std::size_t bands) {
  Table table{"Noise, standard deviations", {{"Band", false}, {"Signal", false}}, {}};
  for (const Estimate& e : kEstimates) table.columns.push_back({e.name});
  for (std::size_t b = 0; b < bands; ++b) {
    for (const char* signal : {"input", "output"}) {
      std::vector<std::string> row{record.text_at("bands", b, ""), record.text(std::string(signal) + "_name")};
      for (const Estimate& e : kEstimates) {
        const Array* values = estimate_of(record, signal, e.suffix, bands);
        row.push_back(values == nullptr ? "–" : with_unit(shown(values->re[b], 4), values->unit));
      }
      table.rows.push_back(std::move(row));
    }
  }
  add_table(page.body(), table);
}

/// The curves of a band's lines in the plane of the variances, and the points that were estimated.
Chart curves_of(const Record& record, const Array& x, const Array& y, const std::vector<double>& band_of_line, std::size_t band,
                std::size_t bands) {
  const auto points = static_cast<std::size_t>(x.shape[1]);
  Chart chart;
  chart.name = fmt::format("{}_curves_{}", record.key, band + 1);
  chart.title = record.text_at("bands", band, "");
  chart.description = "One curve a line; without scatter all of them pass through the true variances.";
  chart.x_title = with_unit("Variance of the input", x.unit);
  Panel panel;
  panel.y.title = with_unit("Variance of the output", y.unit);
  panel.height = 300.0;
  for (std::size_t k = 0; k < band_of_line.size(); ++k) {
    if (band_of_line[k] != static_cast<double>(band)) continue;
    Series curve;
    const auto from = static_cast<std::ptrdiff_t>(k * points), to = from + static_cast<std::ptrdiff_t>(points);
    curve.x.assign(x.re.begin() + from, x.re.begin() + to);
    curve.y.assign(y.re.begin() + from, y.re.begin() + to);
    curve.solid = true;
    panel.series.push_back(std::move(curve));
  }
  int colour = 1;
  for (const Estimate& e : kEstimates) {
    const Array *input = estimate_of(record, "input", e.suffix, bands), *output = estimate_of(record, "output", e.suffix, bands);
    if (input == nullptr || output == nullptr) continue;
    Series point;
    point.name = e.name;
    point.x = {input->re[band] * input->re[band]};
    point.y = {output->re[band] * output->re[band]};
    point.colour = colour++;
    point.line = false;
    point.markers = true;
    panel.series.push_back(std::move(point));
  }
  chart.panels.push_back(std::move(panel));
  return chart;
}

}  // namespace

bool add_noise_variances(Page& page, const Record& record) {
  const std::size_t bands = record.texts("bands").size();
  if (bands == 0 || estimate_of(record, "input", "first", bands) == nullptr) return false;
  add_estimates(page, record, bands);
  add_attributes(page, record, {"bands", "input_name", "output_name"});
  const Array *x = record.array("curve_input"), *y = record.array("curve_output"), *line_band = record.array("band");
  if (x == nullptr || y == nullptr || line_band == nullptr || x->shape.size() != 2 || y->shape != x->shape ||
      line_band->size() != x->shape[0])
    return true;
  std::vector<Chart> charts;
  for (std::size_t b = 0; b < bands; ++b) charts.push_back(curves_of(record, *x, *y, line_band->re, b, bands));
  page.grid(charts, "Variances of input and output noise that make the spectral matrix of a line singular: one curve a line.");
  return true;
}

}  // namespace bodeflow::tools::report
