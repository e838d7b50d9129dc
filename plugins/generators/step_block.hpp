#pragma once

#include <bodeflow/block.hpp>

namespace bodeflow::generators {

/// offset before a time, offset + amplitude from then on.
class Step final : public Block {
 public:
  static constexpr Out<double> out{0, "out"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void resolve(Facts& f) override;
  void process(Io& io) override;
  void change(const Parameters& p) override;

 private:
  Rate rate_;
  std::string unit_;
  std::uint64_t first_ = 0;
  double before_ = 0.0, after_ = 1.0;
};

}  // namespace bodeflow::generators
