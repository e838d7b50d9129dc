#pragma once

#include <Eigen/Core>
#include <bodeflow/block.hpp>
#include <bodeflow/numerics/fir_design.hpp>
#include <string>
#include <vector>

#include "fir_filter.hpp"

namespace bodeflow::filters {

/// A linear-phase filter by window or by least squares, or any finite impulse response, on every channel.
class Fir final : public Block {
 public:
  static constexpr In<double> in{0, "in"};
  static constexpr Out<double> out{0, "out"};
  static constexpr MessageOut filter{0, "filter"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void resolve(Facts& f) override;
  void advise(const Facts& f, Advice& a) override;
  void activate(const Activation& a) override;
  void process(Io& io) override;
  void finish(Io& io) override;
  void reset() override;

 private:
  void configure_bands(const Parameters& p);
  Eigen::VectorXd design(double rate_hz) const;

  std::string method_;
  numerics::WindowDesign window_;
  std::vector<double> edges_hz_;
  std::vector<numerics::Band> bands_hz_;
  Eigen::VectorXd given_, taps_;
  double rate_hz_ = 0.0;
  int channels_ = 0;
  int vector_level_ = 1;
  std::vector<FirFilter> filters_;
};

}  // namespace bodeflow::filters
