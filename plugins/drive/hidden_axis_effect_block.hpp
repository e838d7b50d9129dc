#pragma once

#include <array>
#include <bodeflow/block.hpp>

#include "hidden_effect.hpp"

namespace bodeflow::drive {

/// drive.hidden_axis_effect: draws what a bench with an axis hides.
class HiddenAxisEffect final : public Block {
 public:
  static constexpr MessageOut out{0, "out"};
  static constexpr std::array<const char*, 6> kParameters{"motor_inertia", "load_inertia",    "stiffness",
                                                          "damping",       "motor_viscosity", "load_viscosity"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void activate(const Activation& a) override;
  void finish(Io& io) override;

 private:
  Draw draw_;
  std::vector<double> nominal_;
  double spread_ = 0.0;
  bool own_seed_ = false;
  std::uint64_t seed_ = 0;
};

}  // namespace bodeflow::drive
