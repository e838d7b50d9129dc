#pragma once

#include <bodeflow/record_builder.hpp>

#include "rst.hpp"

namespace bodeflow::adaptive_control {

/// The record `controller` with sample_time [s] and the polynomials R, S, T in descending powers of z.
RecordBuilder controller_record(const Rst& rst, double sample_time);

}  // namespace bodeflow::adaptive_control
