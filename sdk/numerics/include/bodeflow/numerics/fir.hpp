#pragma once

#include <Eigen/Core>
#include <complex>
#include <cstddef>

#include "bodeflow/numerics/error.hpp"

/// Linear-phase finite impulse response filters. Frequencies are fractions of the Nyquist frequency, 0 to 1.
namespace bodeflow::numerics {

/// The modified Bessel function I_0(x), by its power series, to rounding for |x| <= 50.
double bessel_i0(double x);

/// The Kaiser window of `length` samples, 1 in the middle.
Eigen::VectorXd kaiser_window(Eigen::Index length, double beta);

/// The shape parameter beta of a Kaiser window for a stop-band attenuation in dB (Kaiser, "Nonrecursive digital filter design
/// using the I0-sinh window function", Proc. IEEE Symp. Circuits and Systems, 1974).
double kaiser_beta(double attenuation_db);

/// The coefficients h[0 .. 2 half] of a low-pass filter with gain 1 at zero frequency: h[j] = h[2 half - j], group delay `half`
/// samples.
struct LowPass {
  double pass_edge = 0.0;
  double stop_edge = 1.0;
  double attenuation_db = 80.0;
};

/// The smallest `half` with which `low_pass` meets the design (Kaiser's formula for the length, rounded up).
/// Errors: edges not 0 < pass_edge < stop_edge <= 1, an attenuation outside 21 .. 200 dB, more than 2^26 taps.
Expected<Eigen::Index> low_pass_half_length(const LowPass& design);

/// The coefficients of a windowed-sinc low-pass of 2 half + 1 taps: cut-off in the middle of the transition band, Kaiser window.
/// The pass band ripples by up to twice what the stop band lets through (80 dB: 2e-4). Bias: at exactly the length of
/// low_pass_half_length Kaiser's formula is good to about 1 dB, so a design adds 2 dB where the figure must be kept. With a stop
/// edge within a transition band's width of the Nyquist frequency the mirrored skirt adds up to 6 dB.
Eigen::VectorXd low_pass(const LowPass& design, Eigen::Index half);

/// sum_j a[j] b[j], j < count: one output of a filter. Eight partial sums in a fixed order: wide registers are used, and the
/// bits do not depend on how wide they are.
double dot(const double* a, const double* b, std::size_t count);

/// H(exp(j pi f)) = sum_j h[j] exp(-j pi f j) at a fraction f of the Nyquist frequency.
std::complex<double> fir_response(const Eigen::VectorXd& taps, double fraction_of_nyquist);

}  // namespace bodeflow::numerics
