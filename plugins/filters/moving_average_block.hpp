#pragma once

#include <bodeflow/block.hpp>
#include <vector>

#include "moving_average.hpp"

namespace bodeflow::filters {

/// The mean of the last samples, channel by channel.
class MovingAverageBlock final : public Block {
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
  std::int64_t length_ = 1;
  double rate_hz_ = 0.0;
  int channels_ = 0;
  std::vector<MovingAverage> averages_;
};

}  // namespace bodeflow::filters
