#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <optional>

#include "report/numbers.hpp"
#include "report/sections.hpp"

namespace bodeflow::tools::report {
namespace {

constexpr std::size_t kMostFilters = 16;  ///< of a bank that are drawn; the rest stands in result.json
constexpr std::size_t kFewFilters = 4;    ///< whose phases and impulse responses can still be told apart
constexpr double kLeastDecibel = -120.0;  ///< below, the curve is left out: zeros would fill the drawing

struct Curves {
  const Array* frequency = nullptr;
  const Array* response = nullptr;
  const Array* time = nullptr;
  const Array* impulse = nullptr;
  std::vector<std::string> names;

  std::size_t filters() const { return names.size(); }
};

std::optional<Curves> read_curves(const Record& record) {
  Curves c;
  c.names = record.texts("names");
  c.frequency = record.array("frequency");
  c.time = record.array("time");
  if (c.names.empty() || c.frequency == nullptr || c.time == nullptr || c.frequency->size() == 0) return std::nullopt;
  c.response = record.array("response", {c.frequency->size(), c.filters()}, true);
  c.impulse = record.array("impulse", {c.time->size(), c.filters()});
  if (c.response == nullptr || c.impulse == nullptr) return std::nullopt;
  return c;
}

Series named(const Curves& c, std::size_t filter, const std::vector<double>& x) {
  Series series;
  if (c.filters() > 1) series.name = c.names[filter];
  series.x = x;
  series.colour = static_cast<int>(filter) % kColours;
  series.solid = c.filters() == 1;
  return series;
}

Chart response_chart(const Record& record, const Curves& c) {
  Chart chart;
  chart.name = record.key + "_response";
  chart.title = "Frequency response";
  chart.description = "Magnitude and phase of the filter as it was configured, up to the Nyquist frequency.";
  chart.x_title = "Frequency [Hz]";
  chart.x_logarithmic = true;
  Panel magnitude, phase;
  magnitude.y.scale = Scale::decibel;
  magnitude.y.title = "Magnitude [dB]";
  magnitude.height = 280.0;
  phase.y.scale = Scale::degrees;
  phase.y.title = "Phase [deg]";
  for (std::size_t i = 0; i < std::min(c.filters(), kMostFilters); ++i) {
    Series gain = named(c, i, c.frequency->re), turn = gain;
    std::vector<double> degrees;
    std::vector<bool> trusted;
    for (std::size_t k = 0; k < c.frequency->size(); ++k) {
      const std::complex<double> h = c.response->at(k * c.filters() + i);
      gain.y.push_back(decibel(std::abs(h)) > kLeastDecibel ? decibel(std::abs(h)) : kNaN);
      degrees.push_back(std::arg(h) * 180.0 / std::numbers::pi);
      trusted.push_back(decibel(std::abs(h)) > kLeastDecibel);
    }
    turn.y = unwrapped(degrees, trusted);
    magnitude.series.push_back(thinned(gain, true));
    phase.series.push_back(thinned(turn, true));
  }
  chart.panels.push_back(std::move(magnitude));
  if (c.filters() <= kFewFilters) chart.panels.push_back(std::move(phase));
  return chart;
}

Chart impulse_chart(const Record& record, const Curves& c) {
  Chart chart;
  chart.name = record.key + "_impulse";
  chart.title = "Impulse response";
  chart.description =
      "What comes out for a sample of 1 followed by zeros, until it stays below a ten-thousandth of its largest value.";
  chart.x_title = "Time [s]";
  Panel panel;
  panel.height = 220.0;
  panel.y.title = "Impulse response";
  for (std::size_t i = 0; i < std::min(c.filters(), kFewFilters); ++i) {
    Series series = named(c, i, c.time->re);
    for (std::size_t n = 0; n < c.time->size(); ++n) series.y.push_back(c.impulse->re[n * c.filters() + i]);
    panel.series.push_back(thinned(series, false));
  }
  chart.panels.push_back(std::move(panel));
  return chart;
}

/// Of each filter: its largest gain and where, and the band within 3 dB of it.
Table figures(const Curves& c) {
  Table table{"Filters", {{"Filter", false}, {"Largest gain"}, {"at [Hz]"}, {"-3 dB from [Hz]"}, {"to [Hz]"}}, {}};
  const auto& f = c.frequency->re;
  for (std::size_t i = 0; i < std::min(c.filters(), kMostFilters); ++i) {
    const auto gain = [&](std::size_t k) { return std::abs(c.response->at(k * c.filters() + i)); };
    std::size_t top = 0;
    for (std::size_t k = 1; k < f.size(); ++k)
      if (gain(k) > gain(top)) top = k;
    const double half = gain(top) * std::sqrt(0.5);
    std::size_t low = top, high = top;
    while (low > 0 && gain(low - 1) >= half) --low;
    while (high + 1 < f.size() && gain(high + 1) >= half) ++high;
    table.rows.push_back({c.names[i], shown(gain(top)), shown(f[top], 4), low == 0 ? "0" : shown(f[low], 4),
                          high + 1 == f.size() ? "Nyquist" : shown(f[high], 4)});
  }
  return table;
}

}  // namespace

bool add_filter(Page& page, const Record& record) {
  const auto curves = read_curves(record);
  if (!curves) return false;
  add_attributes(page, record, {"names"});
  page.figure(response_chart(record, *curves));
  page.figure(impulse_chart(record, *curves));
  add_table(page.body(), figures(*curves));
  if (curves->filters() > kFewFilters)
    page.paragraph(fmt::format("Phases are left out and {} impulse responses drawn of {}: result.json has all.", kFewFilters,
                               counted(curves->filters())));
  return true;
}

}  // namespace bodeflow::tools::report
