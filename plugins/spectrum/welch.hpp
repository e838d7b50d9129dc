#pragma once

#include <Eigen/Core>
#include <bodeflow/error.hpp>
#include <bodeflow/numerics/fft.hpp>
#include <cstdint>
#include <string>
#include <vector>

namespace bodeflow::spectrum {

/// What is taken off each segment before it is windowed.
enum class Detrend { none, mean, linear };

/// Which signals are taken to be noisy: outputs (h1), the input (h2), both in proportion to their power (hv).
enum class WelchForm { h1, h2, hv };

struct WelchSettings {
  Eigen::Index segment = 1024;  ///< L >= 4 samples
  Eigen::Index hop = 512;       ///< from the start of a segment to that of the next, 1 .. L
  std::string window = "hann";  ///< one of window_names()
  Detrend detrend = Detrend::mean;
  double sample_rate_hz = 1.0;
};

/// A frequency response from averaged spectra. Rows: lines `first` .. `last`, line k at k/L times the sample rate.
struct WelchEstimate {
  std::vector<std::int64_t> lines;
  Eigen::MatrixXcd response;        ///< column i * inputs + j
  Eigen::MatrixXd variance;         ///< likewise, E|dG|^2
  Eigen::MatrixXd coherence;        ///< of each output with all inputs, 0 .. 1
  Eigen::MatrixXd input_density;    ///< one-sided, unit^2/Hz
  Eigen::MatrixXd output_density;   ///< likewise
  std::int64_t averages = 0;        ///< M segments
  double effective_averages = 0.0;  ///< M_e <= M, see effective_averages in window.hpp
  double degrees_of_freedom = 0.0;  ///< nu = M_e - inputs
};

/// Averages windowed spectra of segments and estimates the frequency response, its variance and the coherence.
///
/// S = 1/M sum_m Z_m Z_m^H, Z = [U; Y] the transforms of the windowed segments. With one or more inputs
///   h1: G = S_yu S_uu^-1,  S_nn,i = S_yy,i - S_yu,i S_uu^-1 S_uy,i,  coherence_i = 1 - S_nn,i / S_yy,i,
///       var G_ij = S_nn,i [S_uu^-1]_jj / (M_e - inputs): the least-squares variance with the unbiased noise power.
/// With one input, gamma^2 = |S_yu|^2 / (S_uu S_yy):
///   h2: G = S_yy / S_uy,                          var G = |G|^2 (1 - gamma^2) / gamma^2 / (M_e - 1)
///   hv: G = sqrt(S_yy / S_uu) S_yu / |S_yu|,      var G = |G|^2 (1 - gamma^4) / (2 gamma^2) / (M_e - 1)
/// (hv is the total least-squares solution for equal noise-to-signal ratios of input and output, the geometric mean of h1 and
/// h2.) M_e accounts for the overlap. |dG|^2 / var G is F(2, 2 nu), nu = M_e - inputs.
///
/// Biased: h1 by S_uu/(S_uu + noise of the input), h2 by 1 + noise/signal of the output, both in a closed loop (towards -1/C).
/// Every form where the plant's memory is not short beside a segment: leakage flattens a resonance of bandwidth B by about
/// (resolution/B)^2/3 and looks like noise. The coherence is too high by about inputs (1 - gamma^2)^2 / M_e.
///
/// References: J. S. Bendat, A. G. Piersol, Random Data, 4th ed., Wiley 2010, sections 6.1, 7.2, 9.1, 9.2,
/// doi:10.1002/9781118032428; P. D. Welch, doi:10.1109/TAU.1967.1161901; G. T. Rocklin, J. Crowley, H. Vold, A comparison of H1,
/// H2 and Hv frequency response functions, IMAC III (1985) 272.
/// Cost: one transform a segment and channel; memory O(L channels^2) whatever the number of segments.
class Welch {
 public:
  Welch(const WelchSettings& settings, Eigen::Index inputs, Eigen::Index outputs);

  /// Takes one segment: L x (inputs + outputs), finite.
  void add(const Eigen::Ref<const Eigen::MatrixXd>& segment);

  std::int64_t averages() const { return averages_; }
  /// nu = M_e - inputs, at most 0 where there are too few segments for an estimate.
  double degrees_of_freedom() const;

  /// The estimate at lines first .. last, 1 <= first <= last <= (L - 1)/2. h2 and hv need one input. Errors: M_e not above the
  /// number of inputs; an input that is silent at a line, or inputs that depend on each other there; for h2 and hv an output that
  /// has nothing in common with the input; overflow.
  Expected<WelchEstimate> estimate(WelchForm form, std::int64_t first, std::int64_t last) const;

  /// Forgets all segments.
  void clear();

 private:
  Eigen::MatrixXcd mean_at(std::int64_t line) const;
  void densities(std::int64_t line, Eigen::Index row, WelchEstimate& e) const;
  Expected<void> least_squares(std::int64_t line, Eigen::Index row, WelchEstimate& e) const;
  Expected<void> other_form(WelchForm form, std::int64_t line, Eigen::Index row, WelchEstimate& e) const;
  std::string place(std::int64_t line) const;

  WelchSettings settings_;
  Eigen::Index inputs_, outputs_;
  Eigen::VectorXd window_;
  numerics::RealDft dft_;
  std::int64_t averages_ = 0;
  Eigen::VectorXd frame_;
  Eigen::MatrixXcd spectra_;  // of one segment, lines x channels
  Eigen::MatrixXcd sums_;     // lines x channels^2, column a * channels + b: sum Z_a conj(Z_b), b <= a
};

}  // namespace bodeflow::spectrum
