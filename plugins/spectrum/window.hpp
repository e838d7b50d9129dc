#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

/// Windows for averaged spectra.
namespace bodeflow::spectrum {

/// What `window` knows: hann, hamming, blackman, blackman_harris, flat_top, rectangular.
const std::vector<std::string>& window_names();

/// The window of that name over one segment, periodic (w[0] continues w[length]), greatest value 1.
/// Method: w[n] = sum_m (-1)^m a_m cos(2 pi m n / length).
/// Reference: F. J. Harris, On the use of windows for harmonic analysis, Proc. IEEE 66 (1978) 51, doi:10.1109/PROC.1978.10837
/// (hann, hamming, blackman, 4-term blackman_harris); flat_top: G. D'Antona, A. Ferrero, Digital Signal Processing for
/// Measurement Systems, 2006, section 3.6. The flat top's coefficients sum to 1.000000003.
/// name: one of window_names().
Eigen::VectorXd window(const std::string& name, Eigen::Index length);

/// The equivalent noise bandwidth in lines: N sum w^2 / (sum w)^2; rectangular 1, hann 1.5.
double noise_bandwidth_lines(const Eigen::VectorXd& window);

/// How many lines before and behind a line have noise in common with it: 2 M of a window of M cosine terms, 2 for hann.
std::int64_t correlated_lines(const std::string& window);

/// How many independent segments a mean over `count` segments, each `hop` samples after the one before, is worth:
///   count / (1 + 2 sum_{m=1}^{count-1} (1 - m/count) rho(m)^2),  rho(m) = sum_n w[n] w[n + m hop] / sum_n w[n]^2.
/// Right for noise whose spectrum is flat over the bandwidth of the window.
/// Reference: P. D. Welch, IEEE Trans. Audio Electroacoustics 15 (1967) 70, doi:10.1109/TAU.1967.1161901.
double effective_averages(const Eigen::VectorXd& window, Eigen::Index hop, std::int64_t count);

}  // namespace bodeflow::spectrum
