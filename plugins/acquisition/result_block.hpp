#pragma once

#include <bodeflow/block.hpp>
#include <optional>

namespace bodeflow::acquisition {

/// acquisition.result: a record that an earlier run left.
class ResultBlock final : public Block {
 public:
  static constexpr MessageOut out{0, "out"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void finish(Io& io) override;

 private:
  std::optional<RecordBuilder> record_;
};

}  // namespace bodeflow::acquisition
