#include "averaging_dft.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace bodeflow::spectrum {
namespace {

// A line is told from noise when the power of its mean is 10 dB above the variance of that mean.
constexpr double kExcitedOverVariance = 10.0;
// The transform rounds at about 1e-16 of the strongest line times a few; what is below this is no signal.
constexpr double kRounding = 1e-12;

/// Spectrum of `x`, scaled by 1/N. The first sample is taken off before and its share added to line 0, so that an offset far
/// above the signal (the angle of a turning shaft) costs no digits at the other lines.
void spectrum_of(numerics::RealDft& dft, const Eigen::Ref<const Eigen::VectorXd>& x, Eigen::VectorXd& frame,
                 Eigen::VectorXcd& out) {
  const double offset = x[0];
  frame = x.array() - offset;
  dft.forward(frame, out);
  out /= static_cast<double>(x.size());
  out[0] += offset;
}

double norm_largest(const Eigen::VectorXcd& spectrum, const std::vector<std::int64_t>& lines) {
  double largest = 0.0;
  for (const std::int64_t k : lines) largest = std::max(largest, std::abs(spectrum[k]));
  return largest;
}

}  // namespace

AveragingDft::AveragingDft(Eigen::Index period, Eigen::Index outputs)
    : period_(period), dft_(period), frame_(period), input_step_(dft_.lines()), output_step_(dft_.lines()) {
  const Eigen::Index lines = dft_.lines();
  input_mean_.resize(lines);
  input_squares_.resize(lines);
  output_mean_.resize(lines, outputs);
  output_squares_.resize(lines, outputs);
  products_.resize(lines, outputs);
  clear();
}

void AveragingDft::clear() {
  periods_ = 0;
  input_mean_.setZero();
  input_squares_.setZero();
  output_mean_.setZero();
  output_squares_.setZero();
  products_.setZero();
}

void AveragingDft::add(const Eigen::Ref<const Eigen::VectorXd>& input, const Eigen::Ref<const Eigen::MatrixXd>& output) {
  ++periods_;
  const auto count = static_cast<double>(periods_);
  const double weight = (count - 1.0) / count;  // the sum of squares grows by weight |x_P - mean_(P-1)|^2
  spectrum_of(dft_, input, frame_, input_step_);
  input_step_ -= input_mean_;
  input_mean_ += input_step_ / count;
  input_squares_ += weight * input_step_.cwiseAbs2();
  for (Eigen::Index i = 0; i < output.cols(); ++i) {
    spectrum_of(dft_, output.col(i), frame_, output_step_);
    output_step_ -= output_mean_.col(i);
    output_mean_.col(i) += output_step_ / count;
    output_squares_.col(i) += weight * output_step_.cwiseAbs2();
    products_.col(i) += weight * output_step_.cwiseProduct(input_step_.conjugate());
  }
}

std::vector<std::int64_t> AveragingDft::chosen(const LineChoice& choice) const {
  std::vector<std::int64_t> lines = choice.candidates;
  if (lines.empty()) {
    for (std::int64_t k = 1; k <= (period_ - 1) / 2; ++k) lines.push_back(k);
  }
  if (choice.threshold <= 0.0) return lines;
  const double least = choice.threshold * norm_largest(input_mean_, lines);
  const auto count = static_cast<double>(periods_);
  const auto silent = [&](std::int64_t k) {
    const double variance = input_squares_[k] / (count * (count - 1.0));
    return !(std::abs(input_mean_[k]) >= least && std::norm(input_mean_[k]) > kExcitedOverVariance * variance);
  };
  lines.erase(std::remove_if(lines.begin(), lines.end(), silent), lines.end());
  return lines;
}

Expected<Estimate> AveragingDft::estimate(const LineChoice& choice, Form form) const {
  if (periods_ < 2) {
    return unexpected("the variance needs at least 2 periods; found " + std::to_string(periods_));
  }
  Estimate e;
  e.lines = chosen(choice);
  if (e.lines.empty())
    return unexpected("no line of the input stands out from its noise: is the input excited with this period?");
  const double strongest = input_mean_.tail(input_mean_.size() - 1).cwiseAbs().maxCoeff();
  e.periods = periods_;
  const auto count = static_cast<double>(periods_);
  const double scale = 1.0 / (count * (count - 1.0));
  const auto lines = static_cast<Eigen::Index>(e.lines.size());
  const Eigen::Index outputs = output_mean_.cols();
  e.input_mean.resize(lines);
  e.input_variance.resize(lines);
  for (auto* m : {&e.output_mean, &e.cross_covariance, &e.response}) m->resize(lines, outputs);
  for (auto* m : {&e.output_variance, &e.variance}) m->resize(lines, outputs);
  for (Eigen::Index row = 0; row < lines; ++row) {
    const std::int64_t k = e.lines[static_cast<std::size_t>(row)];
    const std::complex<double> u = input_mean_[k];
    if (!(std::abs(u) > kRounding * strongest)) return unexpected("line " + std::to_string(k) + " of the input is not excited");
    e.input_mean[row] = u;
    e.input_variance[row] = scale * input_squares_[k];
    for (Eigen::Index i = 0; i < outputs; ++i) {
      const std::complex<double> y = output_mean_(k, i), g = y / u, covariance = scale * products_(k, i);
      const double variance_y = scale * output_squares_(k, i);
      const double noise = form == Form::known_input
                               ? variance_y
                               : variance_y + std::norm(g) * e.input_variance[row] - 2.0 * std::real(std::conj(g) * covariance);
      if (!std::isfinite(noise / std::norm(u)))
        return unexpected("line " + std::to_string(k) + ": the values are too large to be averaged");
      e.output_mean(row, i) = y;
      e.output_variance(row, i) = variance_y;
      e.cross_covariance(row, i) = covariance;
      e.response(row, i) = g;
      e.variance(row, i) = std::max(0.0, noise) / std::norm(u);  // below zero by rounding alone
    }
  }
  return e;
}

}  // namespace bodeflow::spectrum
