#pragma once

#include <bodeflow/block.hpp>
#include <complex>

namespace bodeflow::drive {

/// drive.power_meter: voltage, current, power and impedance of a phase at one frequency.
class PowerMeter final : public Block {
 public:
  static constexpr In<double> voltage{0, "voltage"};
  static constexpr In<double> current{1, "current"};
  static constexpr MessageOut out{0, "out"};

  static void describe(Describe& d);
  void configure(const Parameters& p) override;
  void resolve(Facts& f) override;
  void activate(const Activation&) override { reset(); }
  void process(Io& io) override;
  void finish(Io& io) override;
  void reset() override;

 private:
  std::complex<double> sample(Io& io, In<double> port, std::size_t n) const;

  double frequency_hz_ = 0.0, skip_s_ = 0.0;
  bool holds_ = true;
  int channels_ = 1;
  double rate_hz_ = 0.0;
  std::uint64_t cycle_ = 1, skip_ = 0;       // samples
  std::uint64_t in_cycle_ = 0, cycles_ = 0;  // measured
  std::complex<double> cycle_u_, cycle_i_;   // sums of the cycle that runs
  std::complex<double> sum_u_, sum_i_;       // of whole cycles
};

}  // namespace bodeflow::drive
