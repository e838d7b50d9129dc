#pragma once

#include <bodeflow/record.hpp>
#include <string>
#include <vector>

#include "identification.hpp"
#include "measured_lines.hpp"
#include "uncertainty.hpp"

namespace bodeflow::subspace {

/// The record `model` in form state_space; of one input and output also with numerator and denominator where they reproduce the
/// response. Beside what records/model.hpp writes: attributes `rms_error` and `max_error` (the measures (5) and (4), not
/// weighted), `relative_error` (weighted), `unpolished_relative_error`, `polished`, `functions`, `prewarp` [rad/s],
/// `projected_poles`, `unstable_poles`; array `singular_values`. Where it is known how sure the model is, also `pole_covariance`,
/// and parameters of partial fractions with their `covariance`.
RecordBuilder model_record(const Identification& id, const Measured& measured, const Expected<ModelUncertainty>& uncertainty,
                           bool known_variance, const std::vector<std::string>& warnings);

/// The record `order_scan`: attributes `chosen`, `rule`; arrays `order`, `singular_value`, `validation_error` (relative,
/// weighted), `validation_rms`, `validation_max`, `unstable_poles`.
RecordBuilder order_scan_record(const OrderScan& scan);

/// What the user should know: unstable or projected poles, an order at the end of its scan, a fit that explains little, no
/// covariance.
std::vector<std::string> model_warnings(const Identification& id, const Expected<ModelUncertainty>& uncertainty,
                                        const Settings& settings);

}  // namespace bodeflow::subspace
