#pragma once

#include <optional>
#include <vector>

#include "line_reader.hpp"

namespace bodeflow::acquisition {

/// One function (data set 58 or 58b) of a universal file, without its values.
///
/// Form: S. Schulz and others, "Universal File Formats for Modal Analysis Testing", University of Cincinnati (SDRL), data set
/// 58: eleven records of header between "-1" lines, then values in 6E13.5, 4E20.12 or binary.
struct Uff58Function {
  std::int64_t line = 0;    ///< where the values begin
  std::int64_t offset = 0;  ///< byte at which they begin
  std::int64_t bytes = -1;  ///< of binary values; -1: text
  bool big_endian = false;  ///< of binary values
  std::string title;        ///< the first record that says something, or ""
  int kind = 0;             ///< 1 time response, 2 auto spectrum, 3 cross spectrum, 4 frequency response ...
  int response_node = 0, response_direction = 0;
  int reference_node = 0, reference_direction = 0;
  bool complex = false;  ///< values are pairs: real, imaginary
  bool double_precision = false;
  std::int64_t points = 0;
  bool even = true;  ///< abscissa by `start` and `step`; otherwise each point begins with its abscissa
  double start = 0.0, step = 0.0;
  int abscissa_type = 0;      ///< 17 time, 18 frequency
  std::string abscissa_unit;  ///< as written, "" for none
  int ordinate_type = 0;      ///< 8 displacement, 11 velocity, 12 acceleration ...
  std::string ordinate_label, ordinate_unit;
  std::string reference_unit;  ///< what a response is per: of the denominator

  /// Numbers that stand for one point.
  int numbers_per_point() const { return (complex ? 2 : 1) + (even ? 0 : 1); }
};

/// The functions of a universal file; other data sets are passed over and counted in `others`. Error: no universal file, a
/// data set that does not end, a header that is cut off or holds no numbers where they must stand.
struct Uff58File {
  std::vector<Uff58Function> functions;
  std::int64_t others = 0;
};
Expected<Uff58File, TextError> read_uff58(LineReader& lines);

/// A degree of freedom as engineers write it: "12+Z", "3-RX", "7" without direction.
std::string degree_of_freedom(int node, int direction);

/// The number that begins at `at` of a line, after blanks, and ends at a blank or the end; `at` moves behind it. Nothing, and
/// `at` behind the blanks, where there is none.
std::optional<double> take_number(std::string_view line, std::size_t& at);

/// True for the line "-1" that begins and ends a data set.
bool is_uff_mark(std::string_view line);

}  // namespace bodeflow::acquisition
