#include "averaging_dft.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace bodeflow::spectrum {

AveragingDft::AveragingDft(Eigen::Index period, Layout layout, Detrend detrend)
    : period_(period), layout_(layout), detrend_(detrend) {
  const Eigen::Index signals = layout.signals();
  dft_.reserve(static_cast<std::size_t>(signals));
  for (Eigen::Index a = 0; a < signals; ++a) {
    dft_.emplace_back(period);
    dft_.back().samples().setZero();
    spectrum_.push_back(dft_.back().transform());
  }
  const Eigen::Index lines = dft_.front().lines();
  for (auto* m : {&mean_, &first_, &second_}) m->resize(lines, signals);
  squares_.resize(lines, signals);
  products_.resize(lines, signals * (signals - 1) / 2);
  level_moment_.resize(signals);
  clear();
}

void AveragingDft::clear() {
  periods_ = 0;
  mean_.setZero();
  squares_.setZero();
  products_.setZero();
  level_moment_.setZero();
}

/// Spectrum of `x` into spectrum_[signal], times N.
void AveragingDft::transform(Eigen::Index signal, const Eigen::Ref<const Eigen::VectorXd>& x) {
  numerics::RealDft& dft = dft_[static_cast<std::size_t>(signal)];
  const double offset = x[0];
  dft.samples() = x.array() - offset;
  dft.transform()[0] += offset * static_cast<double>(period_);
}

/// Takes the spectrum of one signal into its mean and its products with the signals before it; leaves the deviation from the
/// mean before it. One pass over the lines a signal, one a pair.
void AveragingDft::update(Eigen::Index signal) {
  const auto count = static_cast<double>(periods_);
  const double scale = 1.0 / static_cast<double>(period_), share = 1.0 / count;
  const double weight = (count - 1.0) / count;  // the sum of squares grows by weight |x_P - mean_(P-1)|^2
  double* x = reinterpret_cast<double*>(spectrum_[static_cast<std::size_t>(signal)].data());
  double* mean = reinterpret_cast<double*>(mean_.col(signal).data());
  double* squares = squares_.col(signal).data();
  const Eigen::Index lines = mean_.rows();
  for (Eigen::Index k = 0; k < lines; ++k) {
    const double re = x[2 * k] * scale - mean[2 * k], im = x[2 * k + 1] * scale - mean[2 * k + 1];
    mean[2 * k] += re * share;
    mean[2 * k + 1] += im * share;
    squares[k] += weight * (re * re + im * im);
    x[2 * k] = re;
    x[2 * k + 1] = im;
  }
  for (Eigen::Index before = 0; before < signal; ++before) {
    const double* other = reinterpret_cast<const double*>(spectrum_[static_cast<std::size_t>(before)].data());
    double* sum = reinterpret_cast<double*>(products_.col(pair_column(signal, before)).data());
    for (Eigen::Index k = 0; k < lines; ++k) {
      sum[2 * k] += weight * (x[2 * k] * other[2 * k] + x[2 * k + 1] * other[2 * k + 1]);
      sum[2 * k + 1] += weight * (x[2 * k + 1] * other[2 * k] - x[2 * k] * other[2 * k + 1]);
    }
  }
}

void AveragingDft::keep_single_periods() {
  Eigen::MatrixXcd& kept = periods_ == 1 ? first_ : second_;
  for (Eigen::Index a = 0; a < kept.cols(); ++a) {
    kept.col(a) = spectrum_[static_cast<std::size_t>(a)] / static_cast<double>(period_);
  }
}

void AveragingDft::add(const Eigen::Ref<const Eigen::MatrixXd>& frame) {
  for (Eigen::Index a = 0; a < frame.cols(); ++a) transform(a, frame.col(a));
  ++periods_;
  if (periods_ <= 2) keep_single_periods();
  for (Eigen::Index a = 0; a < frame.cols(); ++a) {
    const double level = spectrum_[static_cast<std::size_t>(a)][0].real() / static_cast<double>(period_);
    level_moment_[a] += static_cast<double>(periods_ - 1) * (level - first_(0, a).real());
    update(a);
  }
}

void AveragingDft::add(const Eigen::Ref<const Eigen::MatrixXd>& input, const Eigen::Ref<const Eigen::MatrixXd>& output) {
  Eigen::MatrixXd frame(period_, layout_.signals());
  frame << input, output;
  add(frame);
}

/// Takes the share of a linear drift off the mean spectra.
void AveragingDft::correct_drift(Eigen::MatrixXcd& mean) const {
  const auto count = static_cast<double>(periods_), samples = static_cast<double>(period_);
  if (periods_ < 2) return;
  const double spread = count * (count * count - 1.0) / 12.0;  // sum_p (p - mean p)^2
  for (Eigen::Index a = 0; a < mean.cols(); ++a) {
    const double levels = count * (mean_(0, a).real() - first_(0, a).real());  // sum_p (m_p - m_0)
    const double slope = (level_moment_[a] - 0.5 * (count - 1.0) * levels) / (spread * samples);
    for (Eigen::Index k = 1; k < mean.rows(); ++k) {
      const double angle = -2.0 * std::numbers::pi * static_cast<double>(k) / samples;
      mean(k, a) -= slope / (std::polar(1.0, angle) - 1.0);
    }
  }
}

Expected<Moments> AveragingDft::moments() const {
  if (periods_ == 0) return unexpected("no whole period was taken");
  const auto count = static_cast<double>(periods_);
  Moments m;
  m.periods = periods_;
  m.degrees_of_freedom = count - 1.0;
  m.mean = mean_;
  if (detrend_ == Detrend::linear) correct_drift(m.mean);
  m.first = first_;
  if (periods_ == 1) return m;
  const double scale = 1.0 / (count * (count - 1.0));
  m.variance = scale * squares_;
  m.covariance = scale * products_;
  m.second = second_;
  // What stands in spectrum_ is the newest period minus the mean before it: mean_P = mean_(P-1) + deviation / P.
  m.last.resizeLike(mean_);
  for (Eigen::Index a = 0; a < mean_.cols(); ++a) {
    m.last.col(a) = mean_.col(a) + (count - 1.0) / count * spectrum_[static_cast<std::size_t>(a)];
  }
  return m;
}

Expected<Estimate> AveragingDft::estimate(const LineChoice& choice, Form form) const {
  if (periods_ < 2) {
    return unexpected("the variance needs at least 2 periods; found " + std::to_string(periods_));
  }
  Measured measured{layout_, period_, 1, {}};
  measured.parts.push_back(*moments());
  return estimate_response(measured, choice, form);
}

}  // namespace bodeflow::spectrum
