#pragma once

#include <bodeflow/block.hpp>

#include "design_advice.hpp"
#include "designer.hpp"

namespace bodeflow::adaptive_control {

/// The controller for a known plant, how good it is, and advice on its demands.
class NominalDesign final : public Block {
 public:
  static constexpr MessageOut controller{0, "controller"}, advice{1, "advice"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void finish(Io& io) override;

 private:
  RstStructure structure_;
  DesiredResponse desired_;
  numerics::TransferFunction plant_;
  double delay_s_ = 0.0, bandwidth_ = 1.0;
  PlantKnowledge knowledge_;
};

}  // namespace bodeflow::adaptive_control
