#include "sampled_plant.hpp"

#include <bodeflow/numerics/discretise.hpp>
#include <cstdio>

namespace bodeflow::plants {

numerics::Expected<std::int64_t> input_delay(const numerics::StateSpace& system, double sample_time, double delay_s) {
  const numerics::SplitDelay delay = numerics::split_delay(delay_s, sample_time);
  if (system.sample_time != 0 && delay.rest_s > 0) {
    char text[160];
    std::snprintf(text, sizeof text, "delay is %.10g s, allowed for a discrete-time model: a whole number of samples of %.10g s",
                  delay_s, sample_time);
    return numerics::refused(text);
  }
  const bool waits = !system.has_feedthrough() || delay.rest_s > 0;
  return delay.samples + (waits ? 1 : 0);
}

numerics::Expected<SampledPlant> sampled_plant(const numerics::StateSpace& system, double sample_time, double delay_s) {
  const auto delay = input_delay(system, sample_time, delay_s);
  if (!delay) return tl::make_unexpected(delay.error());
  SampledPlant plant{system, *delay, false};
  if (system.sample_time == 0) {
    auto held = numerics::zero_order_hold(system, sample_time, delay_s);
    if (!held) return tl::make_unexpected(held.error());
    plant.model = std::move(held->model);
  }
  plant.late = !plant.model.has_feedthrough();
  return plant;
}

}  // namespace bodeflow::plants
