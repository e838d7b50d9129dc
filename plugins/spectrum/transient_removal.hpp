#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "collector.hpp"

namespace bodeflow::spectrum {

/// Averages the periods of one experiment and takes the transient of the start off, so that no period has to be dropped.
///
/// The mean of the period spectra is the spectrum of the whole record, P N samples, at the bins k P. The steady state is zero in
/// all other bins: they hold transient and noise alone, and the transient's spectrum is smooth. At each line and for each signal
/// the kBins bins nearest to k P (no multiples of P) are fitted with
///   Z(r) = (b_0 + b_1 r + b_2 r^2) / (1 + a r),  r bins from k P,  as  Z = b_0 + b_1 r + b_2 r^2 - a r Z  by least squares,
/// so one pole near the line is followed, as in the local rational method. Below bin zero and above the Nyquist frequency stand
/// the conjugates, Z(-r) = conj Z(r), so that the lines at the ends have bins on both sides as well: the noise of a bin and that
/// of its conjugate are uncorrelated, E{Z^2} = 0. b_0 is the transient at the line. The residuals give the covariances, with
/// kBins - 4 degrees of freedom, enlarged by what b_0 is uncertain. Wrong where the transient is still strong at the end of the
/// record and two resonances lie within some bins of each other; where noise is strongly coloured within 6 bins. Memory grows
/// with the periods: all are kept until the end, up to kMostValues samples.
///
/// Reference: R. Pintelon, J. Schoukens, System Identification, 2nd ed. 2012, chapter 7 (local polynomial method for periodic
/// excitation: transient and noise from the non-excited bins); T. McKelvey, G. Guerin, Non-parametric frequency response
/// estimation using a local rational model, SYSID 2012, doi:10.3182/20120711-3-BE-2027.00299. Cost: O(P N log(P N)).
class TransientRemoval final : public Collector {
 public:
  static constexpr Eigen::Index kBins = 12;
  static constexpr std::int64_t kMostValues = std::int64_t{1} << 26;  // 0.5 GB, and as much again for the spectrum

  TransientRemoval(Eigen::Index period, Layout layout) : period_(period), layout_(layout), samples_(layout_.signals()) {}

  void add(const Eigen::Ref<const Eigen::MatrixXd>& frame) override;
  std::int64_t periods() const override { return static_cast<std::int64_t>(samples_.front().size()) / period_; }
  /// Errors: fewer than 2 periods; a period too short for kBins bins.
  Expected<Moments> moments() const override;
  void clear() override;

 private:
  Eigen::Index period_;
  Layout layout_;
  std::vector<std::vector<double>> samples_;  // of each signal, period after period
};

}  // namespace bodeflow::spectrum
