#pragma once

#include <bodeflow/block.hpp>
#include <cstdint>

namespace bodeflow::filters {

/// Each sample `factor` times at `factor` times the rate.
class Hold final : public Block {
 public:
  static constexpr In<Any> in{0, "in"};
  static constexpr Out<Any> out{0, "out"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void resolve(Facts& f) override;
  void process(Io& io) override;

 private:
  template <class T>
  void repeat(Io& io) const;

  std::int64_t factor_ = 1;
};

}  // namespace bodeflow::filters
