#pragma once

#include "records/record_arrays.hpp"
#include "records/response.hpp"
#include "records/response_units.hpp"
#include "records/signals.hpp"

/// What all families share of records, by its short names.
namespace bodeflow::spectrum {
using namespace records;
}
