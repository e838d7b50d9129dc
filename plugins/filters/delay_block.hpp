#pragma once

#include <bodeflow/block.hpp>
#include <cstdint>
#include <vector>

namespace bodeflow::filters {

/// y[n] = x[n - samples]; the samples stand on the input's edge, so the block has no state and may close a loop.
class Delay final : public Block {
 public:
  static constexpr In<Any> in{0, "in"};
  static constexpr Out<Any> out{0, "out"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void resolve(Facts& f) override;
  void process(Io& io) override;

 private:
  std::vector<double> initial_values(const StreamFacts& input) const;

  std::int64_t samples_ = 1;
  std::vector<double> initial_;
};

}  // namespace bodeflow::filters
