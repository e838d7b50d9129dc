#pragma once

#include <bodeflow/block.hpp>
#include <bodeflow/numerics/linear_system.hpp>

namespace bodeflow::plants {

/// The model of a structure from its modes.
class ModesBlock final : public Block {
 public:
  static constexpr MessageOut model{0, "model"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void finish(Io& io) override;

 private:
  numerics::StateSpace system_;
};

}  // namespace bodeflow::plants
