#pragma once

#include <bodeflow/block.hpp>
#include <bodeflow/numerics/random.hpp>
#include <vector>

namespace bodeflow::generators {

/// White noise; channel c is stream c of the seed.
class Noise final : public Block {
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
  struct Level {
    double std = 1.0;
    double mean = 0.0;
  };
  Rate rate_;
  std::string unit_;
  int channels_ = 1;
  bool normal_ = true;
  bool own_seed_ = false;
  std::uint64_t seed_ = 0;
  Level level_;
  std::vector<numerics::Random> random_;
};

}  // namespace bodeflow::generators
