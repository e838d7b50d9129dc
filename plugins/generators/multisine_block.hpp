#pragma once

#include <bodeflow/block.hpp>
#include <memory>
#include <string>

#include "experiments.hpp"
#include "line_choice.hpp"

namespace bodeflow::generators {

/// Periodic sums of cosines on chosen lines, computed once and played back: one signal, or an experiment for several inputs.
class Multisine final : public Block {
 public:
  static constexpr Out<double> out{0, "out"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void resolve(Facts& f) override;
  void activate(const Activation& a) override;
  void process(Io& io) override;

 private:
  void take_lines(const Parameters& p);
  void take_levels(const Parameters& p);
  void take_experiments(const Parameters& p);
  void require_preparable() const;
  void prepare(std::uint64_t seed);
  void note_signal(StreamFacts& facts);
  std::string summary() const;

  Rate rate_;
  std::string unit_;
  Design design_;
  std::int64_t length_ = -1;              // samples, -1: no end
  std::int64_t experiment_periods_ = -1;  // -1: one experiment without end
  bool own_seed_ = false;
  std::uint64_t seed_ = 0;
  std::unique_ptr<Experiments> signals_;
  std::uint64_t signals_seed_ = 0;
};

}  // namespace bodeflow::generators
