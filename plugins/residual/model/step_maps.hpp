#pragma once

#include "model/laws.hpp"
#include "model/plant_matrices.hpp"
#include "model/small_product.hpp"
#include "model/transition.hpp"

namespace bodeflow::residual {

/// What the inputs do within a step.
enum class Push { held, straight };

/// One step of the linear part as small matrices. Known is [x | u at the begin | u at the end (straight only) | w at the begin],
/// unknown the reactions at the middle and the end of a double step, at the end of a single one.
struct StepMaps {
  double h = 0.0;
  SmallMatrix known;    ///< rows: for each node (middle, end) flows and stored quantities of the active places; then x at the end
  SmallMatrix unknown;  ///< the same rows, columns: reactions of all active places at the middle, then at the end
  /// The same for the signals alone: per active place (flow, stored quantity) of each node by all unknown reactions.
  std::vector<double> gains;
  double sample_s = -1;                      ///< a sample is taken so long after the step's begin; below 0: none
  SmallMatrix sample_known, sample_unknown;  ///< rows: output, then flows and stored quantities of all places where asked for
};

/// What step maps are made from.
struct StepPlan {
  const PlantMatrices* plant = nullptr;
  const Laws* laws = nullptr;
  Push push = Push::held;
  bool signals = false;  ///< samples have flows and stored quantities
};

/// A double step over twice the time of `half`: reactions are parabolas through begin, middle and end.
StepMaps double_step(const StepPlan& plan, const Transition& half, double sample_s);

/// A single step: reactions straight, or constant (1 - theta) w0 + theta w1 at places whose law is rough.
StepMaps single_step(const StepPlan& plan, const Transition& step, double sample_s);

}  // namespace bodeflow::residual
