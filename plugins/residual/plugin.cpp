#include <bodeflow/block.hpp>
#include <bodeflow/parts.hpp>

#include "bases/drive_axis.hpp"
#include "bases/frequency_response.hpp"
#include "bases/impedance.hpp"
#include "bases/motor_standstill.hpp"
#include "bases/second_order.hpp"
#include "bases/state_space.hpp"
#include "bases/transfer_function.hpp"
#include "bases/two_mass.hpp"
#include "bases/two_tanks.hpp"
#include "blocks/amplitude_block.hpp"
#include "blocks/hold_out_bands_block.hpp"
#include "blocks/remeasure_block.hpp"
#include "blocks/remedy_block.hpp"
#include "blocks/reveal_block.hpp"
#include "blocks/trace_block.hpp"
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

using namespace bodeflow::residual;

// Blocks, base models, effects.
BODEFLOW_PLUGIN("residual", "1.0.0", TraceBlock, AmplitudeBlock, HoldOutBands, Reveal, RemedyBlock, Remeasure, DriveAxis,
                FrequencyResponseModel, Impedance, MotorStandstill, SecondOrder, StateSpaceModel, TransferFunctionModel, TwoMass,
                TwoTanks, AsymmetricFriction, Backlash, BoucWen, Clipping, Cogging, CoulombFriction, Creep, CubicDamping,
                CubicStiffness, DahlFriction, DampingStep, DeadTime, Delay, Drift, EddyShunt, ExtraMode, FeedThrough, GainStep,
                Hum, InputClipping, InputDeadZone, InputNonlinearity, InputOffset, Interharmonic, IronLoss, LugreFriction, Offset,
                OutputNonlinearity, Overflow, Play, QuadraticDamping, QuadraticStiffness, ResistanceDrift, ResistanceStep,
                Saturation, SecondCage, SemiInductance, SensorLag, SkinEffect, StiffnessDrift, StiffnessStep, Stop,
                StribeckFriction)
