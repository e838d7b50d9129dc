#pragma once

#include <bodeflow/block.hpp>

namespace bodeflow::drive {

/// drive.friction_feed_forward: the torque that dry friction takes, from the measured speed.
class FrictionFeedForward final : public Block {
 public:
  static constexpr In<double> speed{0, "speed"};
  static constexpr Out<double> out{0, "out"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void resolve(Facts& f) override;
  void process(Io& io) override;
  void change(const Parameters& p) override;

 private:
  double torque_ = 0.0, threshold_ = 0.0;
};

}  // namespace bodeflow::drive
