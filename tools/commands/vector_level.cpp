#include "commands/vector_level.hpp"

namespace bodeflow::tools {

std::uint32_t processor_vector_level() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512cd") &&
      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
    return 4;
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return 3;
#endif
  return 1;
}

std::vector<std::string> vector_level_names() { return {"x86-64", "x86-64-v3", "x86-64-v4"}; }

std::string vector_level_name(std::uint32_t level) { return level == 4 ? "x86-64-v4" : level == 3 ? "x86-64-v3" : "x86-64"; }

std::uint32_t vector_level_of(const std::string& name) {
  for (const std::uint32_t level : {1U, 3U, 4U})
    if (name == vector_level_name(level)) return level;
  return 0;
}

}  // namespace bodeflow::tools
