#pragma once

#include <bodeflow/block.hpp>
#include <vector>

namespace bodeflow::generators {

/// Rectangular pulses at stated times, once or periodically.
class Pulses final : public Block {
 public:
  static constexpr Out<double> out{0, "out"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void resolve(Facts& f) override;
  void process(Io& io) override;

 private:
  struct Pulse {
    std::uint64_t begin = 0, end = 0;
    double amplitude = 0.0;
  };
  void take_pulses(const Parameters& p);
  void take_period(const Parameters& p);
  double value(std::uint64_t n) const;

  Rate rate_;
  std::string unit_;
  double offset_ = 0.0;
  std::uint64_t period_ = 0;  // samples, 0: none
  std::vector<Pulse> pulses_;
};

}  // namespace bodeflow::generators
