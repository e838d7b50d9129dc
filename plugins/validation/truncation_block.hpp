#pragma once

#include <bodeflow/block.hpp>
#include <optional>

#include "records/model.hpp"
#include "records/response.hpp"

namespace bodeflow::validation {

/// A model with fewer states, and how far it is from data.
class Truncation final : public Block {
 public:
  static constexpr MessageIn model{0, "model"};
  static constexpr MessageIn response{1, "response"};
  static constexpr MessageOut out{0, "out"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void receive(int port, const RecordView& record, Io& io) override;
  void finish(Io& io) override;
  void reset() override;

 private:
  Eigen::Index states_ = 1;

  std::optional<records::ModelData> model_;
  std::optional<records::ResponseData> response_;
};

}  // namespace bodeflow::validation
