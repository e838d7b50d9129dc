#pragma once

#include "table.hpp"

namespace bodeflow::acquisition {

/// What one selected column holds.
struct ColumnSummary {
  double least = 0.0;
  double greatest = 0.0;
  /// Runs of at least three equal samples at the least or the greatest value. Three runs or more suggest clipping.
  std::int64_t runs_at_least = 0;
  std::int64_t runs_at_greatest = 0;
  bool between = false;  ///< there are values between the least and the greatest
};

/// How the rows stand in time.
struct Timing {
  std::optional<double> rate_hz;    ///< stated by the user
  bool ignore_time_column = false;  ///< the stated rate holds, whatever the file says
  std::string time_column;          ///< its name, where it is not found by itself; "" otherwise
  std::string time_unit;            ///< of a time column that has no unit; "" otherwise
};

/// The part of the rows that is used: by rows, or by time [s], that of the time column or else from the first row on.
struct Part {
  std::int64_t start = 0;             ///< rows left out before
  std::optional<std::int64_t> count;  ///< rows used; without it all that follow
  std::optional<double> from_s, to_s;

  bool by_time() const { return from_s || to_s; }
  bool whole() const { return start == 0 && !count && !by_time(); }
};

/// Where a rate comes from.
enum class RateOrigin { time_column, file, stated };

/// What a scan found.
struct TableSummary {
  std::int64_t first_row = 0;  ///< of the part
  std::int64_t rows = 0;       ///< of the part
  Rate rate;                   ///< known
  RateOrigin origin = RateOrigin::stated;
  std::vector<ColumnSummary> columns;  ///< one per selected column
  std::vector<std::string> remarks;
};

/// The index of the time column, or nothing where there is none or it is ignored. Errors: several that could be it, the one
/// that is named is none, or a stated unit that is not its own. `selected` settles which of several: one that stands beside the
/// first selected column in a tree.
Expected<std::optional<std::size_t>> find_time_column(const TableReader& table, std::span<const std::size_t> selected,
                                                      const Timing& timing);

/// Reads the part once, in bounded memory, and checks it: every value finite, columns of one length and rate, times that rise in
/// equal steps. Error: what is wrong, and where.
Expected<TableSummary> scan_table(TableReader& table, std::span<const std::size_t> selected, std::optional<std::size_t> time,
                                  const Timing& timing, const Part& part);

}  // namespace bodeflow::acquisition
