#pragma once

#include <complex>
#include <cstdint>
#include <span>
#include <vector>

#include "settling.hpp"
#include "sine_response.hpp"
#include "sine_window.hpp"

namespace bodeflow::spectrum {

/// When an answer counts as settled.
struct SettlingRule {
  enum class Kind {
    envelope,  ///< all coefficients of all outputs stay within settling_threshold, at each sample
    repeat,    ///< the amplitudes of successive windows agree within `tolerance` of themselves, input and outputs
  };
  Kind kind = Kind::envelope;
  double factor = 6 * 1.6;    ///< envelope: see settling_threshold
  std::vector<double> noise;  ///< envelope: standard deviation of each output's samples
  double tolerance = 1e-3;    ///< repeat
};

/// The measurement at one frequency while the samples come in: correlates each signal with m cycles in windows of N samples, and
/// tells from where on the answer has settled (both ways of Jue, section 3.2). Signal 0 is the input, the others are outputs.
/// Cost: O(signals) a sample; memory: N samples a signal, an amplitude a window, and the places of SettledStretch.
class SineDwell {
 public:
  SineDwell(std::int64_t window, std::int64_t cycles, std::size_t outputs, const SettlingRule& rule);

  /// Takes one sample of each signal, finite. True where a window is complete with it.
  bool push(std::span<const double> sample);

  std::int64_t samples() const { return samples_; }
  /// Whole windows so far.
  std::int64_t windows() const { return samples_ / window_; }
  /// Samples before the answer had settled, as it looks by now.
  std::int64_t settled_from() const;
  /// Whole windows after that.
  std::int64_t settled_windows() const;

  /// The response from the last `count` whole windows. Errors: those of sine_response; an input that does not hold the frequency.
  Expected<SineResponse> estimate(std::int64_t count) const;

 private:
  void compare_windows();

  std::int64_t window_;
  SettlingRule rule_;
  SineTable table_;
  std::vector<SineWindow> sums_;                  // one a signal
  std::vector<SettledStretch> stretches_;         // two an output
  std::vector<std::complex<double>> amplitudes_;  // signals of window 0, of window 1, ...
  std::size_t at_ = 0;                            // in the window
  std::int64_t samples_ = 0;
  std::int64_t agreeing_from_ = 0;  // repeat: the first of the windows that agree with each other
  double peak_ = 0.0;               // of the input
};

}  // namespace bodeflow::spectrum
