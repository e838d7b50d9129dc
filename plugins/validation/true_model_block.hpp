#pragma once

#include <bodeflow/block.hpp>
#include <optional>

#include "records/model.hpp"
#include "records/response.hpp"

namespace bodeflow::validation {

/// validation.true_model: the model that a bench simulates, and how far a measured response is from it.
class TrueModel final : public Block {
 public:
  static constexpr MessageIn response{0, "response"};
  static constexpr MessageOut model{0, "model"};
  static constexpr MessageOut error{1, "error"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void receive(int port, const RecordView& record, Io& io) override;
  void finish(Io& io) override;
  void reset() override;

 private:
  records::ModelData truth_;
  std::optional<records::ResponseData> found_;
};

}  // namespace bodeflow::validation
