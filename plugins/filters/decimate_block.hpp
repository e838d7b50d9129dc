#pragma once

#include <bodeflow/block.hpp>
#include <cstdint>
#include <vector>

#include "decimator.hpp"

namespace bodeflow::filters {

/// Every factor-th sample of a stream, behind a linear-phase low-pass filter.
class Decimate final : public Block {
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
  double rate_hz_ = 1.0;
  std::vector<double> taps_;
  std::vector<Decimator> decimators_;
};

}  // namespace bodeflow::filters
