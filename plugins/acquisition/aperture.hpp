#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace bodeflow::acquisition {

/// The largest |deviate| of numerics::Random::normal.
inline constexpr double kLargestDeviate = 8.3;

/// Every factor-th sample of one channel, taken at an instant that is displaced by a part of an input interval: the cubic through
/// the four samples around it (Lagrange). Relative error at frequency f, input rate r: below (pi f / r)^4 3 / 8.
class ApertureSampler {
 public:
  /// max_outputs: most outputs of one `run`.
  ApertureSampler(std::size_t factor, std::size_t max_outputs);

  /// y[m] = x(m factor + displacement[m]) for x.size() = factor y.size(), displacements in input intervals, |displacement| at
  /// most factor - 3; an empty list: none, at any factor.
  void run(std::span<const double> x, std::span<const double> displacement, std::span<double> y);
  /// Back to a past of zeros.
  void reset();

 private:
  std::size_t factor_;
  std::vector<double> frame_;  // the last factor samples, then those of the call
};

}  // namespace bodeflow::acquisition
