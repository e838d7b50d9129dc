#pragma once

#include <bodeflow/block.hpp>
#include <optional>

#include "measured.hpp"
#include "multi_band.hpp"

namespace bodeflow::sanathanan_koerner {

/// sanathanan_koerner.multi_band: a sum of models over bands, each fitted to what the others leave.
class MultiBandBlock final : public Block {
 public:
  static constexpr MessageIn response{0, "response"};
  static constexpr MessageOut model{0, "model"};
  static constexpr MessageOut log{1, "log"};
  static constexpr MessageOut residual{2, "residual"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void receive(int port, const RecordView& record, Io& io) override;
  void finish(Io& io) override;
  void reset() override;

 private:
  MultiBandSettings settings_;
  Selection selection_;
  std::optional<Measured> measured_;
};

}  // namespace bodeflow::sanathanan_koerner
