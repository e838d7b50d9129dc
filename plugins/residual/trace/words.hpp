#pragma once

#include <string>
#include <vector>

#include "trace/trace.hpp"

namespace bodeflow::residual {

/// What was found, in a few plain sentences: the causes with their sizes, the error before and after beside the noise floor.
std::string finding(const Trace& trace, const std::string& unit);

/// What the reader has to know before using it, each with what to do.
std::vector<std::string> warnings(const Trace& trace);

/// What the experiment could not tell, and which one would: more periods, a second level, detection lines, a longer record.
std::vector<std::string> advice(const Trace& trace, const TraceData& data);

/// What the records hold that the base model does not explain, as "excited 12.1, odd 8.3 times the noise"; "" where all is noise.
std::string remainder(const Trace& trace);

}  // namespace bodeflow::residual
