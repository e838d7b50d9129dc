#pragma once

#include "designer.hpp"
#include "estimator_bank.hpp"
#include "rst_controller.hpp"

namespace bodeflow::adaptive_control {

/// The complete scheme of chapter 5 of Kallen 1992: filters, estimators, design, time-varying controller.
class AdaptiveController {
 public:
  AdaptiveController(EstimatorBank bank, Designer designer, RstController controller, bool watched = true)
      : bank_(std::move(bank)), designer_(std::move(designer)), controller_(controller), watched_(watched) {}

  /// u_l(k) for the measured y(k) and the command u_c(k). Allocates nothing.
  double step(double y, double u_c) {
    bank_.step(y, u_late_, u_c);
    if (watched_) designer_.watch(y, u_c, controller_.at_limit());
    const Rst& rst = designer_.step(bank_.response());
    rst_ = rst;
    u_late_ = controller_.step(y, u_c, rst, designer_.anti_windup());
    return u_late_;
  }

  EstimatorBank& bank() { return bank_; }
  Designer& designer() { return designer_; }
  const RstController& controller() const { return controller_; }
  /// What the last sample was controlled with.
  const Rst& rst() const { return rst_; }

 private:
  EstimatorBank bank_;
  Designer designer_;
  RstController controller_;
  Rst rst_;
  bool watched_ = true;
  double u_late_ = 0.0;
};

}  // namespace bodeflow::adaptive_control
