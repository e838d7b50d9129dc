#include "overlooked_time.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "sampling.hpp"

namespace bodeflow::acquisition {
namespace {

constexpr std::size_t kBlock = 4096;
// Fewer values often rise by chance.
constexpr std::int64_t kFewest = 5;

/// A column that rises in every row.
struct Rise {
  Sampling times;         // up to where the steps are no more equal
  std::string irregular;  // where and why they are not; "" where they are
  double resolution_s = 0.0;
};

/// The column's rise over the part, or nothing where it does not rise or can't be read.
std::optional<Rise> rise_of(TableReader& table, std::size_t column, double seconds, const TableSummary& part) {
  const std::array selected = {column};
  if (!table.start(selected, part.first_row)) return std::nullopt;
  std::vector<double> values(kBlock);
  const std::array to = {values.data()};
  Rise rise;
  double last = -std::numeric_limits<double>::infinity();
  for (std::int64_t left = part.rows; left > 0;) {
    const auto got = table.read(to, static_cast<std::size_t>(std::min<std::int64_t>(left, kBlock)));
    if (!got || *got == 0) return std::nullopt;
    for (std::size_t n = 0; n < *got; ++n) {
      const double time = values[n] * seconds;
      if (!(time > last) || !std::isfinite(time)) return std::nullopt;
      last = time;
      if (!rise.irregular.empty()) continue;
      if (const auto wrong = rise.times.add(time)) rise.irregular = table.place(n) + ": " + *wrong;
    }
    left -= static_cast<std::int64_t>(*got);
  }
  rise.resolution_s = table.resolution() * seconds;
  return rise;
}

/// What contradicts in a column, or "".
std::string contradiction(const Rise& rise, double seconds, const std::string& unit, const TableSummary& summary) {
  if (!rise.irregular.empty())
    return "rises as time does, but not in equal steps (" + rise.irregular + "): if it holds time, name it with time_column";
  const Rate found = rise.times.rate(rise.resolution_s);
  if (!found.known() || rise.times.agrees_with(summary.rate.hz())) return "";
  const bool stated = summary.origin == RateOrigin::stated;
  return "steps by " + short_text(1.0 / (found.hz() * seconds)) + " " + unit + " (" + number_text(found.hz()) + " Hz), but " +
         (stated ? "rate is " : "the file states ") + number_text(summary.rate.hz()) +
         " Hz: " + (stated ? "name it with time_column, or correct rate" : "if it holds time, name it with time_column");
}

}  // namespace

std::vector<std::string> overlooked_times(TableReader& table, std::span<const std::size_t> selected,
                                          const TableSummary& summary) {
  std::vector<std::string> warnings;
  if (summary.rows < kFewest) return warnings;
  const auto& columns = table.columns();
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const auto seconds = seconds_per(columns[c].unit);
    if (!seconds || columns[c].rows != columns[selected.front()].rows) continue;
    const auto rise = rise_of(table, c, *seconds, summary);
    const std::string why = rise ? contradiction(*rise, *seconds, columns[c].unit, summary) : "";
    if (!why.empty()) warnings.push_back(table.file() + ": column '" + columns[c].header + "' " + why);
  }
  return warnings;
}

}  // namespace bodeflow::acquisition
