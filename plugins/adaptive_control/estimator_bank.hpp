#pragma once

#include <algorithm>
#include <vector>

#include "frequency_point.hpp"

namespace bodeflow::adaptive_control {

/// A bank of frequency point estimators and what they have in common.
struct BankSettings {
  std::vector<double> omega;     ///< [rad/s]
  std::vector<int> delays;       ///< d_j, one for all or one a frequency
  FrequencyPointSettings point;  ///< of each; omega and delay come from above
  double input_scale = 1.0;      ///< u and y are divided by these, so that the estimators see signals of the size 1
  double output_scale = 1.0;
  double excitation_share = 0.02;  ///< E_min as a share of the control signal's swing, squared
  double excitation_floor = 0.0;   ///< least E_min, in scaled units squared
};

/// Points of the plant's frequency response, each estimated from its own frequency band (chapter 5 of Kallen 1992). The
/// excitation gate closes below E_min = max(floor, (share x half the range that u_l has had so far)^2): relative, so that small
/// control signals adapt as well, and without memory loss, so that it stays closed while only noise is left.
class EstimatorBank {
 public:
  /// Errors: those of FrequencyPoint::make, a number of delays that fits neither one nor all frequencies, a scale not above 0.
  static Expected<EstimatorBank> make(const BankSettings& settings);

  /// Takes y(k), u_l(k-1) and, for instruments, u_c(k). Allocates nothing.
  void step(double y, double u_late, double reference = 0.0);

  int points() const { return static_cast<int>(points_.size()); }
  /// The estimates, one a frequency; 0 where there is none yet.
  const std::complex<double>* response() const { return response_.data(); }
  double variance(int j) const;
  const FrequencyPoint& point(int j) const { return points_[static_cast<std::size_t>(j)]; }
  /// What the nets did since it was cleared.
  NetLog& log() { return log_; }
  /// Samples at which a net acted in a band.
  std::int64_t acted(Net net, int j) const;

 private:
  struct Nets {
    NetState gate, bound, huber;
  };
  void watch(std::size_t j, double least);

  std::vector<FrequencyPoint> points_;
  std::vector<Nets> nets_;
  std::vector<std::complex<double>> response_;
  double input_scale_ = 1.0, output_scale_ = 1.0, share_ = 0.0, floor_ = 0.0;
  double lowest_ = 0.0, highest_ = 0.0;
  std::int64_t sample_ = 0;
  NetLog log_;
};

}  // namespace bodeflow::adaptive_control
