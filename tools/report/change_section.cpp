#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/numbers.hpp"
#include "report/sections.hpp"

namespace bodeflow::tools::report {
namespace {

constexpr std::size_t kMostEntries = 9;  ///< drawn
constexpr std::size_t kMostRows = 60;

/// The record, with the sizes that its arrays must have.
struct ChangeRecord {
  const Record& record;
  std::vector<std::string> entries;
  std::size_t lines = 0, bands = 0;

  const Array* matrix(const char* name, std::size_t rows, std::size_t columns, bool complex = false) const {
    return record.array(name, {rows, columns}, complex);
  }
  double band(const char* name, std::size_t entry, std::size_t b) const {
    const Array* array = matrix(name, entries.size(), bands);
    return array == nullptr ? kNaN : array->re[entry * bands + b];
  }
  double mode(const std::string& name, std::size_t m) const {
    const Array* array = record.array(name);
    return array == nullptr || m >= array->size() ? kNaN : array->re[m];
  }
};

std::string probability_text(double p) { return !std::isfinite(p) ? "–" : p < 1e-4 ? "below 0.01 %" : percent(p); }

Series curve(const std::string& name, int colour, const std::vector<double>& x, std::vector<double> y) {
  Series series;
  series.name = name;
  series.colour = colour;
  series.x = x;
  series.y = std::move(y);
  return series;
}

/// Magnitudes before and after, and below the change beside what the errors of both leave.
void add_spectrum(Page& page, const ChangeRecord& c, std::size_t entry) {
  const Array* frequency = c.record.array("frequency", {c.lines});
  const std::size_t count = c.entries.size();
  const Array *before = c.matrix("before", c.lines, count, true), *after = c.matrix("after", c.lines, count, true),
              *deviation = c.matrix("change_deviation", c.lines, count);
  if (frequency == nullptr || before == nullptr || after == nullptr || deviation == nullptr) return;
  std::vector<double> first, second, change, errors;
  for (std::size_t k = 0; k < c.lines; ++k) {
    const std::size_t at = k * count + entry;
    const auto level = [](double size) { return size > 0.0 ? decibel(size) : kNaN; };
    first.push_back(level(std::abs(before->at(at))));
    second.push_back(level(std::abs(after->at(at))));
    change.push_back(level(std::abs(after->at(at) - before->at(at))));
    errors.push_back(level(deviation->re[at]));
  }
  const bool logarithmic = is_logarithmic(frequency->re);
  Chart chart;
  chart.title = c.entries[entry];
  chart.name = fmt::format("{}_change_{}", c.record.key, entry + 1);
  chart.description = "Magnitude before and after over frequency; below, the change and the standard deviation of its errors.";
  chart.x_title = "Frequency [Hz]";
  chart.x_logarithmic = logarithmic;
  Panel upper, lower;
  upper.y = {Scale::decibel, 0, 1, {}, {}, with_unit("Magnitude", before->unit.empty() ? "dB" : "dB re 1 " + before->unit)};
  upper.height = 260.0;
  upper.series.push_back(thinned(curve("before", 0, frequency->re, first), logarithmic));
  upper.series.push_back(thinned(curve("after", 1, frequency->re, second), logarithmic));
  lower.y = {Scale::decibel, 0, 1, {}, {}, "Change [dB]"};
  lower.height = 200.0;
  lower.series.push_back(thinned(curve("change", 2, frequency->re, change), logarithmic));
  if (std::any_of(errors.begin(), errors.end(), [](double v) { return std::isfinite(v); }))
    lower.series.push_back(thinned(curve("its standard deviation", 5, frequency->re, errors), logarithmic));
  chart.panels.push_back(std::move(upper));
  chart.panels.push_back(std::move(lower));
  page.figure(chart);
}

void add_bands(Page& page, const ChangeRecord& c, std::size_t entry) {
  const Array *low = c.record.array("band_low", {c.bands}), *high = c.record.array("band_high", {c.bands});
  if (low == nullptr || high == nullptr) return;
  Table table{"Bands of " + c.entries[entry],
              {{"From [Hz]"},
               {"To [Hz]"},
               {"Change"},
               {"By chance"},
               {"Would be found"},
               {"Correlation"},
               {"Factor"},
               {"Verdict", false}},
              {}};
  for (std::size_t b = 0; b < std::min(c.bands, kMostRows); ++b)
    table.rows.push_back({shown(low->re[b]), shown(high->re[b]), percent(c.band("band_change", entry, b)),
                          probability_text(c.band("band_probability", entry, b)),
                          std::isfinite(c.band("band_detectable", entry, b)) ? percent(c.band("band_detectable", entry, b)) : "–",
                          shown(c.band("band_correlation", entry, b), 6), shown(c.band("band_factor", entry, b), 3),
                          c.record.text_at("band_verdicts", entry * c.bands + b, "–")});
  add_table(page.body(), table);
}

void add_modes(Page& page, const ChangeRecord& c) {
  const auto status = c.record.texts("mode_status");
  if (status.empty() || c.record.array("mode_entry", {status.size()}) == nullptr) return;
  Table table{
      "Resonances",
      {{"Response", false}, {"", false}, {"Before [Hz]"}, {"After [Hz]"}, {"Shift"}, {"± (95 %)"}, {"Damping before"}, {"after"}},
      {}};
  for (std::size_t m = 0; m < std::min(status.size(), kMostRows); ++m) {
    const auto entry = static_cast<std::size_t>(c.mode("mode_entry", m));
    const double shift = c.mode("mode_frequency_shift", m), deviation = c.mode("mode_frequency_shift_deviation", m);
    table.rows.push_back({entry < c.entries.size() ? c.entries[entry] : "–", status[m],
                          shown(c.mode("mode_frequency_before", m), 6), shown(c.mode("mode_frequency_after", m), 6),
                          std::isfinite(shift) ? percent(shift) : "–",
                          std::isfinite(deviation) ? shown(196.0 * deviation, 2) + " %" : "–",
                          shown(c.mode("mode_damping_before", m), 3), shown(c.mode("mode_damping_after", m), 3)});
  }
  page.heading("Resonances of models of both responses");
  add_table(page.body(), table);
  page.paragraph(
      "Moved: the poles differ by more than their covariances, and the response has changed around them. New, vanished: without "
      "partner, and the response has changed there. Undecided: the models differ where the responses do not. If the stiffness of "
      "a "
      "mode is as before, its mass has changed by (f before / f after)².");
}

std::string factors_text(const ChangeRecord& c, std::size_t entry) {
  const Array* factors = c.matrix("dl_911_factors", c.entries.size(), 3);
  const std::string degree = c.record.text_at("dl_911", entry, "");
  if (factors == nullptr || degree.empty()) return "";
  return fmt::format(" By DL/T 911: deformation {}, factors {}, {}, {} (low, medium, high band).", degree,
                     shown(factors->re[entry * 3], 3), shown(factors->re[entry * 3 + 1], 3),
                     shown(factors->re[entry * 3 + 2], 3));
}

}  // namespace

bool add_change(Page& page, const Record& record) {
  const Array *frequency = record.array("frequency"), *low = record.array("band_low");
  if (frequency == nullptr || low == nullptr) return false;
  const ChangeRecord c{record, record.texts("entries"), frequency->size(), low->size()};
  if (c.entries.empty() || c.matrix("band_change", c.entries.size(), c.bands) == nullptr) return false;
  page.paragraph("Verdict: " + record.text("conclusion") + ".");
  page.paragraph("Scatter of repeat tests: " + record.text("scatter") + ".");
  if (c.entries.size() > kMostEntries)
    page.note(fmt::format("{} of {} responses are drawn; all stand in result.json.", kMostEntries, c.entries.size()));
  for (std::size_t i = 0; i < std::min(kMostEntries, c.entries.size()); ++i) {
    page.heading(fmt::format("{}: {}", c.entries[i], record.text_at("entry_verdicts", i, "")));
    add_spectrum(page, c, i);
    add_bands(page, c, i);
    const Array* correlation = record.array("correlation", {c.entries.size()});
    const Array* factor = record.array("factor", {c.entries.size()});
    if (correlation != nullptr && factor != nullptr)
      page.paragraph(fmt::format("Of the magnitudes in dB over all lines: correlation {}, factor −lg(1 − ρ) = {}.{}",
                                 shown(correlation->re[i], 6), shown(factor->re[i], 3), factors_text(c, i)));
  }
  add_modes(page, c);
  page.paragraph(fmt::format(
      "By chance: the probability of as much change where nothing has changed; a band has changed where all bands "
      "together keep a confidence of {}. Would be found: the relative change of the whole band that is found with 95 %.",
      percent(record.number("confidence"))));
  return true;
}

}  // namespace bodeflow::tools::report
