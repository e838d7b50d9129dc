#pragma once

#include "record/run_directory.hpp"

namespace bodeflow::lab {

/// Joins what hosts sent below `hosts/` with the run directory: their recordings become one data.h5, their hashes stand in the
/// manifest, files that blocks wrote lie where a run on one machine puts them. Error: what could not be joined.
tl::expected<void, std::string> merge_hosts(record::RunDirectory& directory);

}  // namespace bodeflow::lab
