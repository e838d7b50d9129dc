#pragma once

#include <bodeflow/block.hpp>
#include <vector>

#include "records.hpp"

namespace bodeflow::spectrum {

/// spectrum.merge: one frequency response from those of several experiments or bands.
class MergeBlock final : public Block {
 public:
  static constexpr MessageIn in{0, "in"};
  static constexpr MessageOut out{0, "out"};

  static void describe(Describe& d);
  void receive(int port, const RecordView& record, Io& io) override;
  void finish(Io& io) override;
  void reset() override;

 private:
  std::vector<ResponseData> experiments_;
};

}  // namespace bodeflow::spectrum
