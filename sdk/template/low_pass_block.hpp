#pragma once

#include <bodeflow/block.hpp>
#include <vector>

#include "low_pass.hpp"

/// Moves samples between the ports and one LowPass a channel.
class LowPassBlock final : public bodeflow::Block {
 public:
  static constexpr bodeflow::In<double> in{0, "in"};
  static constexpr bodeflow::Out<double> out{0, "out"};

  static void describe(bodeflow::Describe& d);
  void configure(const bodeflow::Parameters& p) override;
  void resolve(bodeflow::Facts& f) override;
  void activate(const bodeflow::Activation& a) override;
  void change(const bodeflow::Parameters& p) override;
  void process(bodeflow::Io& io) override;
  void reset() override;

 private:
  double corner_hz_ = 1.0;
  int channels_ = 0;
  std::vector<LowPass> filters_;
};
