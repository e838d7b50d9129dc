#pragma once

#include <bodeflow/block.hpp>
#include <optional>

#include "self_tuning.hpp"

namespace bodeflow::adaptive_control {

/// The indirect self-tuning regulator of second order, estimation and design in one.
class SelfTuning final : public Block {
 public:
  static constexpr In<double> setpoint{0, "setpoint"}, y{1, "y"};
  static constexpr Out<double> u{0, "u"};
  static constexpr MessageOut controller{0, "controller"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void resolve(Facts& f) override;
  void activate(const Activation& a) override;
  void process(Io& io) override;
  void finish(Io& io) override;
  void reset() override;

 private:
  SelfTuningSettings at(double sample_time) const;

  SelfTuningSettings settings_;
  double start_s_ = 0.0, sample_time_ = 1.0;
  std::string unit_;
  std::optional<SelfTuningRegulator> regulator_;
};

}  // namespace bodeflow::adaptive_control
