#pragma once

#include "table.hpp"

namespace bodeflow::acquisition {

/// Least, greatest and flat tops of each column, in one pass and constant memory.
class SummaryOfColumns {
 public:
  explicit SummaryOfColumns(std::size_t columns);

  /// Takes one row.
  void add(std::span<const double> row);

  std::vector<ColumnSummary> columns() const;

 private:
  /// Runs of equal samples at an extreme value.
  struct Extreme {
    double value = 0.0;
    std::int64_t run = 0;   // samples of the run in progress
    std::int64_t runs = 0;  // finished or long enough
    void take(double x, bool beyond, bool first);
  };
  struct State {
    Extreme least, greatest;
  };
  std::vector<State> states_;
  bool first_ = true;
};

/// The place value of the last digit of a decimal number: 0.01 for "1.25", 100 for "3e2".
double resolution_of(std::string_view number);

/// What to tell the user when the column looks clipped, or "": at least three separate runs of three or more equal samples at
/// its least or greatest value, which are not the same.
std::string clipping_suspicion(const ColumnSummary& column);

}  // namespace bodeflow::acquisition
