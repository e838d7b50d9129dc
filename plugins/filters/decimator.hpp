#pragma once

#include <bodeflow/numerics/error.hpp>
#include <cstddef>
#include <span>
#include <vector>

namespace bodeflow::filters {

/// y[m] = sum_j h[j] x[m factor - j] for a symmetric h, computed only at the samples that are kept. One object a channel.
class Decimator {
 public:
  /// taps: h, of odd length and symmetric; max_outputs: most outputs of one `run`. Allocates all that is needed.
  Decimator(std::span<const double> taps, std::size_t factor, std::size_t max_outputs);

  /// Takes factor x y.size() samples, y.size() <= max_outputs. The sum of each output has one fixed order, whatever the calls'
  /// sizes.
  void run(std::span<const double> x, std::span<double> y);

  /// Back to a past of zeros.
  void reset();

 private:
  std::vector<double> taps_;
  std::size_t factor_;
  std::vector<double> frame_;  // the last taps - 1 samples, then those of the call
};

/// Coefficients of the anti-alias filter of a decimation: linear phase, gain 1 at zero frequency, 2 K factor + 1 taps with K
/// whole, so that its delay is K output samples. Pass band up to pass_band (0 to 1) of the new Nyquist frequency, stop band from
/// the new Nyquist frequency on with attenuation_db. Method: Kaiser-windowed sinc, designed with 2 dB to spare. Errors: those of
/// numerics::low_pass_half_length.
numerics::Expected<std::vector<double>> anti_alias_taps(std::size_t factor, double pass_band, double attenuation_db);

}  // namespace bodeflow::filters
