#pragma once

#include <bodeflow/block.hpp>

#include "hidden_effect.hpp"

namespace bodeflow::drive {

/// drive.hidden_effect: draws what a bench with a motor at an inverter hides.
class HiddenEffectBlock final : public Block {
 public:
  static constexpr MessageOut out{0, "out"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void activate(const Activation& a) override;
  void finish(Io& io) override;

 private:
  Draw draw_;
  MotorParameters nominal_;
  double spread_ = 0.0;
  bool own_seed_ = false;
  std::uint64_t seed_ = 0;
};

}  // namespace bodeflow::drive
