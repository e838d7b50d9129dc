#include "report/trace_charts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/curve.hpp"
#include "report/numbers.hpp"

namespace bodeflow::tools::report {
namespace {

constexpr double kThreeSigma = 3.0;

/// Classes of lines as their numbers stand in `kind`.
struct LineClass {
  double first, last;  ///< kinds
  const char* title;
};
constexpr LineClass kClasses[] = {
    {1.0, 1.0, "Excited lines"}, {2.0, 2.0, "Odd lines"}, {3.0, 3.0, "Even lines"}, {4.0, 5.0, "Between the lines"}};
constexpr LineClass kAll{0.0, 9.0, ""};

bool within(const LineClass& c, double kind) { return kind >= c.first && kind <= c.last; }

/// The lines of one class, or all where there are no classes; zero frequency has no place on the axis.
Series lines_of(const Array& frequency, const Array& level, const Array* kind, const LineClass& wanted, std::string name,
                int colour) {
  Series series;
  series.name = std::move(name);
  series.colour = colour;
  series.markers = kind != nullptr;
  series.line = kind == nullptr;
  for (std::size_t k = 0; k < frequency.size(); ++k) {
    if (!(frequency.re[k] > 0.0) || (kind != nullptr && !within(wanted, kind->re[k]))) continue;
    series.x.push_back(frequency.re[k]);
    series.y.push_back(level.re[k] > 0.0 ? level.re[k] : kNaN);
  }
  return series;
}

Array scaled(Array a, double factor) {
  for (double& value : a.re) value *= factor;
  return a;
}

Panel panel_of(const std::string& title, Scale scale) {
  Panel panel;
  panel.y = {scale, 0, 1, {}, {}, title};
  return panel;
}

Chart frequency_chart(const Record& record, const std::string& name, const std::string& title) {
  Chart chart;
  chart.name = record.key + name;
  chart.title = title;
  chart.description = "Root mean square of measured minus predicted output over frequency, with the noise.";
  chart.x_title = "Frequency [Hz]";
  chart.x_logarithmic = true;
  return chart;
}

/// Whether noise of that shape is there and known somewhere.
bool known(const Array* noise) {
  return noise != nullptr && std::any_of(noise->re.begin(), noise->re.end(), [](double v) { return std::isfinite(v); });
}

void add_noise(Panel& panel, const Array& frequency, const Array& noise, bool named) {
  Series level = lines_of(frequency, noise, nullptr, kAll, named ? "noise" : "", 5);
  Series high = lines_of(frequency, scaled(noise, kThreeSigma), nullptr, kAll, named ? "three times the noise" : "", 4);
  panel.series.push_back(thinned(level, true));
  panel.series.push_back(thinned(high, true));
}

void add_over_frequency(Page& page, const Record& record, const Array& frequency) {
  const Array *before = record.array("residual_before", frequency.shape),
              *after = record.array("residual_after", frequency.shape), *noise = record.array("residual_noise", frequency.shape),
              *kind = record.array("kind", frequency.shape);
  const bool broken = noise == nullptr && record.array("residual_noise") != nullptr;
  if (before == nullptr || after == nullptr || broken) return;
  Chart chart = frequency_chart(record, "_residual", "Residual on the test record");
  const bool added = !record.texts("effects").empty();
  bool first = true;
  for (const LineClass& c : kClasses) {
    if (kind != nullptr && std::none_of(kind->re.begin(), kind->re.end(), [&](double k) { return within(c, k); })) continue;
    Panel panel = panel_of(with_unit(kind == nullptr ? "Lines" : c.title, before->unit), Scale::logarithmic);
    panel.height = 190.0;
    panel.series.push_back(thinned(lines_of(frequency, *before, kind, c, first ? (added ? "before" : "residual") : "", 1), true));
    if (added) panel.series.push_back(thinned(lines_of(frequency, *after, kind, c, first ? "after" : "", 0), true));
    if (known(noise)) add_noise(panel, frequency, *noise, first);
    chart.panels.push_back(std::move(panel));
    first = false;
    if (kind == nullptr) break;
  }
  if (chart.panels.empty()) return;
  if (!known(noise)) {
    page.figure(chart, "Measured minus predicted. Where the noise is not known, nobody can say how small it could be.");
    return;
  }
  page.figure(
      chart,
      "A right model leaves the noise: its lines scatter around the noise's root mean square, and one in 8,000 stands above "
      "three times it.");
}

void add_over_time(Page& page, const Record& record, const Array& time) {
  const Array *measured = record.array("measured", time.shape), *before = record.array("residual_before", time.shape),
              *after = record.array("residual_after", time.shape);
  if (before == nullptr || after == nullptr) return;
  Chart chart;
  chart.name = record.key + "_residual";
  chart.title = "Residual on the test record";
  chart.description = "Measured output and measured minus predicted output over time, before and after.";
  chart.x_title = "Time [s]";
  const auto course = [&](const Array& values, const char* name, int colour) {
    Series series;
    series.name = name;
    series.colour = colour;
    series.x = time.re;
    series.y = values.re;
    return thinned(series, false);
  };
  if (measured != nullptr) {
    Panel panel = panel_of(with_unit("Measured", measured->unit), Scale::linear);
    panel.height = 150.0;
    panel.series.push_back(course(*measured, "", 5));
    chart.panels.push_back(std::move(panel));
  }
  Panel panel = panel_of(with_unit("Residual", before->unit), Scale::linear);
  panel.series.push_back(course(*before, record.texts("effects").empty() ? "" : "before", 1));
  if (!record.texts("effects").empty()) panel.series.push_back(course(*after, "after", 0));
  chart.panels.push_back(std::move(panel));
  page.figure(chart, "Measured minus predicted. Where the noise is not known, nobody can say how small it could be.");
}

/// The array of that name over an axis.
const Array* axis_of(const Record& record, const char* name) {
  const Array* const axis = record.array(name);
  return axis == nullptr || axis->is_complex() || axis->shape.size() != 1 || axis->size() < 2 ? nullptr : axis;
}

/// Values of a residual over an axis as marks joined by a line; with `std` a band of twice as much on both sides.
Series viewed(const std::vector<double>& at, const std::vector<double>& values, const std::vector<double>& std, const char* name,
              int colour) {
  Series series;
  series.name = name;
  series.colour = colour;
  series.markers = true;
  series.solid = true;
  for (std::size_t n = 0; n < at.size(); ++n) {
    if (!std::isfinite(at[n])) continue;
    series.x.push_back(at[n]);
    series.y.push_back(values[n]);
    if (std.empty()) continue;
    series.low.push_back(values[n] - 2.0 * std[n]);
    series.high.push_back(values[n] + 2.0 * std[n]);
  }
  return series;
}

std::vector<double> row_of(const Array& a, std::size_t row) {
  const auto columns = static_cast<std::ptrdiff_t>(a.shape[1]), begin = static_cast<std::ptrdiff_t>(row) * columns;
  return {a.re.begin() + begin, a.re.begin() + begin + columns};
}

Chart view_chart(const Record& record, const std::string& name, const std::string& title, const std::string& x_title) {
  Chart chart;
  chart.name = record.key + name;
  chart.title = title;
  chart.description = title + ", before and after.";
  chart.x_title = x_title;
  return chart;
}

/// The mean of the residual over each signal.
void add_maps(Page& page, const Record& record) {
  const Array* const at = record.array("map_at");
  const auto signals = record.texts("map_signals");
  if (at == nullptr || at->is_complex() || at->shape.size() != 2 || at->shape[0] != signals.size()) return;
  const Array *before = record.array("map_before", at->shape), *before_std = record.array("map_before_std", at->shape),
              *after = record.array("map_after", at->shape), *after_std = record.array("map_after_std", at->shape);
  if (before == nullptr || before_std == nullptr || after == nullptr || after_std == nullptr) return;
  const bool added = !record.texts("effects").empty();
  std::vector<Chart> charts;
  for (std::size_t n = 0; n < signals.size(); ++n) {
    Chart chart = view_chart(record, fmt::format("_map_{}", n + 1), "Mean of the residual over the " + signals[n],
                             with_unit(signals[n], record.text_at("map_units", n, "")));
    chart.x_title.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(chart.x_title.front())));
    Panel panel = panel_of(with_unit("Mean", before->unit), Scale::linear);
    const std::vector<double> x = row_of(*at, n);
    panel.series.push_back(viewed(x, row_of(*before, n), row_of(*before_std, n), added ? "before" : "", 1));
    if (added) panel.series.push_back(viewed(x, row_of(*after, n), row_of(*after_std, n), "after", 0));
    chart.panels.push_back(std::move(panel));
    charts.push_back(std::move(chart));
  }
  page.grid(charts,
            "Where the residual of the test record stands, over what happens in the plant; bands: two standard errors on both "
            "sides. A right model leaves nothing but zero. A step at zero velocity is friction, a bend at large values a "
            "saturation, a straight slope something linear; what the plant filters is smeared. The output, its slope, flows and "
            "stored quantities are those of the model.");
}

Chart course_chart(const Record& record, const Array& at, const Array& before, const Array& after) {
  const bool periods = record.text("course_axis") == "period", added = !record.texts("effects").empty();
  Chart chart = view_chart(record, "_course", periods ? "Residual from period to period" : "Residual from block to block",
                           periods ? "Period" : "Time [s]");
  Panel panel = panel_of(with_unit("Root mean square", before.unit), Scale::linear);
  panel.series.push_back(viewed(at.re, before.re, {}, added ? "before" : "", 1));
  if (added) panel.series.push_back(viewed(at.re, after.re, {}, "after", 0));
  if (const double noise = record.number("course_noise"); std::isfinite(noise)) panel.levels.push_back({noise, "noise"});
  chart.panels.push_back(std::move(panel));
  return chart;
}

Chart correlation_chart(const Record& record, const Array& lag, const Array& before, const Array& after) {
  const bool added = !record.texts("effects").empty();
  Chart chart = view_chart(record, "_autocorrelation", "Autocorrelation of the residual", "Lag [s]");
  Panel panel = panel_of("Correlation", Scale::exact);
  panel.range = Extent{-1.0, 1.0};
  panel.series.push_back(viewed(lag.re, before.re, {}, added ? "before" : "", 1));
  if (added) panel.series.push_back(viewed(lag.re, after.re, {}, "after", 0));
  if (const double band = record.number("autocorrelation_band"); std::isfinite(band))
    panel.levels = {{band, "95 %"}, {-band, ""}};
  chart.panels.push_back(std::move(panel));
  return chart;
}

}  // namespace

Picture draw_bars(const std::string& title, const std::vector<Bar>& bars, const std::string& unit, double width) {
  constexpr double kRow = 34.0;
  Picture picture{title, "Bars: ", width, 0.0, {}};
  double greatest = 0.0, names = 0.0;
  for (const auto& bar : bars) {
    greatest = std::max(greatest, bar.value);
    names = std::max(names, text_width(bar.name));
    picture.description += fmt::format("{} {}; ", bar.name, shown(bar.value, unit));
  }
  const double left = names + 20.0, inner = width - left - 120.0;
  for (std::size_t n = 0; n < bars.size(); ++n) {
    const double y = 8.0 + kRow * static_cast<double>(n);
    const double length = greatest > 0.0 ? inner * bars[n].value / greatest : 0.0;
    draw_text(picture.body, left - 10.0, y + 16.0, bars[n].name, Anchor::end);
    picture.body.single("rect", {{"x", left},
                                 {"y", y},
                                 {"width", std::max(length, 1.0)},
                                 {"height", 24.0},
                                 {"class", fmt::format("m{}", bars[n].colour)}});
    draw_text(picture.body, left + length + 8.0, y + 16.0, shown(bars[n].value, unit), Anchor::start, "b");
  }
  picture.height = 8.0 + kRow * static_cast<double>(bars.size());
  return picture;
}

void add_trace_residual(Page& page, const Record& record) {
  if (const Array* const frequency = axis_of(record, "frequency"); frequency != nullptr) {
    add_over_frequency(page, record, *frequency);
  } else if (const Array* const time = axis_of(record, "time"); time != nullptr) {
    add_over_time(page, record, *time);
  }
}

void add_trace_views(Page& page, const Record& record) {
  add_maps(page, record);
  std::vector<Chart> charts;
  if (const Array* const at = axis_of(record, "course_at"); at != nullptr) {
    const Array *before = record.array("course_before", at->shape), *after = record.array("course_after", at->shape);
    if (before != nullptr && after != nullptr) charts.push_back(course_chart(record, *at, *before, *after));
  }
  if (const Array* const lag = axis_of(record, "autocorrelation_lag"); lag != nullptr) {
    const Array *before = record.array("autocorrelation_before", lag->shape),
                *after = record.array("autocorrelation_after", lag->shape);
    if (before != nullptr && after != nullptr) charts.push_back(correlation_chart(record, *lag, *before, *after));
  }
  if (charts.empty()) return;
  page.grid(charts,
            "A residual that grows from one end of the test record to the other shows a drift, one that jumps a change of the "
            "plant. One lag in twenty of white noise lies outside of the band" +
                std::string(record.text("course_axis") == "period" ? "; the noise's own spectrum is taken out before." : "."));
}

void add_remedied_residual(Page& page, const Record& record) {
  const Array *frequency = axis_of(record, "frequency"), *again = axis_of(record, "remedied_at");
  if (frequency == nullptr || again == nullptr) return;
  const Array *before = record.array("residual_before", frequency->shape),
              *noise = record.array("residual_noise", frequency->shape),
              *remedied = record.array("residual_remedied", again->shape);
  if (before == nullptr || !known(noise) || remedied == nullptr) return;
  Chart chart = frequency_chart(record, "_remedied", "Residual of the model without the effect");
  Panel panel = panel_of(with_unit("All lines", before->unit), Scale::logarithmic);
  panel.height = 230.0;
  const auto marked = [&](const Array& at, const Array& level, const char* name, int colour) {
    Series series = lines_of(at, level, nullptr, kAll, name, colour);
    series.markers = true;
    series.line = false;
    return thinned(series, true);
  };
  panel.series.push_back(marked(*frequency, *before, "before", 1));
  panel.series.push_back(marked(*again, *remedied, "with the remedy", 2));
  add_noise(panel, *frequency, *noise, true);
  chart.panels.push_back(std::move(panel));
  page.figure(chart, "Nothing was fitted to the record with the remedy.");
}

}  // namespace bodeflow::tools::report
