#pragma once

#include <span>
#include <vector>

#include "fourier_sum.hpp"
#include "multisine.hpp"

namespace bodeflow::generators {

/// The p-norm of a multisine as a function of its phases.
class PeakNorm {
 public:
  /// The lines' amplitudes count, their phases do not. At least one line, not all amplitudes zero.
  explicit PeakNorm(std::span<const Line> lines);

  std::size_t lines() const { return lines_.size(); }
  /// Points at which a period is looked at.
  std::size_t points() const { return signal_.size(); }
  /// The same before: 12 to 24 times the highest line over the lines' common factor, a power of two.
  static std::size_t points_for(std::span<const Line> lines);

  /// ln (mean |x|^p)^(1/p) for p = 2^power, power >= 1, and its gradient over the phases; phases in cycles, one a line.
  double evaluate(const std::vector<double>& cycles, int power, std::vector<double>& gradient);
  /// max |x| of the last evaluation.
  double peak() const { return peak_; }

 private:
  std::vector<Line> lines_;
  FourierSum sum_;
  std::vector<FourierSum::Complex> spectrum_, signal_, turned_;
  double peak_ = 0;
};

}  // namespace bodeflow::generators
