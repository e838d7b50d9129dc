#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

/// When a sine response has settled: the envelope test of a stepped-sine measurement.
namespace bodeflow::spectrum {

/// Coefficients of y[n] = A cos(theta n) + B sin(theta n) + rest, theta = 2 pi m / N, over each stretch of N samples:
/// a[p] = 2/N sum_{k=p}^{p+N-1} cos(theta k) y[k], b[p] likewise with sin, p = 0 .. samples - N.
struct Correlation {
  std::vector<double> a;
  std::vector<double> b;
};

/// The correlation of `y` with the sine of `cycles` whole cycles in a window of `window` samples, at each place of the window;
/// empty where y is shorter than the window. Requires 1 <= cycles < window / 2. Noise of standard deviation sigma in y gives a
/// and b the standard deviation sigma sqrt(2 / window).
///
/// Source: D. A. Jue, Frequency domain system identification with a rational, multi-band, curve-fitting approach, 1998, equation
/// (9), with two corrections: the sum has N terms (N + 1 are printed), and the argument is omega k Ts. An offset falls out
/// exactly; harmonics do, too, below the Nyquist frequency. For an input u[n] = sin(theta n) the response is G = B + jA, for u[n]
/// = cos(theta n) it is G = A - jB. Cost: O(samples). The running sums are replaced by fresh ones each window, so rounding does
/// not add up.
Correlation sliding_correlation(std::span<const double> y, std::int64_t window, std::int64_t cycles);

/// delta[p] = max a[q] - min a[q] over q >= p: what the coefficient still moves from p on. Never rises; the last is 0.
std::vector<double> envelope(std::span<const double> a);

/// The first p from which on both coefficients stay within `threshold`: delta[p] <= threshold for a and for b, the later of the
/// two. Because delta ends at 0 there always is one: look at how much is left behind it. 0 for an empty correlation.
std::size_t settled_from(const Correlation& correlation, double threshold);

/// `factor` times the standard deviation of a coefficient, sigma sqrt(2 / window).
///
/// The printed test takes 6 sigma, sigma being that of the samples: sqrt(window / 2) times too much, so a transient far above the
/// noise counts as settled. 6 standard deviations of the coefficient are the range of some 300 independent values; the default of
/// 6 * 1.6 leaves room for 1e5 and more, so that noise alone does not hold the test up.
double settling_threshold(double sigma, std::int64_t window, double factor = 6 * 1.6);

/// The mean of v from `from` on; v must be longer than that.
double mean_from(std::span<const double> v, std::size_t from);

/// The envelope test while the data comes in: the first place from which on all values up to the newest stay within `range`.
/// Equal to the first p with delta[p] <= range of all values so far. Cost: O(1) a value on average; memory: at most the values
/// from that place on.
class SettledStretch {
 public:
  explicit SettledStretch(double range) : range_(range) {}
  void push(double value);
  /// The place, counted from the first value pushed; 0 before.
  std::size_t from() const { return from_; }

 private:
  struct Place {
    std::size_t at;
    double value;
  };
  double range_;
  std::size_t pushed_ = 0;
  std::size_t from_ = 0;
  std::deque<Place> falling_;  // candidates for the largest from here on
  std::deque<Place> rising_;   // for the smallest
};

}  // namespace bodeflow::spectrum
