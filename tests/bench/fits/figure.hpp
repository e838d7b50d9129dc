#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <string>

// A table of acceptance figures, each beside its limit. The limits are tests of plugins/sanathanan_koerner and plugins/subspace
// too; figures beside peers come from bench_fits.
namespace bench {

inline void heading() { fmt::print("{:<82}{:>11}{:>11}{:>11}\n", "", "found", "limit", "CPU ms"); }

/// limit: the figure must not be above it.
inline void figure(const std::string& name, double found, double limit, double cpu_ms = -1.0) {
  const std::string cpu = cpu_ms < 0.0 ? "" : fmt::format("{:.4g}", cpu_ms);
  fmt::print("{:<82}{:>11.3g}{:>11.3g}{:>11}{}\n", name, found, limit, cpu, found <= limit ? "" : "  MISSED");
  std::fflush(stdout);
}

}  // namespace bench
