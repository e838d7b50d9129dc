#pragma once

#include <bodeflow/numerics/second_order_sections.hpp>
#include <cstdint>

#include "desired_response.hpp"
#include "least_squares.hpp"
#include "rst_controller.hpp"

namespace bodeflow::adaptive_control {

/// An indirect self-tuning regulator of second order.
struct SelfTuningSettings {
  double sample_time = 1.0;
  Eigen::VectorXd a_m, a_o;                 ///< in s, of order 2
  double band_low = 0.05, band_high = 1.0;  ///< pass band of the data filter [rad/s]
  double p0 = 1e6, forgetting = 1.0;
  std::int64_t start = 80;
  double start_gain = 1.0;
  double least = -1e300, most = 1e300;
};

/// Estimates (b_0 z + b_1) / (z^2 + a_1 z + a_2) from band-pass filtered signals and places the closed loop's poles at those of
/// A_m A_o, with integral action: A (z - 1)(z + r) + B S = A_m A_o, T = A_m(1) / B(1) A_o. The peer that chapter 8 of Kallen 1992
/// compares with: it rests on the order of the plant, and has no safety nets.
class SelfTuningRegulator {
 public:
  /// Errors: polynomials that are not stable or not of order 2, a pass band that is not within (0, pi / h), settings out of
  /// range.
  static Expected<SelfTuningRegulator> make(const SelfTuningSettings& settings);

  /// u_l(k) for the measured y(k) and the command u_c(k). Allocates nothing.
  double step(double y, double u_c);

  const Rst& controller() const { return rst_; }
  /// a_1, a_2, b_0, b_1
  const Regressor& model() const { return estimator_.theta(); }
  std::int64_t designs_refused() const { return refused_; }

 private:
  SelfTuningRegulator(const SelfTuningSettings& settings, const numerics::Sections& filter, const Coefficients& a_m,
                      const Coefficients& a_o);
  bool design();

  SelfTuningSettings settings_;
  numerics::SectionFilter filter_y_, filter_u_;
  Coefficients a_m_{}, a_o_{};
  UdLeastSquares estimator_;
  std::array<double, 2> y_past_{}, u_past_{};
  RstController controller_;
  Rst rst_;
  std::int64_t sample_ = 0, refused_ = 0;
  double u_late_ = 0.0;
};

}  // namespace bodeflow::adaptive_control
