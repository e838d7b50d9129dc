#pragma once

#include <bodeflow/error.hpp>
#include <bodeflow/record.hpp>
#include <string>
#include <vector>

#include "measured.hpp"
#include "multi_band.hpp"

namespace bodeflow::sanathanan_koerner {

/// The record `model` in form state_space, the bands in parallel. Beside what records/model.hpp writes: attributes
/// `relative_error`, `one_band_error`, `one_band_order`, `rms_error`, `max_error`, `reason`; arrays `band_edges` [Hz] (bands x
/// 2), `band_order`, `band_prewarp` [rad/s]. Errors: those of state_space.
Expected<RecordBuilder> multi_band_record(const MultiBandFit& fit, const Measured& measured,
                                          const std::vector<std::string>& warnings);

/// The record `band_log`: attribute `phases` (search or final, one a round); arrays `iterations` (rounds x bands, 0 where a band
/// did not take part) and `error` (of the sum).
RecordBuilder band_log_record(const MultiBandFit& fit);

/// The record `residual` of residual_record with, in addition, `band_edges` [Hz] (bands x 2) and `band_response` (bands x lines x
/// responses), the models of the bands at the lines.
RecordBuilder band_residual_record(const MultiBandFit& fit, const Measured& measured);

/// What the user should know of it.
std::vector<std::string> multi_band_warnings(const MultiBandFit& fit, const MultiBandSettings& settings);

}  // namespace bodeflow::sanathanan_koerner
