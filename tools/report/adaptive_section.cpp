#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/numbers.hpp"
#include "report/sections.hpp"

namespace bodeflow::tools::report {
namespace {

constexpr std::size_t kMostSamples = 20'000;  // that are drawn one by one
constexpr std::size_t kFirstEstimates = 15;   // samples whose estimates still swing from their zero start
constexpr std::size_t kOpenActions = 16;      // of safety nets that are listed without a click
constexpr double kFarEstimate = 3.0;          // times the largest |G|: estimates beyond it are left out of the Nyquist plot

Panel panel_of(const std::string& title, double height) {
  Panel panel;
  panel.y = {Scale::linear, 0, 1, {}, {}, title};
  panel.height = height;
  return panel;
}

/// A signal of the run over time.
Series signal(const Record& record, const std::string& array, const std::string& name, int colour) {
  Series series;
  series.name = name;
  series.colour = colour;
  series.solid = colour < 2;
  const Array* values = record.array(array);
  if (values == nullptr) return series;
  const double step = record.number("sample_time");
  const std::size_t stride = std::max<std::size_t>(1, values->size() / kMostSamples);
  for (std::size_t n = 0; n < values->size(); n += stride) {
    series.x.push_back(step * static_cast<double>(n));
    series.y.push_back(values->re[n]);
  }
  return series;
}

/// What is left between a signal and the desired one.
Series error(const Record& record, const std::string& array, const std::string& name, int colour) {
  Series series = signal(record, array, name, colour);
  const Series desired = signal(record, "desired", "", 0);
  const std::size_t count = std::min(series.y.size(), desired.y.size());
  series.x.resize(count);
  series.y.resize(count);
  for (std::size_t n = 0; n < count; ++n) series.y[n] -= desired.y[n];
  return series;
}

Chart signals_chart(const Record& record) {
  Chart chart;
  chart.name = record.key + "-signals";
  chart.title = "Command, output and control signal";
  chart.description = "The command, the plant's output with the desired one, and the limited control signal over time.";
  chart.x_title = "Time [s]";
  chart.panels = {panel_of("y", 240.0), panel_of("u", 180.0)};
  chart.panels[0].series = {signal(record, "output", "output", 0), signal(record, "command", "command", 3)};
  if (record.array("desired") != nullptr) chart.panels[0].series.push_back(signal(record, "desired", "desired", 1));
  if (record.array("beside") != nullptr) chart.panels[0].series.push_back(signal(record, "beside", "beside", 2));
  chart.panels[1].series = {signal(record, "control", "", 0)};
  if (record.array("desired") != nullptr) {
    chart.panels.push_back(panel_of("y − desired", 180.0));
    chart.panels[2].series = {error(record, "output", "output", 0)};
    if (record.array("beside") != nullptr) chart.panels[2].series.push_back(error(record, "beside", "beside", 2));
  }
  return chart;
}

/// The tracking error from each of the times to the next.
Table windows_table(const Record& record) {
  Table table{"Tracking error", {{"From [s]"}, {"to [s]"}, {"rms of y − desired"}}, {}};
  const auto numbers = [&](const char* name) {
    std::vector<double> list;
    const auto found = record.attributes.find(name);
    if (found == record.attributes.end() || !found->is_array()) return list;
    for (const auto& value : *found) list.push_back(value.is_number() ? value.get<double>() : kNaN);
    return list;
  };
  const std::vector<double> times = numbers("windows"), rms = numbers("rms_in_windows");
  for (std::size_t i = 0; i < rms.size() && i + 1 < times.size(); ++i) {
    table.rows.push_back({shown(times[i]), shown(times[i + 1]), shown(rms[i])});
  }
  return table;
}

/// What the safety nets did, and why.
Table nets_table(const Record& record) {
  Table table{"Safety nets", {{"Time [s]"}, {"Net", false}}, {}};
  const std::vector<std::string> texts = record.texts("net_actions");
  const Array* times = record.array("net_action_time", {texts.size()});
  for (std::size_t i = 0; times != nullptr && i < texts.size(); ++i) table.rows.push_back({shown(times->re[i]), texts[i]});
  return table;
}

/// The curve in pieces of rising or falling real part, each as a series from left to right.
void add_curve(Panel& panel, const Array& curve) {
  std::size_t from = 0;
  while (from + 1 < curve.size()) {
    const bool rising = curve.re[from + 1] > curve.re[from];
    std::size_t to = from + 1;
    while (to + 1 < curve.size() && (curve.re[to + 1] > curve.re[to]) == rising) ++to;
    Series piece;
    piece.name = from == 0 ? "plant" : "";
    piece.colour = 1;
    piece.solid = true;
    piece.x.assign(curve.re.begin() + static_cast<std::ptrdiff_t>(from), curve.re.begin() + static_cast<std::ptrdiff_t>(to + 1));
    piece.y.assign(curve.im.begin() + static_cast<std::ptrdiff_t>(from), curve.im.begin() + static_cast<std::ptrdiff_t>(to + 1));
    if (!rising) {
      std::reverse(piece.x.begin(), piece.x.end());
      std::reverse(piece.y.begin(), piece.y.end());
    }
    panel.series.push_back(std::move(piece));
    from = to;
  }
}

Chart nyquist_chart(const Record& record, const Array& response) {
  Chart chart;
  chart.name = record.key + "-nyquist";
  chart.title = "Nyquist curve";
  chart.description = "The plant's response in the complex plane with the estimates at the frequencies of fitting.";
  chart.x_title = "Re G";
  chart.panels = {panel_of("Im G", 380.0)};
  double largest = 0.0;
  if (const Array* curve = record.array("curve"); curve != nullptr && curve->is_complex()) {
    add_curve(chart.panels[0], *curve);
    for (std::size_t i = 0; i < curve->size(); ++i) largest = std::max(largest, std::abs(curve->at(i)));
  }
  const std::size_t points = response.shape[0], samples = response.shape[1];
  const std::size_t stride = std::max<std::size_t>(1, samples / kMostMarkers);
  for (std::size_t j = 0; j < points; ++j) {
    Series estimates;
    estimates.name = j == 0 ? "estimates" : "";
    estimates.line = false;
    estimates.markers = true;
    for (std::size_t n = kFirstEstimates; n < samples; n += stride) {
      const std::complex<double> g = response.at(j * samples + n);
      if (g == 0.0 || (largest > 0.0 && std::abs(g) > kFarEstimate * largest)) continue;
      estimates.x.push_back(g.real());
      estimates.y.push_back(g.imag());
    }
    chart.panels[0].series.push_back(estimates);
  }
  return chart;
}

std::vector<Chart> coefficient_charts(const Record& record, const Array& coefficients) {
  std::vector<Chart> charts;
  const std::size_t channels = coefficients.shape[0], samples = coefficients.shape[1];
  const double step = record.number("sample_time");
  for (const char letter : {'r', 's', 't'}) {
    Chart chart;
    chart.name = fmt::format("{}-{}", record.key, letter);
    chart.title = fmt::format("Coefficients {}", letter);
    chart.description = chart.title + " of the controller over time.";
    chart.x_title = "Time [s]";
    chart.panels = {panel_of(std::string(1, letter), 180.0)};
    for (std::size_t c = 0; c < channels; ++c) {
      const std::string name = record.text_at("coefficient_names", c, "");
      if (name.empty() || name[0] != letter) continue;
      Series series;
      series.name = name;
      series.colour = static_cast<int>(chart.panels[0].series.size()) % 6;
      const std::size_t stride = std::max<std::size_t>(1, samples / kMostSamples);
      for (std::size_t n = 0; n < samples; n += stride) {
        series.x.push_back(step * static_cast<double>(n));
        series.y.push_back(coefficients.re[c * samples + n]);
      }
      chart.panels[0].series.push_back(std::move(series));
    }
    if (!chart.panels[0].series.empty()) charts.push_back(std::move(chart));
  }
  return charts;
}

bool is_table(const Array* array) {
  return array != nullptr && array->shape.size() == 2 && array->shape[0] > 0 &&
         array->size() == array->shape[0] * array->shape[1];
}

/// Those that fit on a screen stand open.
void add_nets(Page& page, const Record& record) {
  const Table table = nets_table(record);
  if (table.rows.empty()) return;
  const bool long_list = table.rows.size() > kOpenActions;
  if (long_list) open_details(page.body(), fmt::format("Safety nets: {} actions", table.rows.size()));
  add_table(page.body(), table);
  if (long_list) close_details(page.body());
  const double more = record.number("more_net_actions");
  if (more > 0.0) page.note(fmt::format("{} further actions are not listed.", shown(more)));
}

}  // namespace

bool add_adaptive_run(Page& page, const Record& record) {
  const Array* output = record.array("output");
  if (output == nullptr || output->size() == 0 || !(record.number("sample_time") > 0.0)) return false;
  add_attributes(page, record, {"coefficient_names", "windows", "rms_in_windows", "net_actions"});
  add_table(page.body(), windows_table(record));
  page.figure(signals_chart(record), "Output and control signal over time.");
  if (const Array* response = record.array("response"); is_table(response) && response->is_complex()) {
    page.figure(nyquist_chart(record, *response),
                fmt::format("Estimates from sample {} on; those before still swing from their start at zero.", kFirstEstimates));
  }
  if (const Array* coefficients = record.array("coefficients"); is_table(coefficients)) {
    page.grid(coefficient_charts(record, *coefficients), "The controller's coefficients over time.");
  }
  add_nets(page, record);
  return true;
}

}  // namespace bodeflow::tools::report
