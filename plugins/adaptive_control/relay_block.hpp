#pragma once

#include <bodeflow/block.hpp>
#include <optional>

#include "relay.hpp"

namespace bodeflow::adaptive_control {

/// A relay experiment in a loop: the oscillation's frequency, the response there, the delay, and a plan for the adaptive loop.
class Relay final : public Block {
 public:
  static constexpr In<double> setpoint{0, "setpoint"}, y{1, "y"};
  static constexpr Out<double> u{0, "u"};
  static constexpr MessageOut result{0, "result"}, plan{1, "plan"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void resolve(Facts& f) override;
  void activate(const Activation& a) override;
  void process(Io& io) override;
  void finish(Io& io) override;
  void reset() override;

 private:
  RelaySettings settings_;
  int points_ = 3;
  double bandwidth_share_ = 0.75, gain_share_ = 0.35, sample_time_ = 1.0;
  std::string unit_;
  std::optional<RelayExperiment> experiment_;
};

}  // namespace bodeflow::adaptive_control
