#pragma once

#include <bodeflow/block.hpp>
#include <bodeflow/numerics/random.hpp>

namespace bodeflow::koopmans_levin {

/// koopmans_levin.decorrelated_noise: adds noise of exact variance, without correlation with the signals, to two streams.
class DecorrelatedNoise final : public Block {
 public:
  static constexpr In<double> input{0, "input"};
  static constexpr In<double> output{1, "output"};
  static constexpr Out<double> noisy_input{0, "noisy_input"};
  static constexpr Out<double> noisy_output{1, "noisy_output"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void resolve(Facts& f) override;
  void activate(const Activation& a) override;
  void process(Io& io) override;
  void reset() override;

 private:
  std::int64_t samples_ = 0;
  double input_variance_ = 0.0, output_variance_ = 0.0;
  bool own_seed_ = false;
  std::uint64_t seed_ = 0;
  numerics::Random random_{0};
};

}  // namespace bodeflow::koopmans_levin
