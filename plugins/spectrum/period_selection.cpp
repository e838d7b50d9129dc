#include "period_selection.hpp"

#include <algorithm>
#include <bodeflow/error.hpp>
#include <cmath>
#include <string>

namespace bodeflow::spectrum {
namespace {

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  const double above = *middle;
  if (values.size() % 2 == 1) return above;
  return 0.5 * (above + *std::max_element(values.begin(), middle));
}

}  // namespace

Eigen::VectorXd distances_from_median(const std::vector<Eigen::MatrixXcd>& spectra) {
  const auto periods = static_cast<Eigen::Index>(spectra.size());
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(periods), squares(periods);
  std::vector<double> values(spectra.size());
  double terms = 0.0;
  for (Eigen::Index a = 0; a < spectra.front().cols(); ++a) {
    for (Eigen::Index k = 1; k < spectra.front().rows(); ++k) {
      for (std::size_t p = 0; p < spectra.size(); ++p) values[p] = spectra[p](k, a).real();
      const double re = median(values);
      for (std::size_t p = 0; p < spectra.size(); ++p) values[p] = spectra[p](k, a).imag();
      const std::complex<double> middle(re, median(values));
      for (std::size_t p = 0; p < spectra.size(); ++p) {
        squares[static_cast<Eigen::Index>(p)] = values[p] = std::norm(spectra[p](k, a) - middle);
      }
      const double usual = median(values);
      if (!(usual > 0.0)) continue;  // periods alike to the last bit: nothing to compare with
      sums += squares / usual;
      terms += 1.0;
    }
  }
  return terms > 0.0 ? Eigen::VectorXd((sums / terms).cwiseSqrt()) : sums;
}

PeriodSelection::PeriodSelection(Eigen::Index period, Layout layout, double limit)
    : period_(period), layout_(layout), limit_(limit) {}

void PeriodSelection::add(const Eigen::Ref<const Eigen::MatrixXd>& frame) {
  if ((periods() + 1) * period_ * frame.cols() > kMostValues) {
    fail("leaving out outliers keeps all periods in memory: at most " + std::to_string(kMostValues / (period_ * frame.cols())) +
         " periods of " + std::to_string(period_) + " samples and " + std::to_string(frame.cols()) + " channels; measure fewer");
  }
  frames_.push_back(frame);
}

void PeriodSelection::clear() { frames_.clear(); }

std::vector<std::int64_t> PeriodSelection::outliers() const {
  numerics::RealDft dft(period_);
  std::vector<Eigen::MatrixXcd> spectra;
  for (const Eigen::MatrixXd& frame : frames_) {
    Eigen::MatrixXcd& spectrum = spectra.emplace_back(dft.lines(), frame.cols());
    for (Eigen::Index a = 0; a < frame.cols(); ++a) {
      dft.samples() = frame.col(a).array() - frame(0, a);
      spectrum.col(a) = dft.transform();
    }
  }
  const Eigen::VectorXd distances = distances_from_median(spectra);
  std::vector<double> sorted(distances.begin(), distances.end());
  const double usual = median(sorted);
  std::vector<std::int64_t> found;
  for (Eigen::Index p = 0; p < distances.size(); ++p) {
    if (distances[p] > limit_ * usual) found.push_back(p);
  }
  return found;
}

Expected<Moments> PeriodSelection::moments() const {
  if (periods() < 4) {
    return unexpected("outliers are told from the median of the periods: needed are at least 4; found " +
                      std::to_string(periods()));
  }
  AveragingDft average(period_, layout_);
  const std::vector<std::int64_t> left_out = outliers();
  for (std::int64_t p = 0; p < periods(); ++p) {
    if (!std::binary_search(left_out.begin(), left_out.end(), p)) average.add(frames_[static_cast<std::size_t>(p)]);
  }
  auto m = average.moments();
  if (m && !left_out.empty()) {
    m->left_out = left_out;
    m->trend.resize(0);  // the periods do not follow each other
    m->trend_residual.resize(0);
  }
  return m;
}

}  // namespace bodeflow::spectrum
