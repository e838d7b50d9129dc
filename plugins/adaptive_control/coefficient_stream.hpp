#pragma once

#include <string>
#include <vector>

#include "rst.hpp"

namespace bodeflow::adaptive_control {

/// The note of a control signal that tells its limits: least and greatest value.
inline constexpr const char* kLimitsNote = "control.limits";

/// The channels of a stream of controllers: r1 .. r_nr, s0 .. s_ns, t0 .. t_nt, a1 .. a_nr (anti-windup).
struct CoefficientStream {
  int n_r = 0, n_s = 0, n_t = 0;

  int channels() const { return 2 * n_r + n_s + n_t + 2; }
  std::vector<std::string> names() const {
    std::vector<std::string> names;
    const auto add = [&](const char* letter, int from, int to) {
      for (int i = from; i <= to; ++i) names.push_back(letter + std::to_string(i));
    };
    add("r", 1, n_r);
    add("s", 0, n_s);
    add("t", 0, n_t);
    add("a", 1, n_r);
    return names;
  }
  /// As the stream's note `rst.degrees`.
  std::vector<double> note() const { return {1.0 * n_r, 1.0 * n_s, 1.0 * n_t}; }
};

}  // namespace bodeflow::adaptive_control
