#pragma once

#include <functional>

#include "report/page.hpp"
#include "report/run_data.hpp"

namespace bodeflow::tools::report {

/// Adds the recorded streams: a table, and least and greatest values over time for each channel. Reads in pieces of bounded size,
/// whatever the length; `progress` is told the share that was read, from 0 to 1.
void add_streams(Page& page, RunData& run, const std::function<void(double)>& progress);

}  // namespace bodeflow::tools::report
