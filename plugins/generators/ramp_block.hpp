#pragma once

#include <bodeflow/block.hpp>

namespace bodeflow::generators {

/// offset before a time, then a straight line, level again after its duration.
class Ramp final : public Block {
 public:
  static constexpr Out<double> out{0, "out"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void resolve(Facts& f) override;
  void process(Io& io) override;

 private:
  Rate rate_;
  std::string unit_;
  double time_s_ = 0.0, slope_ = 1.0, duration_s_ = 0.0, offset_ = 0.0;
};

}  // namespace bodeflow::generators
