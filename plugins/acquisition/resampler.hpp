#pragma once

#include <bodeflow/numerics/error.hpp>
#include <cstdint>
#include <span>
#include <vector>

namespace bodeflow::acquisition {

/// What a resampler is to do.
struct ResamplerSpec {
  std::int64_t up = 1, down = 1;  ///< output rate / input rate, in lowest terms
  double drift = 0.0;             ///< the input's clock runs at 1 + drift times its stated rate, by the clock of the output
  double pass_band = 0.8;         ///< of the lower one of both Nyquist frequencies
  double attenuation_db = 100.0;
  std::int64_t buffer = 0;  ///< input samples by which drift may displace input and output
};

/// How it is done: sizes that follow from a specification.
struct ResamplerPlan {
  ResamplerSpec spec;
  std::int64_t phases = 1;  ///< of the interpolation filter, a sampling interval of the input
  std::int64_t half = 0;    ///< taps on each side of the middle, `phases` a sampling interval
  std::int64_t reach = 0;   ///< input samples on each side of an output sample
  std::int64_t delay = 0;   ///< whole output samples by which the output is late
  std::int64_t past = 0;    ///< input samples to keep

  /// True if samples pass as they are: equal rates, no drift.
  bool is_wire() const { return phases == 1 && half == 0; }
};

/// The plan for a specification; cheap. Errors: those of numerics::low_pass_half_length, rates beyond kMostPhases.
numerics::Expected<ResamplerPlan> plan_resampler(const ResamplerSpec& spec);

/// More phases, or a longer firing, are refused: a ratio of two rates that are not simple to each other.
inline constexpr std::int64_t kMostPhases = 16384;

/// Band-limited interpolation of a stream: y[m] = sum_n x[n] h(p_m - n), p_m = (m - delay) (down / up) (1 + drift), h a
/// Kaiser-windowed sinc with gain 1 at zero frequency.
///
/// Without drift the positions repeat after `up` outputs and h stands in a table: exact polyphase filtering. With drift h is
/// interpolated between 256 phases by cubics, which adds less than -170 dB. Positions come from the index of the sample alone, so
/// nothing adds up over time. Pass band: up to pass_band of the lower Nyquist frequency, ripple at most
/// 2 * 10^(-attenuation / 20); stop band: from the lower Nyquist frequency on, so nothing folds down. The past of the stream is
/// 0. Reference: R. E. Crochiere, L. R. Rabiner, Multirate Digital Signal Processing, 1983, chapter 2; J. O. Smith, P. Gossett, A
/// flexible sampling-rate conversion method, ICASSP 1984.
class Resampler {
 public:
  /// max_count: most firings of one `run`; a firing takes `down` samples and gives `up`. Allocates all that is needed.
  Resampler(const ResamplerPlan& plan, std::int64_t channels, std::int64_t max_count);

  /// The outputs of y.size() / up firings of one channel, from firing `first` on. False: drift has used the buffer up; outputs
  /// from there on are 0.
  bool run(std::int64_t channel, std::int64_t first, std::span<const double> x, std::span<double> y);

  /// Back to a past of zeros.
  void reset();

 private:
  /// The last samples of one channel.
  struct Frame {
    std::vector<double> samples;
    std::int64_t begin = 0;  ///< index of the first in the stream
    std::int64_t end = 0;    ///< behind the last
  };

  void append(Frame& frame, std::span<const double> x) const;
  double at_phase(const Frame& frame, std::int64_t whole, std::int64_t phase) const;

  ResamplerPlan plan_;
  std::vector<double> table_;  // phases -1 .. phases + 1, each 2 reach + 1 values
  std::vector<Frame> frames_;
};

}  // namespace bodeflow::acquisition
