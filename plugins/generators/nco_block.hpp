#pragma once

#include <bodeflow/block.hpp>
#include <optional>

#include "digital_oscillator.hpp"

namespace bodeflow::generators {

/// A sine as a numerically controlled oscillator makes it: direct digital synthesis with its spurs.
class Nco final : public Block {
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
  Rate rate_;
  std::string unit_;
  int accumulator_bits_ = 32;
  std::optional<DigitalOscillator> oscillator_;
  double start_phase_ = 0.0, amplitude_ = 1.0, offset_ = 0.0;
  std::uint64_t word_ = 0;
  bool dither_ = false, own_seed_ = false;
  std::uint64_t seed_ = 0;
  numerics::Random random_{0};
};

}  // namespace bodeflow::generators
