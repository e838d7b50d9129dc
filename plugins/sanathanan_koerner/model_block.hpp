#pragma once

#include <bodeflow/block.hpp>
#include <optional>

#include "measured.hpp"
#include "method.hpp"

namespace bodeflow::sanathanan_koerner {

/// sanathanan_koerner.model: a rational model of a frequency response of any order, of one or several inputs and outputs.
class ModelBlock final : public Block {
 public:
  static constexpr MessageIn response{0, "response"};
  static constexpr MessageIn repeat{1, "repeat"};
  static constexpr MessageOut model{0, "model"};
  static constexpr MessageOut order_scan{1, "order_scan"};
  static constexpr MessageOut residual{2, "residual"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void receive(int port, const RecordView& record, Io& io) override;
  void finish(Io& io) override;
  void reset() override;

 private:
  Settings settings_;
  bool in_z_ = false;
  Selection selection_;
  std::optional<Measured> measured_, repeated_;
};

}  // namespace bodeflow::sanathanan_koerner
