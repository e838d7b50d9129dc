#pragma once

#include <bodeflow/block.hpp>
#include <bodeflow/record_builder.hpp>
#include <optional>
#include <string>
#include <vector>

#include "blocks/given_records.hpp"

namespace bodeflow::residual {

/// residual.trace: names the physical effects that a declared model lacks.
class TraceBlock final : public Block {
 public:
  static constexpr MessageIn fit{0, "fit"};
  static constexpr MessageIn select{1, "select"};
  static constexpr MessageIn test{2, "test"};
  static constexpr MessageIn model{3, "model"};
  static constexpr MessageOut out{0, "out"};
  static constexpr MessageOut base{1, "base_model"};
  static constexpr MessageOut extended{2, "extended_model"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void receive(int port, const RecordView& record, Io& io) override;
  void finish(Io& io) override;
  void reset() override;

 private:
  std::string base_;
  std::vector<std::string> declare_, effects_, without_, known_;
  Engine engine_ = Engine::automatic;
  double segment_s_ = 0.0, test_segment_s_ = 0.0;
  TraceSettings settings_;
  GivenRecords given_;
  std::optional<RecordBuilder> model_;
};

}  // namespace bodeflow::residual
