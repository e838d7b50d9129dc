#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "bodeflow/numerics/error.hpp"
#include "bodeflow/numerics/iir_design.hpp"

/// Linear-phase filters h[0 .. taps - 1], h[j] = h[taps - 1 - j], of delay (taps - 1) / 2 samples. Frequencies are fractions of
/// the Nyquist frequency, 0 to 1.
namespace bodeflow::numerics {

enum class Window { rectangular, hann, hamming, blackman, kaiser };

/// The most coefficients of a filter by window, and of one by least squares (it solves as many equations as half of them).
inline constexpr int kMostTaps = 1 << 16;
inline constexpr int kMostLeastSquaresTaps = 1025;

/// The window of `length` samples, symmetric, 1 in the middle of an odd length; `beta` is that of a Kaiser window.
Eigen::VectorXd window(Window kind, Eigen::Index length, double beta = 8.0);

/// A filter by window: the ideal response, cut at `edges` (one for low and high pass) and faded out.
struct WindowDesign {
  Pass pass = Pass::low;
  int taps = 65;
  std::array<double, 2> edges{0.5, 0.0};
  Window shape = Window::hamming;
  double beta = 8.0;
};

/// The filter, with gain 1 at zero (low pass, band stop), at the Nyquist frequency (high pass) or in the middle of the band. The
/// gain at an edge is about 1/2, the width of the transition a few over `taps`. Errors: taps outside 1 .. kMostTaps, an even
/// number of taps of a filter that passes the Nyquist frequency (there it is always 0), edges not between 0 and 1 or not rising,
/// beta outside 0 .. 50.
Expected<Eigen::VectorXd> fir_by_window(const WindowDesign& design);

/// A band of a least-squares design: the wanted gain goes in a straight line from `from` at the edge `low` to `to` at `high`.
struct Band {
  double low = 0.0;
  double high = 1.0;
  double from = 1.0;
  double to = 1.0;
  double weight = 1.0;
};

/// The filter with the least sum over bands of weight * integral |H(f) - wanted(f)|^2 df; between bands nothing is asked for.
/// Method: the normal equations, whose integrals are known in closed form (T. W. Parks, C. S. Burrus, Digital Filter Design,
/// 1987, section 3.2); where they are singular in double precision (long filters, wide gaps) the solution of least norm, so gaps
/// stay small. Errors: taps outside 1 .. kMostLeastSquaresTaps, bands that are not 0 <= low < high <= 1, overlap or are not in
/// order, a weight not above 0, an even number of taps where a gain other than 0 is wanted at the Nyquist frequency.
Expected<Eigen::VectorXd> fir_by_least_squares(int taps, const std::vector<Band>& bands);

}  // namespace bodeflow::numerics
