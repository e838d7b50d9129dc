#pragma once

#include <bodeflow/block.hpp>
#include <optional>
#include <vector>

#include "change.hpp"

namespace bodeflow::validation {

/// Whether a plant has changed between two frequency responses.
class ChangeBlock final : public Block {
 public:
  static constexpr MessageIn before{0, "before"};
  static constexpr MessageIn after{1, "after"};
  static constexpr MessageIn repeat{2, "repeat"};
  static constexpr MessageOut out{0, "out"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void receive(int port, const RecordView& record, Io& io) override;
  void finish(Io& io) override;
  void reset() override;

 private:
  ChangeSettings settings_;
  Scatter stated_;

  std::optional<records::ResponseData> before_, after_;
  std::vector<records::ResponseData> repeats_;
};

}  // namespace bodeflow::validation
