#pragma once

#include <Eigen/Core>
#include <bodeflow/error.hpp>
#include <bodeflow/numerics/fft.hpp>
#include <cstdint>
#include <vector>

namespace bodeflow::spectrum {

/// What is taken as exact: the mean input spectrum, or neither signal.
enum class Form { known_input, errors_in_variables };

/// Which lines an estimate has.
struct LineChoice {
  /// Line numbers 1 .. (N-1)/2, rising; empty: all of these.
  std::vector<std::int64_t> candidates;
  /// Above zero: only candidates that are excited, see AveragingDft::estimate. Zero: all candidates.
  double threshold = 0.0;
};

/// A frequency response at some lines of the period, with what it was made from. Rows: lines, columns: outputs.
struct Estimate {
  std::vector<std::int64_t> lines;    ///< k; its frequency is k / N times the sample rate
  std::int64_t periods = 0;           ///< P
  Eigen::VectorXcd input_mean;        ///< U(k), unit of the input
  Eigen::VectorXd input_variance;     ///< of U(k), unit of the input squared
  Eigen::MatrixXcd output_mean;       ///< Y_i(k), unit of the output
  Eigen::MatrixXd output_variance;    ///< of Y_i(k)
  Eigen::MatrixXcd cross_covariance;  ///< of Y_i(k) and U(k): E{dY conj(dU)}
  Eigen::MatrixXcd response;          ///< G_i(k)
  Eigen::MatrixXd variance;           ///< of G_i(k), complex: E|dG|^2
};

/// Averages spectra over whole periods of a steady state and estimates the frequency response from one input to several outputs.
///
/// Spectra: X_p(k) = 1/N sum_n x_p[n] exp(-2 pi i k n / N), so a sine of amplitude A has |X| = A/2.
/// Means: U = 1/P sum_p U_p, Y likewise. Variances and covariance of these means, from the scatter between periods:
///   var_u = 1/(P(P-1)) sum_p |U_p - U|^2, var_y likewise, cov_yu = 1/(P(P-1)) sum_p (Y_p - Y) conj(U_p - U).
/// Response G = Y/U. Variance to first order in the noise, from dG = (dY - G dU)/U:
///   errors in variables: var G = |G|^2 (var_y/|Y|^2 + var_u/|U|^2 - 2 Re(cov_yu / (Y conj(U)))),
///   known input:         var G = var_y/|U|^2.
/// The first is evaluated as (var_y + |G|^2 var_u - 2 Re(conj(G) cov_yu)) / |U|^2, equal to it and defined for Y = 0 too.
///
/// Assumptions: periodic steady state (drop the transient), noise independent between periods, |U| well above its own standard
/// deviation: G = Y/U is biased by about -G exp(-|U|^2/var_u), below 5e-5 of G from 10 dB on, and has no finite variance
/// where U can come near zero. Disturbances that repeat with the period (nonlinear distortion) do not show in the variance.
///
/// Reference: R. Pintelon, J. Schoukens, System Identification: A Frequency Domain Approach, 2nd ed., Wiley 2012, chapter 2
/// (frequency response from periodic excitation with noisy input and output), doi:10.1002/9781118287422.
/// Running means and sums of squares: B. P. Welford, Technometrics 4 (1962) 419, doi:10.1080/00401706.1962.10490022.
/// Cost: O(N log N) a period, memory O(N) whatever the number of periods.
class AveragingDft {
 public:
  /// period: N >= 3 samples; outputs >= 1.
  AveragingDft(Eigen::Index period, Eigen::Index outputs);

  /// Takes one period: `input` N samples, `output` N x outputs, all finite.
  void add(const Eigen::Ref<const Eigen::VectorXd>& input, const Eigen::Ref<const Eigen::MatrixXd>& output);

  /// P, the number of periods taken so far.
  std::int64_t periods() const { return periods_; }

  /// The estimate from the periods so far. A candidate counts as excited when |U| is at least `threshold` times the largest
  /// |U| among the candidates, and |U|^2 at least ten times var_u. Errors: fewer than 2 periods; no line excited;
  /// a line without input (|U| below 1e-12 of the strongest line: rounding of the transform); overflow.
  Expected<Estimate> estimate(const LineChoice& choice, Form form) const;

  /// Forgets all periods.
  void clear();

 private:
  std::vector<std::int64_t> chosen(const LineChoice& choice) const;

  Eigen::Index period_;
  std::int64_t periods_ = 0;
  numerics::RealDft dft_;
  Eigen::VectorXd frame_;
  Eigen::VectorXcd input_step_, output_step_;  // spectrum of the newest period minus the mean before it
  // Lines 0 .. N/2 in rows: mean spectra and sums of squared deviations.
  Eigen::VectorXcd input_mean_;
  Eigen::MatrixXcd output_mean_;
  Eigen::VectorXd input_squares_;
  Eigen::MatrixXd output_squares_;
  Eigen::MatrixXcd products_;
};

}  // namespace bodeflow::spectrum
