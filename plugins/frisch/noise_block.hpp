#pragma once

#include <bodeflow/block.hpp>
#include <vector>

#include "band.hpp"
#include "noise_variances.hpp"

namespace bodeflow::frisch {

/// frisch.noise: the noise of input and output in each band, by the Frisch scheme and pooled.
class Noise final : public Block {
 public:
  static constexpr MessageIn matrix{0, "matrix"};
  static constexpr MessageOut out{0, "out"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void activate(const Activation& a) override;
  void receive(int port, const RecordView& record, Io& io) override;
  void finish(Io& io) override;
  void reset() override;

 private:
  double outliers_ = 0.0;
  OutlierMeasure measure_ = OutlierMeasure::determinant;
  std::vector<Band> bands_;
};

}  // namespace bodeflow::frisch
