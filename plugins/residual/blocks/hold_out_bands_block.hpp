#pragma once

#include <bodeflow/block.hpp>
#include <cstdint>

namespace bodeflow::residual {

/// residual.hold_out_bands: shares out the lines of a measured response for fitting and selecting.
class HoldOutBands final : public Block {
 public:
  static constexpr MessageIn in{0, "in"};
  static constexpr MessageOut kept{0, "kept"};
  static constexpr MessageOut held_out{1, "held_out"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void receive(int port, const RecordView& record, Io& io) override;

 private:
  double octaves_ = 1.0 / 3.0;
  std::int64_t every_ = 3;
};

}  // namespace bodeflow::residual
