#pragma once

#include <bodeflow/numerics/linear_system.hpp>
#include <cstdint>

namespace bodeflow::plants {

/// A plant as the engine runs it: at sample n it needs input n - input_delay and none later.
struct SampledPlant {
  numerics::StateSpace model;
  std::int64_t input_delay = 0;
  bool late = false;  ///< input_delay includes the sample that a system without feed-through can wait for: Simulator's `late`
};

/// The plant at the sample times n * sample_time [s]. A continuous-time model is held over each sample exactly
/// (numerics::zero_order_hold); a discrete-time model (`system.sample_time` not 0) stands as it is, its delay a whole number of
/// samples. A model without feed-through has an input delay of at least 1, so that it can stand in a loop. Errors: those of
/// zero_order_hold; a delay that is not whole for a discrete-time model.
numerics::Expected<SampledPlant> sampled_plant(const numerics::StateSpace& system, double sample_time, double delay_s);

/// The same plant's input delay alone, without the matrices' cost.
numerics::Expected<std::int64_t> input_delay(const numerics::StateSpace& system, double sample_time, double delay_s);

}  // namespace bodeflow::plants
