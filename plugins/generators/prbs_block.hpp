#pragma once

#include <bodeflow/block.hpp>

#include "shift_register.hpp"

namespace bodeflow::generators {

/// A binary signal of maximal length, each bit held for some samples.
class Prbs final : public Block {
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
  // The state of the signal, a sample at a time.
  struct Bits {
    ShiftRegister source{kLeastBits};
    std::int64_t held = 0;  // samples that the bit goes on for
    bool value = false;
    bool inverted = false;

    bool next(std::int64_t hold, bool inverse_repeat);
  };
  std::int64_t period() const;
  Bits start() const;

  Rate rate_;
  std::string unit_;
  int bits_ = kLeastBits;
  std::int64_t hold_ = 1;
  bool inverse_repeat_ = false;
  std::int64_t first_bit_ = 0;
  std::int64_t length_ = -1;
  double low_ = -1.0, high_ = 1.0;
  Bits state_;
};

}  // namespace bodeflow::generators
