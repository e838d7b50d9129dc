#pragma once

#include <bodeflow/block.hpp>
#include <string>
#include <vector>

namespace bodeflow::drive {

/// Sends other properties of a bench at a stated time.
class PropertyChange final : public Block {
 public:
  static constexpr In<Any> clock{0, "clock"};
  static constexpr MessageOut out{0, "out"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void activate(const Activation& a) override;
  void process(Io& io) override;

 private:
  std::vector<std::string> names_;
  std::vector<double> values_;
  double time_s_ = 0.0;
  std::uint64_t at_ = 0;
};

}  // namespace bodeflow::drive
