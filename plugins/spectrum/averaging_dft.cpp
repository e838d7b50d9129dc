#include "averaging_dft.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "period_kernels.hpp"

namespace bodeflow::spectrum {
namespace {

/// sum_p (p - mean p)^2 of `count` periods.
double spread(double count) { return count * (count * count - 1.0) / 12.0; }

}  // namespace

AveragingDft::AveragingDft(Eigen::Index period, Layout layout, Detrend detrend, int vector_level)
    : period_(period), layout_(layout), detrend_(detrend), vector_level_(vector_level) {
  const Eigen::Index signals = layout.signals();
  dft_.reserve(static_cast<std::size_t>(signals));
  for (Eigen::Index a = 0; a < signals; ++a) {
    dft_.emplace_back(period);
    dft_.back().samples().setZero();
    spectrum_.push_back(dft_.back().transform());
  }
  const Eigen::Index lines = dft_.front().lines();
  for (auto* m : {&sum_, &first_, &second_}) m->resize(lines, signals);
  squares_.resize(lines, signals);
  products_.resize(lines, signals * (signals - 1) / 2);
  level_moment_.resize(signals);
  clear();
}

void AveragingDft::clear() {
  periods_ = 0;
  sum_.setZero();
  squares_.setZero();
  products_.setZero();
  level_moment_.setZero();
}

/// Spectrum of `x` into spectrum_[signal], times N.
void AveragingDft::transform(Eigen::Index signal, const Eigen::Ref<const Eigen::VectorXd>& x) {
  numerics::RealDft& dft = dft_[static_cast<std::size_t>(signal)];
  const double offset = x[0];
  copy_without(x.data(), offset, dft.samples().data(), static_cast<std::size_t>(period_), vector_level_);
  dft.transform()[0] += offset * static_cast<double>(period_);
}

/// Takes the spectrum of one signal into its sums, and leaves its deviation from the first period in its place: one pass over the
/// lines, with the product of the signal before it, and one more for each other signal.
void AveragingDft::update(Eigen::Index signal) {
  const auto data = [](auto&& column) { return reinterpret_cast<double*>(column.data()); };
  const auto spectrum = [&](Eigen::Index a) { return data(spectrum_[static_cast<std::size_t>(a)]); };
  const auto products = [&](Eigen::Index before) { return data(products_.col(pair_column(signal, before))); };
  const auto lines = static_cast<std::size_t>(sum_.rows());
  const Sums sums{data(first_.col(signal)), data(sum_.col(signal)), squares_.col(signal).data()};
  if (signal == 0) return add_deviation(spectrum(0), sums, lines, vector_level_);
  add_deviation(spectrum(signal), sums, spectrum(signal - 1), products(signal - 1), lines, vector_level_);
  for (Eigen::Index before = 0; before < signal - 1; ++before) {
    add_products(spectrum(signal), spectrum(before), products(before), lines, vector_level_);
  }
}

void AveragingDft::add(const Eigen::Ref<const Eigen::MatrixXd>& frame) {
  for (Eigen::Index a = 0; a < frame.cols(); ++a) transform(a, frame.col(a));
  ++periods_;
  for (Eigen::Index a = 0; a < frame.cols(); ++a) {
    const auto& spectrum = spectrum_[static_cast<std::size_t>(a)];
    if (periods_ == 1) first_.col(a) = spectrum;
    if (periods_ == 2) second_.col(a) = spectrum;
    level_moment_[a] += static_cast<double>(periods_ - 1) * (spectrum[0].real() - first_(0, a).real());
    update(a);
  }
}

void AveragingDft::add(const Eigen::Ref<const Eigen::MatrixXd>& input, const Eigen::Ref<const Eigen::MatrixXd>& output) {
  Eigen::MatrixXd frame(period_, layout_.signals());
  frame << input, output;
  add(frame);
}

/// The rise of the mean from one period to the next, by least squares over 2 periods or more.
double AveragingDft::slope(Eigen::Index signal) const {
  const auto count = static_cast<double>(periods_), samples = static_cast<double>(period_);
  return (level_moment_[signal] - 0.5 * (count - 1.0) * sum_(0, signal).real()) / (spread(count) * samples);
}

/// Takes the share of a linear drift off the mean spectra.
void AveragingDft::correct_drift(Eigen::MatrixXcd& mean) const {
  const auto samples = static_cast<double>(period_);
  if (periods_ < 2) return;
  for (Eigen::Index a = 0; a < mean.cols(); ++a) {
    const double each_sample = slope(a) / samples;
    for (Eigen::Index k = 1; k < mean.rows(); ++k) {
      const double angle = -2.0 * std::numbers::pi * static_cast<double>(k) / samples;
      mean(k, a) -= each_sample / (std::polar(1.0, angle) - 1.0);
    }
  }
}

void AveragingDft::take_trend(Moments& m) const {
  const auto count = static_cast<double>(periods_), samples = static_cast<double>(period_);
  m.trend.resize(sum_.cols());
  m.trend_residual.resize(sum_.cols());
  for (Eigen::Index a = 0; a < sum_.cols(); ++a) {
    m.trend[a] = slope(a);
    const double all = (squares_(0, a) - sum_(0, a).real() * sum_(0, a).real() / count) / (samples * samples);
    m.trend_residual[a] = std::max(0.0, all - m.trend[a] * m.trend[a] * spread(count));
  }
}

Expected<Moments> AveragingDft::moments() const {
  if (periods_ == 0) return unexpected("no whole period was taken");
  const auto count = static_cast<double>(periods_), samples = static_cast<double>(period_);
  Moments m;
  m.periods = periods_;
  m.degrees_of_freedom = count - 1.0;
  m.first = first_ / samples;
  m.mean = (first_ + sum_ / count) / samples;
  if (detrend_ == Detrend::linear) correct_drift(m.mean);
  if (periods_ == 1) return m;
  const double scale = 1.0 / (count * (count - 1.0) * samples * samples);
  const Eigen::Index signals = sum_.cols();
  m.variance.resizeLike(squares_);
  m.covariance.resizeLike(products_);
  m.last.resizeLike(first_);
  for (Eigen::Index a = 0; a < signals; ++a) {
    m.variance.col(a) = scale * (squares_.col(a) - sum_.col(a).cwiseAbs2() / count).cwiseMax(0.0);
    for (Eigen::Index b = 0; b < a; ++b) {
      m.covariance.col(pair_column(a, b)) =
          scale * (products_.col(pair_column(a, b)) - sum_.col(a).cwiseProduct(sum_.col(b).conjugate()) / count);
    }
    m.last.col(a) = (first_.col(a) + spectrum_[static_cast<std::size_t>(a)]) / samples;
  }
  m.second = second_ / samples;
  if (detrend_ == Detrend::none && periods_ > 2) take_trend(m);
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
