#pragma once

#include <bodeflow/block.hpp>

#include "hidden_effect.hpp"

namespace bodeflow::drive {

/// drive.hidden_effect: draws what a bench hides.
class HiddenEffectBlock final : public Block {
 public:
  static constexpr MessageOut out{0, "out"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void activate(const Activation& a) override;
  void finish(Io& io) override;

 private:
  std::vector<std::string> names_;
  std::array<SizeRange, kEffects.size()> ranges_{};
  MotorParameters nominal_;
  double spread_ = 0.0;
  bool own_seed_ = false;
  std::uint64_t seed_ = 0;
};

}  // namespace bodeflow::drive
