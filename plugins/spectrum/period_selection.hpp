#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "averaging_dft.hpp"

namespace bodeflow::spectrum {

/// The distance of each period from the usual one: sqrt of the mean over lines and signals of |Z_p - median|^2 / s^2, where the
/// median over the periods is taken of real and imaginary part apart and s^2 is the median over the periods of |Z_p - median|^2.
/// Line 0 is left out. A period with usual noise has a distance near 1.2. spectra: one matrix a period, lines x signals. Cost:
/// O(P) a value.
Eigen::VectorXd distances_from_median(const std::vector<Eigen::MatrixXcd>& spectra);

/// Averages the periods of one experiment without those that do not fit to the rest: a knock at the machine, a lost sample.
///
/// A period is left out when its distance (distances_from_median) is above `limit` times the median distance. Half of the
/// periods and more are therefore always kept. The rest is averaged as by AveragingDft.
/// Memory grows with the periods: they are all kept until the end, up to kMostValues samples.
class PeriodSelection final : public Collector {
 public:
  static constexpr std::int64_t kMostValues = std::int64_t{1} << 26;  // 0.5 GB, and as much again for their spectra

  /// limit: above 1.
  PeriodSelection(Eigen::Index period, Layout layout, double limit);

  void add(const Eigen::Ref<const Eigen::MatrixXd>& frame) override;
  std::int64_t periods() const override { return static_cast<std::int64_t>(frames_.size()); }
  /// Errors: fewer than 4 periods, which have no median to speak of.
  Expected<Moments> moments() const override;
  void clear() override;

  /// The periods, counted from 0, that are left out.
  std::vector<std::int64_t> outliers() const;

 private:
  Eigen::Index period_;
  Layout layout_;
  double limit_;
  std::vector<Eigen::MatrixXd> frames_;
};

}  // namespace bodeflow::spectrum
