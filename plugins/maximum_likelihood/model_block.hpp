#pragma once

#include <bodeflow/block.hpp>
#include <optional>
#include <string>
#include <vector>

#include "identification.hpp"
#include "measured.hpp"

namespace bodeflow::maximum_likelihood {

/// maximum_likelihood.model: a rational model of s or z, with delay, from a frequency response.
class ModelBlock final : public Block {
 public:
  static constexpr MessageIn response{0, "response"};
  static constexpr MessageOut model{0, "model"};
  static constexpr MessageOut order_scan{1, "order_scan"};
  static constexpr MessageOut residual{2, "residual"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void receive(int port, const RecordView& record, Io& io) override;
  void finish(Io& io) override;
  void reset() override;

 private:
  Settings settings_;
  std::string input_, band_;
  std::vector<std::string> outputs_;
  std::vector<double> bands_hz_;
  std::optional<Measured> measured_;
};

}  // namespace bodeflow::maximum_likelihood
