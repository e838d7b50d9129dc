#pragma once

#include <bodeflow/block.hpp>
#include <bodeflow/record_builder.hpp>
#include <optional>
#include <string>
#include <vector>

#include "records/recording.hpp"
#include "trace/told_model.hpp"

namespace bodeflow::residual {

/// residual.remeasure: the error of the base model on a record that was measured with the remedy.
class Remeasure final : public Block {
 public:
  static constexpr MessageIn trace{0, "trace"};
  static constexpr MessageIn remedy{1, "remedy"};
  static constexpr MessageIn in{2, "in"};
  static constexpr MessageOut out{0, "out"};

  static void describe(Describe& d);
  void receive(int port, const RecordView& record, Io& io) override;
  void finish(Io& io) override;
  void reset() override;

 private:
  struct Remedy {
    std::vector<std::string> effects;
    std::string sentence;
  };
  std::vector<std::size_t> remedied() const;

  std::optional<ToldModel> told_;
  std::optional<RecordBuilder> whole_;
  double before_ = 0.0;
  std::optional<Remedy> remedy_;
  std::optional<records::Recording> recording_;
};

}  // namespace bodeflow::residual
