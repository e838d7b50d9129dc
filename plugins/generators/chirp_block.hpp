#pragma once

#include <bodeflow/block.hpp>

#include "sweep.hpp"

namespace bodeflow::generators {

/// A sine whose frequency sweeps from one value to another within a period, once or again and again.
class Chirp final : public Block {
 public:
  static constexpr Out<double> out{0, "out"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void resolve(Facts& f) override;
  void process(Io& io) override;
  void change(const Parameters& p) override;

 private:
  double value(std::uint64_t n) const;

  struct Wave {
    double amplitude = 1.0;
    double offset = 0.0;
  };
  Rate rate_;
  std::string unit_;
  std::uint64_t period_ = 1;
  bool repeat_ = true;
  std::int64_t length_ = -1;
  double start_cycles_ = 0.0;
  Sweep sweep_;
  Wave wave_;
};

}  // namespace bodeflow::generators
