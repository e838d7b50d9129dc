#pragma once

#include <span>
#include <string>
#include <vector>

namespace bodeflow::tools::report {

enum class Scale {
  exact,        ///< linear, from the least to the greatest value (time)
  linear,       ///< linear, ends at ticks
  logarithmic,  ///< decades
  decibel,      ///< linear with steps of 1, 2, 5, 10, 20, 40
  degrees       ///< linear with steps of 15, 30, 45, 90, 180
};

struct Tick {
  double value = 0.0;
  std::string label;
};

struct Axis {
  Scale scale = Scale::linear;
  double low = 0.0;
  double high = 1.0;
  std::vector<Tick> ticks;
  std::vector<double> minor;  ///< where thin grid lines stand
  std::string title;

  /// 0 at `low`, 1 at `high`; not finite where the value has no place (0 on a logarithmic axis).
  double place(double value) const;
  /// Characters of the longest label.
  std::size_t label_length() const;
};

/// An axis for values between `low` and `high` (both finite; positive on a logarithmic scale) with about `wanted` labels.
Axis make_axis(Scale scale, double low, double high, int wanted, std::string title);

/// The least and greatest finite value; with `positive` only values above zero count.
struct Extent {
  double low = 1.0;
  double high = 0.0;
  bool empty() const { return !(low <= high); }
  void add(double value, bool positive = false);
  void add(std::span<const double> values, bool positive = false);
};

}  // namespace bodeflow::tools::report
