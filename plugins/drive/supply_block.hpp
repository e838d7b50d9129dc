#pragma once

#include <bodeflow/block.hpp>

namespace bodeflow::drive {

/// drive.supply: a balanced three-phase voltage, or a direct one.
class Supply final : public Block {
 public:
  static constexpr Out<double> out{0, "out"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void resolve(Facts& f) override;
  void process(Io& io) override;

 private:
  Rate rate_;
  double voltage_ = 0.0;
  double frequency_hz_ = 0.0;
};

}  // namespace bodeflow::drive
