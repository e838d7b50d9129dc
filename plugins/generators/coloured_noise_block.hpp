#pragma once

#include <bodeflow/block.hpp>
#include <bodeflow/numerics/linear_system.hpp>
#include <bodeflow/numerics/random.hpp>
#include <vector>

namespace bodeflow::generators {

/// White noise through a filter, stationary from the first sample; channel c is stream c of the seed.
class ColouredNoise final : public Block {
 public:
  static constexpr Out<double> out{0, "out"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void resolve(Facts& f) override;
  void activate(const Activation& a) override;
  void process(Io& io) override;
  void reset() override;

 private:
  struct Channel {
    numerics::Random random;
    Eigen::VectorXd state;
  };
  void take_filter(const Parameters& p);
  void take_level(const Parameters& p);
  double next(Channel& channel);

  Rate rate_;
  std::string unit_;
  int channels_ = 1;
  bool own_seed_ = false;
  std::uint64_t seed_ = 0;
  numerics::StateSpace filter_;
  Eigen::MatrixXd initial_;  // times white numbers: states as after a long time
  double scale_ = 1.0, mean_ = 0.0;
  std::vector<Channel> noise_;
  Eigen::VectorXd next_state_;
};

}  // namespace bodeflow::generators
