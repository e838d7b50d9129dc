#pragma once

#include <bodeflow/block.hpp>
#include <memory>
#include <optional>

#include "base_model.hpp"
#include "catalogue.hpp"
#include "trace.hpp"

namespace bodeflow::residual {

/// residual.trace: names the physical effect that a declared model lacks.
class TraceBlock final : public Block {
 public:
  static constexpr MessageIn fit{0, "fit"};
  static constexpr MessageIn select{1, "select"};
  static constexpr MessageIn test{2, "test"};
  static constexpr MessageOut out{0, "out"};
  static constexpr MessageOut base{1, "base_model"};
  static constexpr MessageOut extended{2, "extended_model"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void receive(int port, const RecordView& record, Io& io) override;
  void finish(Io& io) override;
  void reset() override;

 private:
  TraceData data() const;

  std::unique_ptr<const BaseModel> base_;
  Catalogue catalogue_;
  TraceSettings settings_;
  std::vector<Experiment> fit_;
  std::optional<Experiment> select_, test_;
};

}  // namespace bodeflow::residual
