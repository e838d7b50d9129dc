#include <fmt/format.h>

#include <algorithm>

#include "console/columns.hpp"
#include "console/console.hpp"
#include "console/model_summary.hpp"
#include "console/record_values.hpp"

namespace bodeflow::tools {
namespace {

constexpr std::size_t kMostRows = 30;

std::string chance(double p) { return std::isnan(p) ? "-" : p < 1e-12 ? "< 1e-12" : fmt::format("{:.2g}", p); }

void print_bands(const Json& record, std::size_t entry, std::size_t bands) {
  const Values low = values(record, "band_low"), high = values(record, "band_high"), change = values(record, "band_change"),
               probability = values(record, "band_probability"), detectable = values(record, "band_detectable"),
               factor = values(record, "band_factor");
  fmt::print("  {}\n", dim(fmt::format("{:>10} {:>10} {:>11} {:>9} {:>14} {:>8}  {}", "from [Hz]", "to [Hz]", "change [%]",
                                       "chance", "would see [%]", "factor", "verdict")));
  for (std::size_t b = 0; b < std::min(bands, kMostRows); ++b)
    fmt::print("  {} {} {} {:>9} {} {}  {}\n", cell(low.at(b), 10, 4), cell(high.at(b), 10, 4),
               cell(100.0 * change.at(entry, b), 11, 3), chance(probability.at(entry, b)),
               cell(100.0 * detectable.at(entry, b), 14, 2), cell(factor.at(entry, b), 8, 3),
               text_at(attribute(record, "band_verdicts"), entry * bands + b));
}

std::string shift_text(double shift, double deviation, double scale) {
  if (!std::isfinite(shift)) return "-";
  return fmt::format("{:+.3g} ± {:.2g}", scale * shift, scale * 1.96 * deviation);
}

void print_modes(const Json& record, std::size_t entry) {
  const Values of = values(record, "mode_entry");
  if (std::find(of.data.begin(), of.data.end(), static_cast<double>(entry)) == of.data.end()) return;
  const Values before = values(record, "mode_frequency_before"), after = values(record, "mode_frequency_after"),
               shift = values(record, "mode_frequency_shift"), deviation = values(record, "mode_frequency_shift_deviation"),
               damping = values(record, "mode_damping_before"), damping_after = values(record, "mode_damping_after");
  fmt::print("  {}\n", dim(fmt::format("{:<10} {:>11} {:>11} {:>19} {:>9} {:>9}", "mode", "before [Hz]", "after [Hz]",
                                       "shift [%], 95 %", "damping", "after")));
  std::size_t shown = 0;
  for (std::size_t m = 0; m < of.data.size() && shown < kMostRows; ++m) {
    if (of.data[m] != static_cast<double>(entry)) continue;
    ++shown;
    fmt::print("  {:<10} {} {} {:>19} {} {}\n", text_at(attribute(record, "mode_status"), m), cell(before.at(m), 11, 5),
               cell(after.at(m), 11, 5), shift_text(shift.at(m), deviation.at(m), 100.0), cell(damping.at(m), 9, 3),
               cell(damping_after.at(m), 9, 3));
  }
}

}  // namespace

bool print_change(const Json& record) {
  const Json& entries = attribute(record, "entries");
  const std::size_t bands = values(record, "band_low").data.size();
  if (!entries.is_array() || entries.empty() || bands == 0) return false;
  fmt::print("  {}\n  scatter of repeat tests: {}\n", bold(text(attribute(record, "conclusion"))),
             text(attribute(record, "scatter")));
  const Values correlation = values(record, "correlation"), factor = values(record, "factor");
  for (std::size_t i = 0; i < entries.size(); ++i) {
    fmt::print("  {}: {}; correlation {:.6g}, factor {:.3g}{}\n", text(entries[i]),
               text_at(attribute(record, "entry_verdicts"), i), correlation.at(i), factor.at(i), [&] {
                 const std::string degree = text_at(attribute(record, "dl_911"), i);
                 return degree.empty() ? "" : "; deformation by DL/T 911: " + degree;
               }());
    print_bands(record, i, bands);
    print_modes(record, i);
  }
  return true;
}

}  // namespace bodeflow::tools
