#pragma once

#include <Eigen/Core>
#include <bodeflow/error.hpp>
#include <cstdint>
#include <vector>

namespace bodeflow::spectrum {

/// How a local polynomial estimate is made.
struct LocalPolynomial {
  Eigen::Index order = 2;       ///< R >= 0 of the polynomials
  Eigen::Index half_width = 6;  ///< n: a fit takes 2n + 1 lines
  bool transient = true;        ///< whether a polynomial for the transient is fitted too

  /// Unknowns of a fit: (R + 1)(inputs + 1), (R + 1) inputs without transient.
  Eigen::Index unknowns(Eigen::Index inputs) const { return (order + 1) * (inputs + (transient ? 1 : 0)); }
  /// nu = 2n + 1 - unknowns.
  Eigen::Index degrees_of_freedom(Eigen::Index inputs) const { return 2 * half_width + 1 - unknowns(inputs); }
};

/// The smallest half-width that leaves at least 7 degrees of freedom: with them the 95 % radius is 1.11 times that of a known
/// variance.
Eigen::Index usual_half_width(const LocalPolynomial& settings, Eigen::Index inputs);

/// Spectra of whole records, lines 0 .. N/2 in rows, a channel in each column.
struct RecordSpectra {
  Eigen::MatrixXcd reference;  ///< empty: the inputs are known without noise; else as many columns as inputs
  Eigen::MatrixXcd input;
  Eigen::MatrixXcd output;
  std::int64_t samples = 0;  ///< N
};

/// A frequency response at the lines asked for that the excitation reaches. Column i * inputs + j.
struct LocalPolynomialEstimate {
  std::vector<std::int64_t> lines;
  std::vector<std::int64_t> silent_lines;  ///< left out: too little excitation around them to tell the unknowns apart
  Eigen::MatrixXcd response;
  Eigen::MatrixXd variance;         ///< E|dG|^2
  Eigen::MatrixXd noise_level;      ///< lines x outputs: rms of the noise at one line, in the scale of the spectra
  Eigen::MatrixXd transient_level;  ///< lines x outputs: |T|, likewise; empty without transient
  double degrees_of_freedom = 0.0;  ///< nu
  double least_input_ratio = 0.0;   ///< with a reference: least power of G_ur over its variance; else infinity
};

/// The frequency response by local polynomials, at each of `lines` (1 .. (N-1)/2, rising).
///
/// Around line k the plant and the transient (of plant and noise, leakage too: Y = G U + T + V holds exactly for any signal, T
/// smooth) are polynomials of the line:
///   Y(k+r) = sum_s g_s(k) r^s U(k+r) + sum_s t_s(k) r^s + V(k+r),   s = 0 .. R, r = -n .. n,
/// solved by least squares; G(k) = g_0(k). At the ends of the spectrum the 2n + 1 lines nearest to k inside 1 .. (N-1)/2 are
/// taken.
///   noise power of output i: sum_r |residual_i|^2 / nu,   var G_ij = noise power_i times the squared norm of G_ij's weights.
/// |dG|^2 / var G is F(2, 2 nu). Estimates less than 2n + 1 lines apart share data.
/// With a reference r (of a closed loop, or of a generator whose signal the input only follows with noise) the responses from r
/// to [y; u] are estimated so, and G = G_yr G_ur^-1, with dG = (dG_yr - G dG_ur) G_ur^-1.
///
/// Error of the method: what the polynomials of degree R leave of G and T over 2n + 1 lines, of the order of
/// ((n + 1/2) / bandwidth in lines)^(R+1), in the middle of the spectrum and for even R one power more. With R = 2 the height of
/// a resonance whose 3 dB bandwidth is 2n lines is wrong by 7 %, at 4n by 1.4 %; where that shows, the residuals and the variance
/// rise. The input must be rough from line to line (noise, a chirp over the record, a step in its middle): a spectrum as smooth
/// as T cannot be told from it, and the variance grows. Without reference the input must be known, and not be fed back from the
/// output.
///
/// References: R. Pintelon, J. Schoukens, System Identification: A Frequency Domain Approach, 2nd ed., Wiley 2012, chapter 7,
/// doi:10.1002/9781118287422; J. Schoukens, G. Vandersteen, K. Barbe, R. Pintelon, Nonparametric preprocessing in system
/// identification: a powerful tool, European Control Conference 2009.
/// Cost: a QR factorisation of (2n+1) x unknowns a line. Errors: nu below 1; fewer than 2n + 1 lines in the spectrum; no line
/// that is excited; values that are not finite.
Expected<LocalPolynomialEstimate> local_polynomial(const RecordSpectra& spectra, const std::vector<std::int64_t>& lines,
                                                   const LocalPolynomial& settings);

}  // namespace bodeflow::spectrum
