#pragma once

#include <bodeflow/block.hpp>
#include <complex>
#include <vector>

namespace bodeflow::adaptive_control {

/// The response of a known plant at the frequencies of fitting, as adaptive_control.estimator would give it.
class KnownResponse final : public Block {
 public:
  static constexpr In<double> y{0, "y"};
  static constexpr Out<std::complex<double>> response{0, "response"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void resolve(Facts& f) override;
  void activate(const Activation& a) override;
  void process(Io& io) override;

 private:
  std::vector<std::complex<double>> at(double sample_time) const;

  std::vector<double> omega_, numerator_, denominator_;
  double delay_s_ = 0.0;
  std::vector<std::complex<double>> points_;
};

}  // namespace bodeflow::adaptive_control
