#pragma once

#include <bodeflow/block.hpp>
#include <string>

#include "blocks/amplitude.hpp"

namespace bodeflow::residual {

/// residual.amplitude: the amplitude for the next experiment from a pilot.
class AmplitudeBlock final : public Block {
 public:
  static constexpr MessageIn in{0, "in"};
  static constexpr MessageOut out{0, "out"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void receive(int port, const RecordView& record, Io& io) override;

 private:
  std::string parameter_;
  double pilot_ = 1.0;
  AmplitudeWish wish_;
};

}  // namespace bodeflow::residual
