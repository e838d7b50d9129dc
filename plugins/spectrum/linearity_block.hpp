#pragma once

#include <bodeflow/block.hpp>
#include <string>
#include <vector>

#include "linearity.hpp"

namespace bodeflow::spectrum {

/// spectrum.linearity: up to which amplitude a plant is linear.
class LinearityBlock final : public Block {
 public:
  static constexpr MessageIn in{0, "in"};
  static constexpr MessageOut out{0, "out"};
  static constexpr MessageOut change_out{1, "change"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void activate(const Activation& a) override;
  void receive(int port, const RecordView& record, Io& io) override;
  void finish(Io& io) override;
  void reset() override;

 private:
  std::vector<double> amplitudes() const;
  RecordBuilder record(const Linearity& found, const std::vector<std::string>& warnings) const;

  std::vector<double> levels_;
  double significance_ = 0.0;
  std::string parameter_;
  std::vector<ResponseData> responses_;
  std::string unit_;
};

}  // namespace bodeflow::spectrum
