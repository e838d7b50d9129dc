#pragma once

#include <bodeflow/block.hpp>
#include <optional>

#include "records/model.hpp"

namespace bodeflow::plants {

/// The frequency response of a known model, with noise of a stated size.
class ResponseBlock final : public Block {
 public:
  static constexpr MessageIn model{0, "model"};
  static constexpr MessageOut out{0, "out"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void activate(const Activation& a) override;
  void receive(int port, const RecordView& record, Io& io) override;
  void finish(Io& io) override;
  void reset() override;

 private:
  Eigen::VectorXd frequency_hz_;
  double relative_ = 0.0, absolute_ = 0.0, scatter_ = 0.0;
  bool state_variance_ = true, own_seed_ = false;
  std::uint64_t seed_ = 0;

  std::optional<records::ModelData> model_;
};

}  // namespace bodeflow::plants
