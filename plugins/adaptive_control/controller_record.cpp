#include "controller_record.hpp"

#include <algorithm>

namespace bodeflow::adaptive_control {

RecordBuilder controller_record(const Rst& rst, double sample_time) {
  RecordBuilder r("controller");
  r.set("sample_time", sample_time);
  const auto put = [&](const char* name, const Coefficients& values, int n) {
    const auto to = r.array<double>(name, "", {static_cast<std::uint64_t>(n) + 1});
    std::copy_n(values.begin(), n + 1, to.begin());
  };
  put("R", rst.r, rst.n_r);
  put("S", rst.s, rst.n_s);
  put("T", rst.t, rst.n_t);
  return r;
}

}  // namespace bodeflow::adaptive_control
