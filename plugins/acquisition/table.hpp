#pragma once

#include <bodeflow/error.hpp>
#include <bodeflow/rate.hpp>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace bodeflow::acquisition {

/// An array with more columns than these lies the other way round, or is no table.
constexpr std::size_t kMostColumns = 4096;

/// One column of a data file.
struct Column {
  std::string header;      ///< as written in the file; no two are the same
  std::string name;        ///< without the unit
  std::string unit;        ///< "" where none is written, or none that is known
  Rate rate;               ///< samples per second where the file states them; unknown otherwise
  std::int64_t rows = -1;  ///< -1: known only when the file was read to its end
};

/// Something in a file that can't be a column.
struct Leftover {
  std::string name;
  std::string why;  ///< "is text"
};

/// A data file as a table of columns, whatever its format. Reads forward in bounded memory. Errors begin with the file's name
/// and the place: "file:line:column: what".
class TableReader {
 public:
  virtual ~TableReader() = default;

  /// The file's name, for messages.
  virtual const std::string& file() const = 0;

  /// All columns, in the order of the file.
  virtual const std::vector<Column>& columns() const = 0;

  /// What else stands in the file.
  virtual const std::vector<Leftover>& leftovers() const {
    static const std::vector<Leftover> none;
    return none;
  }

  /// Goes to a row, the first being 0: the next `read` begins there, or gives no rows where the file has fewer. The selection
  /// (indices into `columns()`, none twice) holds until the next `start`.
  virtual Expected<void> start(std::span<const std::size_t> selected, std::int64_t first_row) = 0;

  /// Writes the next rows, at most `count`, to channels[c][0 .. count), c as in the selection; how many there were. Fewer than
  /// `count` only at the end. Values may be NaN or infinite.
  virtual Expected<std::size_t> read(std::span<double* const> channels, std::size_t count) = 0;

  /// Where row n of the last `read` stands: "file:line", or "file: row 12".
  virtual std::string place(std::size_t n) const = 0;

  /// The place value of the finest digit of the first selected column, in the rows read since `start`; 0: as fine as a double.
  virtual double resolution() const { return 0.0; }

  /// What else is worth telling of the rows read since `start`: comments passed over, decimal commas ...
  virtual std::vector<std::string> remarks() const { return {}; }
};

/// Index of the column that `name` means: its header, its name, or `name_unit`; blanks at the ends do not count.
/// Error: none, with the nearest; several; or why what is named is no column.
Expected<std::size_t> find_column(const std::vector<Column>& columns, const std::string& name,
                                  const std::vector<Leftover>& leftovers = {});

/// The name and unit in a header `name [unit]`, `name (unit)` or `name_unit`; a unit that is not known stays part of the name.
Column parse_header(std::string_view text);

/// True for a text that is a unit as far as a data file may have one: known, and not empty.
bool is_unit(std::string_view text);

/// Seconds per unit of time ("s", "ms", "us" ...), or nothing for another unit.
std::optional<double> seconds_per(const std::string& unit);

/// True for a column named t or time, in any case; in a tree of names the last one counts.
bool is_named_time(const Column& column);

/// True for a column that holds time: named so, with a unit of time.
bool is_time(const Column& column);

}  // namespace bodeflow::acquisition
