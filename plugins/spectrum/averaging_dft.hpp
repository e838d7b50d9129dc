#pragma once

#include <Eigen/Core>
#include <bodeflow/numerics/fft.hpp>
#include <vector>

#include "collector.hpp"
#include "estimate.hpp"

namespace bodeflow::spectrum {

/// Averages spectra over whole periods of a steady state, in memory that does not grow with their number.
///
/// Spectra: X_p(k) = 1/N sum_n x_p[n] exp(-2 pi i k n / N), so a sine of amplitude A has |X| = A/2. The first sample of a period
/// is taken off before and its share added to line 0, so that an offset far above the signal (the angle of a turning shaft) costs
/// no digits at the other lines. Means and the covariances of these means from the scatter between periods:
///   X = 1/P sum_p X_p,   cov_ab = 1/(P(P-1)) sum_p (A_p - A) conj(B_p - B),   P - 1 degrees of freedom.
///
/// Linear drift, x[n] = a n beside the signal, adds the same a / (exp(-2 pi i k / N) - 1) to line k of each period: a bias that
/// no scatter shows, but the means of the periods (Moments::trend). Detrend::linear takes it off, with `a` by least squares from
/// the means of all periods. A slope from the samples of one period would take part of the signal along: a periodic signal has a
/// slope of its own within its period.
///
/// Assumptions: periodic steady state (drop the transient), noise independent between periods. Disturbances that repeat
/// with the period (nonlinear distortion) do not show in the covariance.
///
/// Reference: R. Pintelon, J. Schoukens, System Identification: A Frequency Domain Approach, 2nd ed., Wiley 2012, chapter 2
/// (periodic excitation, noise on input and output), doi:10.1002/9781118287422.
/// Sums are taken of the deviations from the first period. As that is one of the periods, the subtraction of P |mean deviation|^2
/// costs at most a factor P of the accuracy, however far the level: T. F. Chan, G. H. Golub, R. J. LeVeque, Am. Stat. 37 (1983)
/// 242. Cost: O(N log N) a period and signal, and 513 x s (s + 1) / 2 updates for s signals of 1024 samples; nothing is allocated
/// by `add`.
class AveragingDft final : public Collector {
 public:
  enum class Detrend { none, linear };

  /// period: N >= 3 samples; one signal or more of each kind but references; vector_level: see Activation.
  AveragingDft(Eigen::Index period, Layout layout, Detrend detrend = Detrend::none, int vector_level = 1);
  /// One input and several outputs.
  AveragingDft(Eigen::Index period, Eigen::Index outputs) : AveragingDft(period, Layout{1, outputs, 0}) {}

  void add(const Eigen::Ref<const Eigen::MatrixXd>& frame) override;
  /// The same from inputs and outputs apart: N samples each in columns.
  void add(const Eigen::Ref<const Eigen::MatrixXd>& input, const Eigen::Ref<const Eigen::MatrixXd>& output);

  std::int64_t periods() const override { return periods_; }

  /// The moments; without covariances from one period. Errors: no period.
  Expected<Moments> moments() const override;

  /// The response of one experiment from the periods so far, see estimate_response. Errors: its own; fewer than 2 periods.
  Expected<Estimate> estimate(const LineChoice& choice, Form form) const;

  void clear() override;

 private:
  void transform(Eigen::Index signal, const Eigen::Ref<const Eigen::VectorXd>& x);
  void update(Eigen::Index signal);
  double slope(Eigen::Index signal) const;
  void correct_drift(Eigen::MatrixXcd& mean) const;
  void take_trend(Moments& m) const;

  Eigen::Index period_;
  Layout layout_;
  Detrend detrend_;
  int vector_level_;  // of Activation
  std::int64_t periods_ = 0;
  std::vector<numerics::RealDft> dft_;                  // one a signal
  std::vector<Eigen::Map<Eigen::VectorXcd>> spectrum_;  // of the newest period, then minus the first
  // Lines 0 .. N/2 in rows, all times N: the first two periods; deviations from the first, their squares and products, summed up.
  Eigen::MatrixXcd first_, second_;
  Eigen::MatrixXcd sum_;
  Eigen::MatrixXd squares_;
  Eigen::MatrixXcd products_;
  Eigen::VectorXd level_moment_;  // sum_p p (m_p - m_0) of the period means m_p
};

}  // namespace bodeflow::spectrum
