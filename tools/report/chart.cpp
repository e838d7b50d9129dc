#include "report/chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/curve.hpp"
#include "report/numbers.hpp"

namespace bodeflow::tools::report {
namespace {

constexpr double kTitleRoom = 24.0;  ///< of an upright axis title
constexpr double kGap = 16.0;        ///< between panels
constexpr double kLegendRow = 20.0;
constexpr double kBottom = 44.0;  ///< labels and title of the horizontal axis

/// What the vertical axis must show: of bands at most a fifth of the curves' own span beyond them, or 20 dB.
Extent shown_extent(const Panel& panel) {
  const bool positive = panel.y.scale == Scale::logarithmic;
  Extent curves, all;
  for (const auto& series : panel.series) {
    if (!series.envelope) curves.add(series.y, positive);
    if (series.envelope || curves.empty()) {
      all.add(series.low, positive);
      all.add(series.high, positive);
    }
  }
  if (curves.empty()) curves = all;
  if (curves.empty()) return positive ? Extent{0.1, 1.0} : Extent{0.0, 1.0};
  double room = 0.35 * (curves.high - curves.low);
  if (panel.y.scale == Scale::decibel) room = std::max(room, 10.0);
  if (panel.y.scale == Scale::degrees) room = std::max(room, 10.0);
  Extent shown = curves;
  for (const auto& series : panel.series) {
    if (series.envelope || positive) continue;
    for (std::size_t k = 0; k < series.low.size(); ++k) {
      if (std::isfinite(series.low[k])) shown.add(std::max(series.low[k], curves.low - room));
      if (std::isfinite(series.high[k])) shown.add(std::min(series.high[k], curves.high + room));
    }
  }
  if (!all.empty()) {
    shown.add(all.low);
    shown.add(all.high);
  }
  for (const auto& level : panel.levels) shown.add(level.y, positive);
  return shown;
}

/// A little room, so that no curve runs along the frame.
void add_room(Extent& extent, Scale scale) {
  if (scale == Scale::logarithmic) {
    const double factor = std::pow(extent.high / extent.low, 0.04);
    if (!std::isfinite(factor)) return;
    extent.low /= factor;
    extent.high *= factor;
    return;
  }
  const double room = 0.025 * (extent.high - extent.low);
  extent.low -= room;
  extent.high += room;
}

Axis vertical_axis(const Panel& panel, double height) {
  Extent extent = panel.range ? *panel.range : shown_extent(panel);
  if (!panel.range) add_room(extent, panel.y.scale);
  return make_axis(panel.y.scale, extent.low, extent.high, static_cast<int>(height / 42.0), panel.y.title);
}

Axis horizontal_axis(const Chart& chart, double width) {
  Extent extent;
  for (const auto& panel : chart.panels)
    for (const auto& series : panel.series) extent.add(series.x, chart.x_logarithmic);
  if (extent.empty()) extent = {chart.x_logarithmic ? 0.1 : 0.0, 1.0};
  return make_axis(chart.x_logarithmic ? Scale::logarithmic : Scale::exact, extent.low, extent.high,
                   static_cast<int>(width / 62.0), chart.x_title);
}

/// Absolute values of a decibel axis at powers of ten, empty where fewer than two fit.
std::vector<Tick> absolute_ticks(const Axis& axis) {
  std::vector<Tick> ticks;
  const int low = static_cast<int>(std::ceil(axis.low / 20.0 - 1e-9)),
            high = static_cast<int>(std::floor(axis.high / 20.0 + 1e-9));
  const int every = std::max(1, (high - low) / 6);
  for (int exponent = low; exponent <= high && exponent - low < 1000; exponent += every)
    ticks.push_back(
        {20.0 * exponent, exponent >= -3 && exponent <= 4 ? shown(std::pow(10.0, exponent)) : power_of_ten(exponent)});
  return ticks.size() < 2 ? std::vector<Tick>{} : ticks;
}

/// Series of the legend: one a name.
std::vector<const Series*> legend_of(const Chart& chart) {
  std::vector<const Series*> legend;
  for (const auto& panel : chart.panels)
    for (const auto& series : panel.series) {
      const bool known = std::any_of(legend.begin(), legend.end(), [&](const Series* s) { return s->name == series.name; });
      if (!series.name.empty() && !known) legend.push_back(&series);
    }
  return legend;
}

/// Draws the legend in rows from `top` and gives the height that it takes.
double draw_legend(Markup& body, const Chart& chart, double left, double width) {
  const auto legend = legend_of(chart);
  if (legend.empty()) return 0.0;
  double x = left, y = 12.0;
  for (const Series* series : legend) {
    const auto most = static_cast<std::size_t>((width - 40.0) / text_width("m"));
    const std::string name = shortened(series->name, std::max<std::size_t>(most, 4));
    const double needed = 34.0 + text_width(name) + 16.0;
    if (x > left && x + needed > left + width) {
      x = left;
      y += kLegendRow;
    }
    draw_sample(body, x, y, *series);
    draw_text(body, x + 33.0, y + 4.0, name);
    x += needed;
  }
  return y + 14.0;
}

struct Layout {
  double left = 0.0;
  double right = 0.0;  ///< room at the right
  std::vector<Axis> y;
  std::vector<std::vector<Tick>> absolute;
  std::vector<double> heights;
};

Layout layout_of(const Chart& chart, double width) {
  Layout layout;
  double labels = 0.0, absolute = 0.0;
  for (const auto& panel : chart.panels) {
    layout.heights.push_back(width >= kWide ? panel.height : std::round(panel.height * 0.8));
    layout.y.push_back(vertical_axis(panel, layout.heights.back()));
    layout.absolute.push_back(panel.absolute && width >= kWide ? absolute_ticks(layout.y.back()) : std::vector<Tick>{});
    for (const auto& tick : layout.y.back().ticks) labels = std::max(labels, text_width(tick.label, 11.0));
    for (const auto& tick : layout.absolute.back()) absolute = std::max(absolute, text_width(tick.label, 11.0));
  }
  layout.left = kTitleRoom + labels + 10.0;
  layout.right = absolute > 0.0 ? absolute + 14.0 : 16.0;
  return layout;
}

void draw_levels(Markup& body, const Frame& frame, const std::vector<Level>& levels) {
  for (const auto& level : levels) {
    const double y = frame.py(level.y);
    draw_line(body, frame.left, y, frame.left + frame.width, y, "mark");
    draw_text(body, frame.left + frame.width - 6.0, y - 5.0, level.label, Anchor::end, "q halo");
  }
}

}  // namespace

bool is_logarithmic(const std::vector<double>& frequency) {
  Extent extent;
  extent.add(frequency, true);
  return !extent.empty() && extent.high / extent.low >= 4.0;
}

Picture draw_chart(const Chart& chart, double width) {
  Picture picture{chart.title, chart.description, width, 0.0, {}};
  const Layout layout = layout_of(chart, width);
  const double inner = width - layout.left - layout.right;
  const Axis x = horizontal_axis(chart, inner);
  double top = draw_legend(picture.body, chart, layout.left, inner) + 6.0;
  for (std::size_t p = 0; p < chart.panels.size(); ++p) {
    const Panel& panel = chart.panels[p];
    const Frame frame{layout.left, top, inner, layout.heights[p], &x, &layout.y[p]};
    const bool last = p + 1 == chart.panels.size();
    draw_frame(picture.body, frame, last);
    for (const auto& tick : layout.absolute[p])
      draw_text(picture.body, frame.left + inner + 7.0, frame.py(tick.value) + 4.0, tick.label, Anchor::start, "q");
    for (const auto& series : panel.series) draw_series(picture.body, frame, series);
    draw_levels(picture.body, frame, panel.levels);
    const auto most = static_cast<std::size_t>(frame.height / text_width("m"));
    draw_upright_text(picture.body, 13.0, top + 0.5 * frame.height, shortened(panel.y.title, std::max<std::size_t>(most, 6)));
    top += frame.height + (last ? 0.0 : kGap);
  }
  draw_text(picture.body, layout.left + 0.5 * inner, top + 36.0, x.title, Anchor::middle);
  picture.height = top + kBottom;
  return picture;
}

}  // namespace bodeflow::tools::report
