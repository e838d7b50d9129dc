#pragma once

#include <bodeflow/error.hpp>
#include <bodeflow/rate.hpp>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace bodeflow::acquisition {

/// One column of a data file.
struct Column {
  std::string header;  ///< as written in the file
  std::string name;    ///< without the unit
  std::string unit;    ///< "" where none is written, or none that is known
};

/// What one selected column holds.
struct ColumnSummary {
  double least = 0.0;
  double greatest = 0.0;
  /// Runs of at least three equal samples at the least or the greatest value. Three runs or more suggest clipping.
  std::int64_t runs_at_least = 0;
  std::int64_t runs_at_greatest = 0;
};

/// What a scan of the whole file found.
struct TableSummary {
  std::int64_t rows = 0;
  Rate rate;                           ///< known
  bool rate_from_time = false;         ///< from the time column; otherwise the stated rate
  std::vector<ColumnSummary> columns;  ///< one per selected column
  std::vector<std::string> remarks;    ///< what else is worth telling: comments passed over, decimal commas ...
};

/// How the rows stand in time.
struct Timing {
  std::optional<double> rate_hz;    ///< stated by the user
  bool ignore_time_column = false;  ///< the stated rate holds, whatever the time column says
};

/// A data file as a table of equally sampled columns, whatever its format. Errors have the form "file:line:column: what".
class TableReader {
 public:
  virtual ~TableReader() = default;

  /// All columns, in the order of the file.
  virtual const std::vector<Column>& columns() const = 0;

  /// Index of the time column in `columns()`, or nothing.
  virtual std::optional<std::size_t> time_column() const = 0;

  /// Reads the whole file once, in bounded memory, and checks every value of the selected columns (indices into `columns()`)
  /// and the sampling.
  virtual Expected<TableSummary> scan(std::span<const std::size_t> selected, const Timing& timing) = 0;

  /// Goes (back) to the first row. The selection holds until the next `start`.
  virtual Expected<void> start(std::span<const std::size_t> selected) = 0;

  /// Writes the next rows, at most `count`, to channels[c][0 .. count), c as in the selection; how many there were, 0 at the end.
  virtual Expected<std::size_t> read(std::span<double* const> channels, std::size_t count) = 0;
};

/// Index of the column that `name` means: its header, its name, or `name_unit`; blanks at the ends do not count.
/// Error: none, with the nearest; or several.
Expected<std::size_t> find_column(const std::vector<Column>& columns, const std::string& name);

/// The name and unit in a header `name [unit]` or `name_unit`; a unit that is not known stays part of the name.
Column parse_header(std::string_view text);

/// Seconds per unit of time ("s", "ms", "us" ...), or nothing for another unit.
std::optional<double> seconds_per(const std::string& unit);

/// True for a column that holds time: named t or time (in any case) with a unit of time.
bool is_time(const Column& column);

}  // namespace bodeflow::acquisition
