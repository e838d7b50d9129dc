#pragma once

#include "scan.hpp"

namespace bodeflow::acquisition {

/// Least, greatest and flat tops of a column, in one pass and constant memory.
class SummaryOfColumn {
 public:
  /// Takes the next values, all finite.
  void add(std::span<const double> values);

  ColumnSummary result() const;

 private:
  /// Runs of equal samples at an extreme value.
  struct Extreme {
    double value = 0.0;
    std::int64_t run = 0;   // samples of the run in progress
    std::int64_t runs = 0;  // long enough
    void take(double x, bool beyond);
  };
  Extreme least_, greatest_;
  double first_ = 0.0;
  std::optional<double> other_;  // a second value
  bool between_ = false;         // there is a third one
  bool empty_ = true;
};

/// The power of ten of the last digit of a decimal number: -2 for "1.25", 2 for "3e2".
int last_digit_of(std::string_view number);

/// What to tell the user when the column looks clipped, or "": at least three separate runs of three or more equal samples at
/// its least or greatest value, with others between these. A column of two values is binary, not clipped.
std::string clipping_suspicion(const ColumnSummary& column);

}  // namespace bodeflow::acquisition
