#pragma once

#include <algorithm>
#include <cmath>

namespace bodeflow::adaptive_control {

/// Why a designed controller is given up.
enum class Departure { none, output, error, limits };

/// Tells when a designed controller makes things worse than the proportional one before it. Output and error are judged against
/// the half swing of command and output so far, that of the output only until a designed controller was first in use: what swings
/// out after a retreat must not widen the range.
class Watchdog {
 public:
  static constexpr double kOutput = 3.0;    ///< half swings that the output may be away from their middle
  static constexpr double kError = 1.2;     ///< half swings that the mean error may have
  static constexpr double kMemory = 0.99;   ///< of the mean error: 100 samples
  static constexpr double kArrivals = 8.0;  ///< times that the control signal may run into its limits while the command rests
  static constexpr double kLimitMemory = 0.998;  ///< of the arrivals: 500 samples
  static constexpr double kRest = 0.05;          ///< half swings that a resting command may move

  enum class InUse { start_controller, designed, start_controller_again };
  struct Finding {
    Departure departure = Departure::none;
    double value = 0.0, limit = 0.0;
  };

  /// What the sample tells of the controller in use. `at_limit`: -1 or 1 where the control signal was at its least or greatest
  /// value.
  Finding step(double y, double u_c, int at_limit, InUse in_use) {
    widen(y, u_c, in_use == InUse::start_controller);
    const double half = 0.5 * (highest_ - lowest_), middle = 0.5 * (highest_ + lowest_);
    const bool moves = std::abs(u_c - held_) > kRest * half;
    if (moves) held_ = u_c;
    const bool arrives = at_limit != 0 && at_limit != at_limit_;
    at_limit_ = at_limit;
    if (in_use != InUse::designed) {
      mean_error_ = arrivals_ = 0.0;
      return {};
    }
    mean_error_ = kMemory * mean_error_ + (1.0 - kMemory) * std::abs(u_c - y);
    arrivals_ = moves ? 0.0 : kLimitMemory * arrivals_ + (arrives ? 1.0 : 0.0);
    if (!(half > 0.0)) return {};
    const double distance = std::abs(y - middle) / half;
    if (distance > kOutput) return {Departure::output, distance, kOutput};
    if (mean_error_ > kError * half) return {Departure::error, mean_error_ / half, kError};
    if (arrivals_ > kArrivals) return {Departure::limits, arrivals_, kArrivals};
    return {};
  }

 private:
  void widen(double y, double u_c, bool by_output) {
    if (!begun_) lowest_ = highest_ = held_ = u_c;
    begun_ = true;
    lowest_ = std::min(lowest_, by_output ? std::min(u_c, y) : u_c);
    highest_ = std::max(highest_, by_output ? std::max(u_c, y) : u_c);
  }

  bool begun_ = false;
  int at_limit_ = 0;
  double lowest_ = 0.0, highest_ = 0.0, held_ = 0.0, mean_error_ = 0.0, arrivals_ = 0.0;
};

}  // namespace bodeflow::adaptive_control
