#include "every_effect.hpp"

#include <algorithm>

#include "effects/asymmetric_friction.hpp"
#include "effects/backlash.hpp"
#include "effects/bouc_wen.hpp"
#include "effects/clipping.hpp"
#include "effects/cogging.hpp"
#include "effects/coulomb_friction.hpp"
#include "effects/creep.hpp"
#include "effects/cubic_damping.hpp"
#include "effects/cubic_stiffness.hpp"
#include "effects/dahl_friction.hpp"
#include "effects/damping_step.hpp"
#include "effects/dead_time.hpp"
#include "effects/delay.hpp"
#include "effects/drift.hpp"
#include "effects/eddy_shunt.hpp"
#include "effects/extra_mode.hpp"
#include "effects/feed_through.hpp"
#include "effects/gain_step.hpp"
#include "effects/hum.hpp"
#include "effects/input_clipping.hpp"
#include "effects/input_dead_zone.hpp"
#include "effects/input_nonlinearity.hpp"
#include "effects/input_offset.hpp"
#include "effects/interharmonic.hpp"
#include "effects/iron_loss.hpp"
#include "effects/lugre_friction.hpp"
#include "effects/offset.hpp"
#include "effects/output_nonlinearity.hpp"
#include "effects/overflow.hpp"
#include "effects/play.hpp"
#include "effects/quadratic_damping.hpp"
#include "effects/quadratic_stiffness.hpp"
#include "effects/resistance_drift.hpp"
#include "effects/resistance_step.hpp"
#include "effects/saturation.hpp"
#include "effects/second_cage.hpp"
#include "effects/semi_inductance.hpp"
#include "effects/sensor_lag.hpp"
#include "effects/skin_effect.hpp"
#include "effects/stiffness_drift.hpp"
#include "effects/stiffness_step.hpp"
#include "effects/stop.hpp"
#include "effects/stribeck_friction.hpp"

namespace bodeflow::residual::test {
namespace {

template <class E>
CatalogueEntry entry() {
  CatalogueEntry e;
  DescribeEffect describe(e.what);
  E::describe(describe);
  e.effect = std::make_shared<E>();
  return e;
}

}  // namespace

Catalogue every_effect(const std::vector<std::string>& without) {
  const Catalogue all = {entry<AsymmetricFriction>(),
                         entry<Backlash>(),
                         entry<BoucWen>(),
                         entry<Clipping>(),
                         entry<Cogging>(),
                         entry<CoulombFriction>(),
                         entry<Creep>(),
                         entry<CubicDamping>(),
                         entry<CubicStiffness>(),
                         entry<DahlFriction>(),
                         entry<DampingStep>(),
                         entry<DeadTime>(),
                         entry<Delay>(),
                         entry<Drift>(),
                         entry<EddyShunt>(),
                         entry<ExtraMode>(),
                         entry<FeedThrough>(),
                         entry<GainStep>(),
                         entry<Hum>(),
                         entry<InputClipping>(),
                         entry<InputDeadZone>(),
                         entry<InputNonlinearity>(),
                         entry<InputOffset>(),
                         entry<Interharmonic>(),
                         entry<IronLoss>(),
                         entry<LugreFriction>(),
                         entry<Offset>(),
                         entry<OutputNonlinearity>(),
                         entry<Overflow>(),
                         entry<Play>(),
                         entry<QuadraticDamping>(),
                         entry<QuadraticStiffness>(),
                         entry<ResistanceDrift>(),
                         entry<ResistanceStep>(),
                         entry<Saturation>(),
                         entry<SecondCage>(),
                         entry<SemiInductance>(),
                         entry<SensorLag>(),
                         entry<SkinEffect>(),
                         entry<StiffnessDrift>(),
                         entry<StiffnessStep>(),
                         entry<Stop>(),
                         entry<StribeckFriction>()};
  Catalogue some;
  for (const CatalogueEntry& e : all)
    if (std::find(without.begin(), without.end(), e.what.name()) == without.end()) some.push_back(e);
  return some;
}

std::vector<EffectDescription> every_description() {
  std::vector<EffectDescription> all;
  for (const CatalogueEntry& e : every_effect()) all.push_back(e.what);
  return all;
}

}  // namespace bodeflow::residual::test
