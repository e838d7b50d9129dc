#pragma once

#include <bodeflow/record.hpp>
#include <string>
#include <vector>

#include "motor_estimate.hpp"

namespace bodeflow::frisch {

/// What the records of an estimate say beside it.
struct MotorContext {
  std::string input_is;  ///< which voltage the input is, for `conventions`
  std::vector<Band> bands;
  MotorSettings settings;
};

/// The record `model`, form physical, of an estimate, with poles, zero and their covariances; beside what all models have: `bias`
/// of each parameter, 95 % intervals `interval_low` and `interval_high`, and noise per band.
RecordBuilder model_record(const MotorEstimate& estimate, const MotorContext& context);

/// A record `parameters` of what the terminals tell: Rs, Ls, Lr/Rr, sigma.
RecordBuilder identifiable_record(const MotorEstimate& estimate);

/// A record `parameters` of the equivalent circuit under the assumption Ls = Lr, which it names.
RecordBuilder equal_inductance_record(const MotorEstimate& estimate);

/// A record `frequency_response`: the response that was fitted, all bands, of the motor in continuous time, with the delay that
/// the model has. Lines that two bands share stand there once, from the first of them.
RecordBuilder fitted_response_record(const MotorEstimate& estimate, const MotorContext& context);

/// What spoils the estimate, each with what to do.
std::vector<std::string> motor_warnings(const MotorEstimate& estimate, const MotorContext& context);

}  // namespace bodeflow::frisch
