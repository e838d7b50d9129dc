#pragma once

#include <bodeflow/record.hpp>
#include <string>
#include <vector>

#include "identification.hpp"
#include "measured.hpp"

namespace bodeflow::maximum_likelihood {

/// The record `model` of the first output. Beside what records/model.hpp writes: attributes `domain`, `hold`, `weighting`,
/// `fitted_outputs`, `delay_std` [s], `cost_deviation`, `cost_probability`, `variance_degrees_of_freedom`, `covariance_method`,
/// `whiteness_statistic`, `whiteness_lags`, `whiteness_probability`, `converged`, `reason`, `starts` (how each was made),
/// `starts_at_least_cost`; arrays `start_cost`, `searched_cost`, `start_delay` [s] (one a start), `standard_deviation` (of the
/// parameters). Covariances of poles and zeros are left out where they are not finite.
RecordBuilder model_record(const Identification& id, const Measured& measured, const Settings& settings,
                           const std::vector<std::string>& warnings);

/// The record `order_scan`: attributes `chosen`, `rule`; arrays `order`, `parameter_count`, `cost`, `expected_cost`,
/// `cost_probability`, `aic`, `mdl`, `significance` (the chance of a fall of the cost as large as that to a higher order: below
/// 0.01 the order does not suffice).
RecordBuilder order_scan_record(const OrderScan& scan);

/// The record `residual`: what the model leaves of the response. Arrays, lines x outputs: `response`, `model_response`,
/// `relative_error` (|G - model| / |G|), `residual` (G - model over its standard deviation, 1 as expected, where the variance is
/// known); bands x outputs: `band_relative_error`, `band_residual` (root mean squares); `frequency` [Hz], `band` (bands x 2)
/// [Hz]. spectra: of the lines that were fitted, with the variance of the data. edges_hz: of the bands; none: up to six bands
/// with as many lines each.
RecordBuilder residual_record(const Identification& id, const Measured& measured, const Spectra& spectra,
                              const std::vector<double>& edges_hz);

}  // namespace bodeflow::maximum_likelihood
