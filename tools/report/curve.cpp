#include "report/curve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "report/numbers.hpp"

namespace bodeflow::tools::report {
namespace {

constexpr std::size_t kFineBins = 2000;  ///< a curve is kept this fine until its drawing's width is known

std::string line_style(const Series& series) {
  const int dash = series.model ? 1 : series.solid ? 0 : series.colour;
  return fmt::format("l{} d{}{}", series.colour, dash, series.model ? " model" : "");
}

/// The lines in order of x, without those that have no place on the axis.
std::vector<std::size_t> ordered(const Series& series, const Axis& x) {
  std::vector<std::size_t> lines;
  lines.reserve(series.x.size());
  for (std::size_t k = 0; k < series.x.size(); ++k)
    if (std::isfinite(x.place(series.x[k]))) lines.push_back(k);
  const auto before = [&](std::size_t a, std::size_t b) { return series.x[a] < series.x[b]; };
  if (!std::is_sorted(lines.begin(), lines.end(), before)) std::stable_sort(lines.begin(), lines.end(), before);
  return lines;
}

/// What tells one bin of lines: first, last, least and greatest, in order.
void add_bin(std::vector<std::size_t>& kept, const Series& series, std::span<const std::size_t> bin) {
  const auto& low = series.low.empty() ? series.y : series.low;
  const auto& high = series.high.empty() ? series.y : series.high;
  std::vector<std::size_t> telling{0, bin.size() - 1};
  std::size_t least = 0, greatest = 0;
  for (std::size_t i = 0; i < bin.size(); ++i) {
    if (low[bin[i]] < low[bin[least]] || std::isnan(low[bin[least]])) least = i;
    if (high[bin[i]] > high[bin[greatest]] || std::isnan(high[bin[greatest]])) greatest = i;
  }
  telling.push_back(least);
  telling.push_back(greatest);
  std::sort(telling.begin(), telling.end());
  telling.erase(std::unique(telling.begin(), telling.end()), telling.end());
  for (const std::size_t i : telling) kept.push_back(bin[i]);
}

void draw_band(Markup& body, const Frame& frame, const Series& series, std::span<const std::size_t> lines) {
  std::string d;
  const auto close = [&](std::size_t from, std::size_t to) {
    if (from == to) return;
    // One line alone still needs a width to be seen
    const double half = to - from == 1 ? 1.0 : 0.0;
    std::string upper, lower;
    for (std::size_t i = from; i < to; ++i) {
      const double x = std::clamp(frame.px(series.x[lines[i]]), frame.left, frame.left + frame.width);
      const std::string top = coordinate(frame.py(series.high[lines[i]])), bottom = coordinate(frame.py(series.low[lines[i]]));
      upper += fmt::format("{}{} {}", upper.empty() ? "M" : "L", coordinate(x - half), top);
      lower = fmt::format("L{} {}", coordinate(x - half), bottom) + lower;
      if (half > 0.0) {
        upper += fmt::format("L{} {}", coordinate(x + half), top);
        lower = fmt::format("L{} {}", coordinate(x + half), bottom) + lower;
      }
    }
    d += upper + lower + "Z";
  };
  std::size_t from = 0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (!std::isnan(series.low[lines[i]]) && !std::isnan(series.high[lines[i]])) continue;
    close(from, i);
    from = i + 1;
  }
  close(from, lines.size());
  if (!d.empty()) body.single("path", {{"d", d}, {"class", fmt::format("a{}", series.colour)}});
  if (series.envelope && !d.empty()) body.single("path", {{"d", d}, {"class", fmt::format("l{} thin", series.colour)}});
}

void draw_line_of(Markup& body, const Frame& frame, const Series& series, std::span<const std::size_t> lines) {
  std::string d;
  bool pen_down = false;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const double y = frame.py(series.y[lines[i]]);
    if (!std::isfinite(y)) {
      pen_down = false;
      continue;
    }
    const double x = frame.px(series.x[lines[i]]);
    d += fmt::format("{}{} {}", pen_down ? "L" : "M", coordinate(x), coordinate(y));
    const bool alone = !pen_down && (i + 1 == lines.size() || !std::isfinite(frame.py(series.y[lines[i + 1]])));
    if (alone) draw_marker(body, x, y, series.colour, 2.0);
    pen_down = true;
  }
  if (!d.empty()) body.single("path", {{"d", d}, {"class", line_style(series)}});
}

}  // namespace

double Frame::px(double value) const { return left + width * x->place(value); }

double Frame::py(double value) const {
  const double place = y->place(value);
  if (std::isnan(value)) return kNaN;
  // On a logarithmic axis zero and less lie below every value
  return top + height * (1.0 - std::clamp(std::isnan(place) ? 0.0 : place, 0.0, 1.0));
}

std::vector<std::size_t> telling_points(const Series& series, const Axis& x, std::size_t bins) {
  const std::vector<std::size_t> lines = ordered(series, x);
  if (lines.size() <= 4 * bins) return lines;
  std::vector<std::size_t> kept;
  const auto bin_of = [&](std::size_t line) { return std::floor(x.place(series.x[line]) * static_cast<double>(bins)); };
  for (std::size_t from = 0; from < lines.size();) {
    std::size_t to = from + 1;
    while (to < lines.size() && bin_of(lines[to]) == bin_of(lines[from])) ++to;
    add_bin(kept, series, std::span(lines).subspan(from, to - from));
    from = to;
  }
  return kept;
}

Series thinned(const Series& series, bool logarithmic) {
  Extent extent;
  extent.add(series.x, logarithmic);
  if (extent.empty()) return series;
  Axis axis;
  axis.scale = logarithmic ? Scale::logarithmic : Scale::exact;
  axis.low = extent.low;
  axis.high = extent.high > extent.low ? extent.high : extent.low * 2.0 + 1.0;
  const auto kept = telling_points(series, axis, kFineBins);
  if (kept.size() == series.x.size()) return series;
  Series few = series;
  const auto take = [&](const std::vector<double>& from, std::vector<double>& to) {
    if (from.empty()) return;
    to.clear();
    for (const std::size_t k : kept) to.push_back(from[k]);
  };
  take(series.x, few.x);
  take(series.y, few.y);
  take(series.low, few.low);
  take(series.high, few.high);
  return few;
}

void draw_series(Markup& body, const Frame& frame, const Series& series) {
  const auto lines = telling_points(series, *frame.x, static_cast<std::size_t>(frame.width / 2.0));
  if (!series.low.empty()) draw_band(body, frame, series, lines);
  if (series.line && !series.envelope) draw_line_of(body, frame, series, lines);
  if (!series.markers) return;
  for (const std::size_t k : lines) {
    const double y = frame.py(series.y[k]);
    if (std::isfinite(y)) draw_marker(body, frame.px(series.x[k]), y, series.colour, lines.size() > kMostMarkers ? 1.8 : 2.6);
  }
}

void draw_frame(Markup& body, const Frame& frame, bool x_labels) {
  const double right = frame.left + frame.width, bottom = frame.top + frame.height;
  for (const double value : frame.x->minor) draw_line(body, frame.px(value), frame.top, frame.px(value), bottom, "minor");
  for (const double value : frame.y->minor) draw_line(body, frame.left, frame.py(value), right, frame.py(value), "minor");
  for (const auto& tick : frame.x->ticks) draw_line(body, frame.px(tick.value), frame.top, frame.px(tick.value), bottom, "grid");
  for (const auto& tick : frame.y->ticks) {
    draw_line(body, frame.left, frame.py(tick.value), right, frame.py(tick.value), "grid");
    draw_text(body, frame.left - 7.0, frame.py(tick.value) + 4.0, tick.label, Anchor::end, "q");
  }
  body.single("rect",
              {{"x", frame.left}, {"y", frame.top}, {"width", frame.width}, {"height", frame.height}, {"class", "frame"}});
  if (!x_labels) return;
  double free_from = -1e9;
  for (const auto& tick : frame.x->ticks) {
    const double x = frame.px(tick.value), half = 0.5 * text_width(tick.label, 11.0);
    if (x - half < free_from) continue;
    draw_text(body, x, bottom + 17.0, tick.label, Anchor::middle, "q");
    free_from = x + half + 9.0;
  }
}

void draw_sample(Markup& body, double x, double y, const Series& series) {
  const bool band = !series.low.empty();
  if (band)
    body.single("rect",
                {{"x", x}, {"y", y - 5.0}, {"width", 26.0}, {"height", 10.0}, {"class", fmt::format("a{}", series.colour)}});
  if (series.line) draw_line(body, x, y, x + 26.0, y, line_style(series).c_str());
  if (series.markers) draw_marker(body, x + 13.0, y, series.colour, 2.6);
}

}  // namespace bodeflow::tools::report
