#include "all_effects.hpp"

#include "effects/asymmetric_friction.hpp"
#include "effects/backlash.hpp"
#include "effects/bouc_wen.hpp"
#include "effects/clipping.hpp"
#include "effects/cogging.hpp"
#include "effects/coulomb_friction.hpp"
#include "effects/cubic_damping.hpp"
#include "effects/cubic_stiffness.hpp"
#include "effects/dahl_friction.hpp"
#include "effects/damping_step.hpp"
#include "effects/dead_time.hpp"
#include "effects/drift.hpp"
#include "effects/gain_step.hpp"
#include "effects/hum.hpp"
#include "effects/input_clipping.hpp"
#include "effects/input_dead_zone.hpp"
#include "effects/input_nonlinearity.hpp"
#include "effects/input_offset.hpp"
#include "effects/interharmonic.hpp"
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
#include "effects/stiffness_drift.hpp"
#include "effects/stiffness_step.hpp"
#include "effects/stop.hpp"
#include "effects/stribeck_friction.hpp"

namespace bodeflow::residual::testing {

std::vector<Tried> laws_maps_and_tones() {
  return {tried<AsymmetricFriction>(),
          tried<Backlash>(),
          tried<BoucWen>(),
          tried<Clipping>(),
          tried<Cogging>(),
          tried<CoulombFriction>(),
          tried<CubicDamping>(),
          tried<CubicStiffness>(),
          tried<DahlFriction>(),
          tried<DampingStep>(),
          tried<DeadTime>(),
          tried<Drift>(),
          tried<GainStep>(),
          tried<Hum>(),
          tried<InputClipping>(),
          tried<InputDeadZone>(),
          tried<InputNonlinearity>(),
          tried<InputOffset>(),
          tried<Interharmonic>(),
          tried<LugreFriction>(),
          tried<Offset>(),
          tried<OutputNonlinearity>(),
          tried<Overflow>(),
          tried<Play>(),
          tried<QuadraticDamping>(),
          tried<QuadraticStiffness>(),
          tried<ResistanceDrift>(),
          tried<ResistanceStep>(),
          tried<Saturation>(),
          tried<StiffnessDrift>(),
          tried<StiffnessStep>(),
          tried<Stop>(),
          tried<StribeckFriction>()};
}

Situation situation(const std::string& kind) {
  Situation s;
  s.input_unit = "A";
  s.output_unit = "rad";
  s.sample_time_s = 1e-3;
  s.duration_s = 4.0;
  s.input_peak = 5.0;
  s.input_rms = 2.0;
  s.output_peak = 0.3;
  s.output_rms = 0.1;
  s.residual_mean = 0.02;
  s.residual_rms = 0.05;
  s.peaks_hz = {150.3, 33.7};
  s.place.name = "motor_" + kind;
  s.place.kind = kind;
  const bool core = kind == "core", electric = kind == "winding" || kind == "inverter";
  s.place.flow_unit = core ? "V" : electric ? "A" : "rad/s";
  s.place.stored_unit = core ? "V*s" : electric ? "A*s" : "rad";
  s.place.reaction_unit = core ? "A" : electric ? "V" : "Nm";
  s.place.flow = 3.0;
  s.place.stored = 0.4;
  s.place.effort = 6.0;
  return s;
}

}  // namespace bodeflow::residual::testing
