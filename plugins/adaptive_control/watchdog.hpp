#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace bodeflow::adaptive_control {

/// Tells when a designed controller makes things worse than the proportional one before it. Both are judged against the half
/// swing of command and output so far, the output's only as long as the controller to start with was in use.
class Watchdog {
 public:
  static constexpr double kOutput = 3.0;   ///< half swings that the output may be away from their middle
  static constexpr double kError = 1.2;    ///< half swings that the mean error may have
  static constexpr double kMemory = 0.99;  ///< of the mean error: 100 samples

  /// True where the output left its range, or the error's mean is as large as if nothing were controlled. `trusted`: the
  /// controller to start with is in use.
  bool step(double y, double u_c, bool trusted) {
    if (samples_++ == 0) lowest_ = highest_ = u_c;
    lowest_ = std::min(lowest_, trusted ? std::min(u_c, y) : u_c);
    highest_ = std::max(highest_, trusted ? std::max(u_c, y) : u_c);
    const double half = 0.5 * (highest_ - lowest_), middle = 0.5 * (highest_ + lowest_);
    mean_error_ = trusted ? 0.0 : kMemory * mean_error_ + (1.0 - kMemory) * std::abs(u_c - y);
    distance_ = half > 0.0 ? std::abs(y - middle) / half : 0.0;
    return !trusted && half > 0.0 && (distance_ > kOutput || mean_error_ > kError * half);
  }

  /// Of the output from the middle, in half swings.
  double distance() const { return distance_; }

 private:
  double lowest_ = 0.0, highest_ = 0.0, mean_error_ = 0.0, distance_ = 0.0;
  std::int64_t samples_ = 0;
};

}  // namespace bodeflow::adaptive_control
