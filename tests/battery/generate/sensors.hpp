#pragma once

#include <memory>

#include "generate/hidden.hpp"

namespace battery {

using PlantPointer = std::shared_ptr<const Plant>;

/// Effects between the plant and the file, for any plant.
Hidden hum(PlantPointer plant, const Scale& scale, Random& random);
Hidden offset(PlantPointer plant, const Scale& scale, Random& random);
Hidden clipping(PlantPointer plant, const Scale& scale, Random& random);

/// The same, in no textbook's list: gain that wanders (sine, random, chaotic), sampling instants that wander, a delay that
/// depends on the level, a detector that rises and falls with different lags, and a second path driven by the square of the
/// input.
Hidden gain_wobble(PlantPointer plant, const Scale& scale, Random& random);
Hidden clock_wander(PlantPointer plant, const Scale& scale, Random& random);
Hidden level_delay(PlantPointer plant, const Scale& scale, Random& random);
Hidden attack_decay(PlantPointer plant, const Scale& scale, Random& random);
Hidden squared_crosstalk(PlantPointer plant, const Scale& scale, Random& random);

/// A maker for one plant of an effect for any.
template <class P, Hidden (*effect)(PlantPointer, const Scale&, Random&)>
Hidden of(const P& plant, const Scale& scale, Random& random) {
  return effect(std::make_shared<P>(plant), scale, random);
}

/// The signal between its substeps, by the cubic through four of them.
double interpolated(const Series& fine, double substep);

/// Slow and not periodic with the excitation: rms about 1, one value a sample, settling included.
struct Wander {
  enum Kind { sine, random_process, chaotic } kind = sine;
  double rate_hz = 1.0;
};
Wander draw_wander(const Plant& plant, Random& random);
Series wander_signal(const Wander& w, const Drive& d, Random& random);

}  // namespace battery
