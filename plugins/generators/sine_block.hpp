#pragma once

#include <bodeflow/block.hpp>

#include "phase.hpp"

namespace bodeflow::generators {

/// y[n] = offset + amplitude sin(2 pi frequency n / sample_rate + phase).
class Sine final : public Block {
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
    double frequency = 0.0;
    double amplitude = 1.0;
    double offset = 0.0;
  };
  Rate rate_;
  std::string unit_;
  double start_phase_ = 0.0;
  Wave wave_;
  Phase phase_;
  Phase step_;
};

}  // namespace bodeflow::generators
