#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "report/bode.hpp"
#include "report/numbers.hpp"
#include "report/sections.hpp"

namespace bodeflow::tools::report {
namespace {

using Complex = std::complex<double>;

/// A response and its model, lines x entries, entry input * outputs + output.
struct FittedLines {
  const Record& record;
  const Array& frequency;
  const Array& response;
  const Array& model;
  std::vector<std::string> entries;  ///< "output / input"

  std::size_t lines() const { return frequency.size(); }
  std::size_t at(std::size_t line, std::size_t entry) const { return line * entries.size() + entry; }
};

/// What one curve of a panel shows.
struct Curve {
  std::string name;
  int colour = 0;
  std::vector<Complex> values;
  bool model = false;
};

std::vector<Complex> column(const FittedLines& f, const Array& values, std::size_t entry) {
  std::vector<Complex> c;
  for (std::size_t k = 0; k < f.lines(); ++k) c.push_back(values.at(f.at(k, entry)));
  return c;
}

std::vector<Complex> difference(const std::vector<Complex>& a, const std::vector<Complex>& b) {
  std::vector<Complex> d;
  for (std::size_t k = 0; k < a.size(); ++k) d.push_back(a[k] - b[k]);
  return d;
}

Series series_of(const Curve& curve, const std::vector<double>& frequency, std::pair<std::size_t, std::size_t> lines,
                 bool phase) {
  Series s;
  s.name = phase ? "" : curve.name;
  s.colour = curve.colour;
  s.model = curve.model;
  std::vector<double> values;
  for (std::size_t k = lines.first; k < lines.second; ++k) {
    s.x.push_back(frequency[k]);
    const double size = std::abs(curve.values[k]);
    values.push_back(!(size > 0.0) ? kNaN : phase ? std::arg(curve.values[k]) * 180.0 / std::numbers::pi : decibel(size));
  }
  s.y = phase ? unwrapped(values, std::vector<bool>(values.size(), true)) : std::move(values);
  return s;
}

/// Magnitudes above phases; of those that are small against the data no phases.
Chart two_panels(const FittedLines& f, const std::string& title, const std::vector<Curve>& curves, std::size_t with_phase,
                 std::pair<std::size_t, std::size_t> lines) {
  Chart chart;
  chart.title = title;
  chart.x_title = "Frequency [Hz]";
  chart.x_logarithmic = is_logarithmic({f.frequency.re.begin() + static_cast<std::ptrdiff_t>(lines.first),
                                        f.frequency.re.begin() + static_cast<std::ptrdiff_t>(lines.second)});
  Panel upper, lower;
  upper.y = {Scale::decibel, 0, 1, {}, {}, with_unit("Magnitude", f.response.unit.empty() ? "dB" : "dB re 1 " + f.response.unit)};
  upper.height = 230.0;
  lower.y = {Scale::degrees, 0, 1, {}, {}, "Phase [°]"};
  lower.height = 150.0;
  for (std::size_t n = 0; n < curves.size(); ++n) {
    upper.series.push_back(thinned(series_of(curves[n], f.frequency.re, lines, false), chart.x_logarithmic));
    if (n < with_phase) lower.series.push_back(thinned(series_of(curves[n], f.frequency.re, lines, true), chart.x_logarithmic));
  }
  chart.panels.push_back(std::move(upper));
  chart.panels.push_back(std::move(lower));
  return chart;
}

/// Jue's display of a band: six panels, magnitude above phase, for all bands, for the whole range, and for the band.
void add_band(Page& page, const FittedLines& f, const std::vector<std::vector<Complex>>& bands, std::size_t band,
              std::pair<double, double> edges, std::size_t entry) {
  const auto data = column(f, f.response, entry), sum = column(f, f.model, entry);
  const auto others = difference(sum, bands[band]), left = difference(data, others);
  std::vector<Curve> all{{"data", 0, data}};
  for (std::size_t b = 0; b < bands.size(); ++b)
    all.push_back({fmt::format("band {}", b + 1), static_cast<int>(b) + 1, bands[b], true});
  const auto& frequency = f.frequency.re;
  const auto first = std::lower_bound(frequency.begin(), frequency.end(), edges.first) - frequency.begin(),
             last = std::upper_bound(frequency.begin(), frequency.end(), edges.second) - frequency.begin();
  std::vector<Chart> charts;
  charts.push_back(two_panels(f, "Data and all bands", all, all.size(), {0, f.lines()}));
  charts.push_back(two_panels(f, fmt::format("Band {} over all lines", band + 1),
                              {{"data", 0, data},
                               {"estimate", 1, bands[band], true},
                               {"left for it", 2, left},
                               {"left by all", 3, difference(data, sum)}},
                              2, {0, f.lines()}));
  if (last - first > 1)
    charts.push_back(two_panels(f, fmt::format("Band {}: {} to {} Hz", band + 1, shown(edges.first), shown(edges.second)),
                                {{"left for it", 2, left}, {"estimate", 1, bands[band], true}}, 2,
                                {static_cast<std::size_t>(first), static_cast<std::size_t>(last)}));
  const char* what[] = {"Magnitude and phase of the data and of the model of each band.",
                        "Magnitude and phase of data and estimate of the band, and what is left, over all lines.",
                        "What the other bands leave and the estimate, in the band."};
  for (std::size_t n = 0; n < charts.size(); ++n) {
    charts[n].name = fmt::format("{}_band_{}_{}", f.record.key, band + 1, n + 1);
    charts[n].description = what[n];
  }
  page.grid(charts);
}

void add_bands(Page& page, const FittedLines& f) {
  const Array* edges = f.record.array("band_edges");
  if (edges == nullptr || edges->is_complex() || edges->shape.size() != 2 || edges->shape[1] != 2) return;
  const std::size_t count = edges->shape[0];
  const Array* models = f.record.array("band_response", {count, f.lines(), f.entries.size()}, true);
  if (models == nullptr || count == 0) return;
  std::size_t strongest = 0;
  double most = -1.0;
  for (std::size_t e = 0; e < f.entries.size(); ++e) {
    double power = 0.0;
    for (std::size_t k = 0; k < f.lines(); ++k) power += std::norm(f.response.at(f.at(k, e)));
    if (power > most) {
      most = power;
      strongest = e;
    }
  }
  std::vector<std::vector<Complex>> bands(count);
  for (std::size_t b = 0; b < count; ++b)
    for (std::size_t k = 0; k < f.lines(); ++k)
      bands[b].push_back(models->at(b * f.lines() * f.entries.size() + f.at(k, strongest)));
  page.heading("Band by band");
  page.paragraph(
      fmt::format("{}: each band is fitted to what the models of the others leave; outside of it the fit need not be good.",
                  f.entries[strongest]));
  for (std::size_t b = 0; b < std::min<std::size_t>(count, 10); ++b)
    add_band(page, f, bands, b, {edges->re[2 * b], edges->re[2 * b + 1]}, strongest);
}

void add_errors(Page& page, const FittedLines& f) {
  Table table{"Errors",
              {{"Output / input", false},
               {with_unit("Root mean square", f.response.unit)},
               {"over that of the data"},
               {"Largest relative error"},
               {"at [Hz]"}},
              {}};
  std::vector<Chart> charts;
  for (std::size_t e = 0; e < f.entries.size(); ++e) {
    const auto data = column(f, f.response, e), error = difference(data, column(f, f.model, e));
    Series series;
    series.x = f.frequency.re;
    double squares = 0.0, size = 0.0, largest = 0.0, where = kNaN;
    for (std::size_t k = 0; k < f.lines(); ++k) {
      squares += std::norm(error[k]);
      size += std::norm(data[k]);
      const double relative = std::abs(error[k]) / std::abs(data[k]);
      series.y.push_back(std::isfinite(relative) && relative > 0.0 ? 100.0 * relative : kNaN);
      if (std::isfinite(relative) && relative > largest) {
        largest = relative;
        where = f.frequency.re[k];
      }
    }
    table.rows.push_back({f.entries[e], shown(std::sqrt(squares / static_cast<double>(f.lines())), 4),
                          percent(std::sqrt(squares / size)), percent(largest), shown(where, 5)});
    if (charts.size() >= kMostPairs) continue;
    Chart chart;
    chart.title = f.entries[e];
    chart.name = fmt::format("{}_percent_{}", f.record.key, e + 1);
    chart.description = "Distance of model and data in per cent of the data's magnitude, line by line.";
    chart.x_title = "Frequency [Hz]";
    chart.x_logarithmic = is_logarithmic(f.frequency.re);
    Panel panel;
    panel.y = {Scale::logarithmic, 0, 1, {}, {}, "Error [%]"};
    panel.height = 220.0;
    panel.series.push_back(thinned(series, chart.x_logarithmic));
    chart.panels.push_back(std::move(panel));
    charts.push_back(std::move(chart));
  }
  page.heading("Percentage error");
  page.grid(charts);
  add_table(page.body(), table);
}

}  // namespace

bool add_fitted_lines(Page& page, const Record& record) {
  const Array *frequency = record.array("frequency"), *response = record.array("response");
  const auto outputs = record.texts("output_names"), inputs = record.texts("input_names");
  if (frequency == nullptr || frequency->is_complex() || frequency->shape.size() != 1 || frequency->size() == 0 ||
      response == nullptr)
    return false;
  const std::vector<std::uint64_t> shape{frequency->size(), outputs.size() * inputs.size()};
  response = record.array("response", shape, true);
  const Array* model = record.array("model_response", shape, true);
  if (response == nullptr || model == nullptr || shape[1] == 0) return false;
  FittedLines f{record, *frequency, *response, *model, {}};
  for (const auto& input : inputs)
    for (const auto& output : outputs) f.entries.push_back(output + " / " + input);
  add_errors(page, f);
  add_bands(page, f);
  add_attributes(page, record, {"output_names", "input_name", "input_names"});
  return true;
}

}  // namespace bodeflow::tools::report
