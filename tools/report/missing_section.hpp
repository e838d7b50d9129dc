#pragma once

#include "report/page.hpp"
#include "report/run_data.hpp"

namespace bodeflow::tools::report {

/// Which samples are missing because a host was lost, by connection, and where its recordings lie. Nothing where none was.
void add_missing(Page& page, const RunData& run);

}  // namespace bodeflow::tools::report
