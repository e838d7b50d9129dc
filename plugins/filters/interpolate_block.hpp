#pragma once

#include <bodeflow/block.hpp>
#include <cstdint>
#include <vector>

#include "interpolator.hpp"

namespace bodeflow::filters {

/// A stream at a whole multiple of its rate, behind a linear-phase low-pass filter.
class Interpolate final : public Block {
 public:
  static constexpr In<double> in{0, "in"};
  static constexpr Out<double> out{0, "out"};
  static constexpr MessageOut filter{0, "filter"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void resolve(Facts& f) override;
  void activate(const Activation& a) override;
  void process(Io& io) override;
  void finish(Io& io) override;
  void reset() override;

 private:
  std::int64_t factor_ = 1;
  int channels_ = 0;
  double rate_hz_ = 0.0;  // of the output
  std::vector<double> taps_;
  std::vector<Interpolator> interpolators_;
};

}  // namespace bodeflow::filters
