#include "import_report.hpp"

#include <algorithm>

#include "sampling.hpp"
#include "summary.hpp"

namespace bodeflow::acquisition {
namespace {

// More columns than these are counted, not listed.
constexpr std::size_t kMostListed = 20;

std::string label(const Column& column) { return column.unit.empty() ? column.name : column.name + " [" + column.unit + "]"; }

/// "a, b" or "a, b and 5 more".
std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), kMostListed); ++i) text += (i == 0 ? "" : ", ") + names[i];
  if (names.size() > kMostListed) text += " and " + std::to_string(names.size() - kMostListed) + " more";
  return text;
}

std::string sampling_text(const TableReader& table, std::optional<std::size_t> time, RateOrigin origin) {
  const std::string rate = origin == RateOrigin::file ? "rate as the file states it" : "rate as stated";
  if (!time) return rate + ", gaps can't be seen without a time column";
  const std::string equal = "equally sampled by column '" + table.columns()[*time].header + "', no gaps";
  return origin == RateOrigin::file ? rate + ", " + equal : equal;
}

}  // namespace

ImportReport report_import(const TableReader& table, std::span<const std::size_t> selected, std::optional<std::size_t> time,
                           const TableSummary& summary) {
  const double rate = summary.rate.hz();
  ImportReport report;
  report.found = table.file() + ": " + std::to_string(summary.rows) + " rows";
  const std::int64_t all = table.columns()[selected.front()].rows;
  if (summary.first_row > 0 || (all >= 0 && summary.rows != all)) {
    report.found += " (" + std::to_string(summary.first_row + 1) + " to " + std::to_string(summary.first_row + summary.rows) +
                    (all >= 0 ? " of " + std::to_string(all) : "") + ")";
  }
  report.found += " at " + number_text(rate) + " Hz (" + short_text(static_cast<double>(summary.rows) / rate) + " s), ";
  report.found += sampling_text(table, time, summary.origin);
  for (const std::string& remark : summary.remarks) report.found += ", " + remark;
  std::vector<std::string> read, passed;
  for (std::size_t i = 0; i < selected.size(); ++i) {
    const ColumnSummary& s = summary.columns[i];
    const Column& c = table.columns()[selected[i]];
    read.push_back(label(c) + " " + short_text(s.least) + " to " + short_text(s.greatest));
    const std::string named = table.file() + ": column '" + c.header + "' ";
    if (const std::string suspicion = clipping_suspicion(s); !suspicion.empty()) report.warnings.push_back(named + suspicion);
    if (s.least == s.greatest && summary.rows > 1)
      report.warnings.push_back(named + "is constant at " + number_text(s.least) + ": was it connected?");
  }
  for (std::size_t c = 0; c < table.columns().size(); ++c) {
    if (time != c && std::find(selected.begin(), selected.end(), c) == selected.end())
      passed.push_back(label(table.columns()[c]));
  }
  for (const Leftover& l : table.leftovers()) passed.push_back(l.name + " (" + l.why.substr(0, l.why.find(';')) + ")");
  report.found += "; read " + listed(read);
  if (!passed.empty()) report.found += "; not read " + listed(passed);
  return report;
}

}  // namespace bodeflow::acquisition
