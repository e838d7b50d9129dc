#pragma once

#include <bodeflow/block.hpp>
#include <string>
#include <vector>

#include "dynamics.hpp"
#include "sampled_plant.hpp"
#include "simulator.hpp"

namespace bodeflow::plants {

/// A linear plant behind a zero-order hold, exact at the sample times.
class Linear final : public Block {
 public:
  static constexpr In<double> in{0, "in"};
  static constexpr Out<double> out{0, "out"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void resolve(Facts& f) override;
  void activate(const Activation& a) override;
  void process(Io& io) override;
  void reset() override;

 private:
  void state_notes(const StreamFacts& u, StreamFacts& y) const;

  numerics::StateSpace model_;
  Dynamics dynamics_;
  double delay_s_ = 0.0;
  std::vector<double> initial_state_;
  std::string unit_;
  std::vector<std::string> output_names_;
  std::vector<std::string> output_units_;
  Simulator simulator_;
  std::vector<const double*> inputs_;
  std::vector<double*> outputs_;
};

}  // namespace bodeflow::plants
