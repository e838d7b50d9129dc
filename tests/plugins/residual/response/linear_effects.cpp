#include "linear_effects.hpp"

#include "effects/creep.hpp"
#include "effects/delay.hpp"
#include "effects/eddy_shunt.hpp"
#include "effects/extra_mode.hpp"
#include "effects/feed_through.hpp"
#include "effects/iron_loss.hpp"
#include "effects/second_cage.hpp"
#include "effects/semi_inductance.hpp"
#include "effects/sensor_lag.hpp"
#include "effects/skin_effect.hpp"

namespace bodeflow::residual::testing {

std::vector<Linear> linear_effects() {
  return {linear<Creep>(),    linear<Delay>(),      linear<EddyShunt>(),      linear<ExtraMode>(), linear<FeedThrough>(),
          linear<IronLoss>(), linear<SecondCage>(), linear<SemiInductance>(), linear<SensorLag>(), linear<SkinEffect>()};
}

}  // namespace bodeflow::residual::testing
