#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace bodeflow::tools {

/// The widest vector level of this processor: 1 (SSE2), 3 (AVX2 and FMA) or 4 (AVX-512 F, BW, CD, DQ, VL).
std::uint32_t processor_vector_level();

/// Names for --isa: "x86-64", "x86-64-v3", "x86-64-v4"; the level is the number they stand for.
std::vector<std::string> vector_level_names();
std::string vector_level_name(std::uint32_t level);
/// 0 for a name that is none.
std::uint32_t vector_level_of(const std::string& name);

}  // namespace bodeflow::tools
