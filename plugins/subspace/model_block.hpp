#pragma once

#include <bodeflow/block.hpp>
#include <optional>

#include "identification.hpp"
#include "measured_lines.hpp"

namespace bodeflow::subspace {

/// subspace.model: a state-space model of a frequency response by subspace identification.
class ModelBlock final : public Block {
 public:
  static constexpr MessageIn response{0, "response"};
  static constexpr MessageIn repeat{1, "repeat"};
  static constexpr MessageOut model{0, "model"};
  static constexpr MessageOut order_scan{1, "order_scan"};
  static constexpr MessageOut residual{2, "residual"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void receive(int port, const RecordView& record, Io& io) override;
  void finish(Io& io) override;
  void reset() override;

 private:
  Plane plane_for(const Lines& lines) const;

  Settings settings_;
  sanathanan_koerner::Selection selection_;
  Weighting weighting_ = Weighting::automatic;
  bool in_z_ = false;
  std::optional<double> prewarp_rad_s_;  // nothing: from the band
  std::optional<Measured> measured_, repeated_;
};

}  // namespace bodeflow::subspace
