#pragma once

#include <bodeflow/block.hpp>

#include "phase.hpp"

namespace bodeflow::generators {

/// offset + amplitude in the first part of each cycle, offset - amplitude in the rest.
class Square final : public Block {
 public:
  static constexpr Out<double> out{0, "out"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void resolve(Facts& f) override;
  void activate(const Activation& a) override;
  void process(Io& io) override;
  void change(const Parameters& p) override;
  void reset() override;

 private:
  struct Wave {
    double high = 1.0;
    double low = -1.0;
    std::uint64_t end_of_high = 0;  // units of 2^-64 cycles
  };
  Rate rate_;
  std::string unit_;
  std::int64_t period_ = 0;  // samples, 0: a frequency is given
  double start_phase_ = 0.0;
  Wave wave_;
  Phase phase_;
  Phase step_;
};

}  // namespace bodeflow::generators
