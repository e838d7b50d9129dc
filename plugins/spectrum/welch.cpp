#include "welch.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <complex>

#include "records.hpp"
#include "window.hpp"

namespace bodeflow::spectrum {
namespace {

using Complex = std::complex<double>;

// Inputs whose share of their own, beside what the other inputs tell, is below this part of their power are dependent: with
// double precision nothing is left of it.
constexpr double kDependent = 1e-12;
// Power beside the strongest line below which there is only the rounding of the transform.
constexpr double kSilent = 1e-26;

/// Takes off the mean, or the straight line of least squares.
void take_off(Detrend detrend, Eigen::VectorXd& x) {
  if (detrend == Detrend::none) return;
  x.array() -= x.mean();
  if (detrend == Detrend::mean) return;
  const auto count = static_cast<double>(x.size());
  const double middle = (count - 1.0) / 2.0;
  double slope = 0.0;
  for (Eigen::Index n = 0; n < x.size(); ++n) slope += (static_cast<double>(n) - middle) * x[n];
  slope /= count * (count * count - 1.0) / 12.0;
  for (Eigen::Index n = 0; n < x.size(); ++n) x[n] -= slope * (static_cast<double>(n) - middle);
}

}  // namespace

Welch::Welch(const WelchSettings& settings, Eigen::Index inputs, Eigen::Index outputs)
    : settings_(settings),
      inputs_(inputs),
      outputs_(outputs),
      window_(window(settings.window, settings.segment)),
      dft_(settings.segment),
      frame_(settings.segment),
      spectra_(dft_.lines(), inputs + outputs),
      sums_(dft_.lines(), (inputs + outputs) * (inputs + outputs)) {
  clear();
}

void Welch::clear() {
  averages_ = 0;
  sums_.setZero();
}

void Welch::add(const Eigen::Ref<const Eigen::MatrixXd>& segment) {
  ++averages_;
  const Eigen::Index channels = segment.cols();
  for (Eigen::Index c = 0; c < channels; ++c) {
    frame_ = segment.col(c);
    take_off(settings_.detrend, frame_);
    frame_.array() *= window_.array();
    dft_.forward(frame_, spectra_.col(c));
  }
  for (Eigen::Index a = 0; a < channels; ++a) {
    for (Eigen::Index b = 0; b <= a; ++b)
      sums_.col(a * channels + b).array() += spectra_.col(a).array() * spectra_.col(b).array().conjugate();
  }
}

double Welch::degrees_of_freedom() const {
  if (averages_ <= inputs_) return 0.0;
  return effective_averages(window_, settings_.hop, averages_) - static_cast<double>(inputs_);
}

/// S at a line.
Eigen::MatrixXcd Welch::mean_at(std::int64_t line) const {
  const Eigen::Index channels = inputs_ + outputs_;
  Eigen::MatrixXcd s(channels, channels);
  for (Eigen::Index a = 0; a < channels; ++a) {
    for (Eigen::Index b = 0; b <= a; ++b) {
      s(a, b) = sums_(line, a * channels + b) / static_cast<double>(averages_);
      s(b, a) = std::conj(s(a, b));
    }
    s(a, a) = s(a, a).real();
  }
  return s;
}

std::string Welch::place(std::int64_t line) const {
  const double frequency = static_cast<double>(line) * settings_.sample_rate_hz / static_cast<double>(settings_.segment);
  return "line " + std::to_string(line) + " (" + short_number(frequency) + " Hz)";
}

void Welch::densities(std::int64_t line, Eigen::Index row, WelchEstimate& e) const {
  const double scale = 2.0 / (settings_.sample_rate_hz * window_.squaredNorm() * static_cast<double>(averages_));
  const Eigen::Index channels = inputs_ + outputs_;
  for (Eigen::Index c = 0; c < channels; ++c) {
    const double density = scale * sums_(line, c * channels + c).real();
    (c < inputs_ ? e.input_density(row, c) : e.output_density(row, c - inputs_)) = density;
  }
}

Expected<void> Welch::least_squares(std::int64_t line, Eigen::Index row, WelchEstimate& e) const {
  const Eigen::MatrixXcd s = mean_at(line);
  if (!s.allFinite()) return unexpected(place(line) + ": the values are too large to be averaged");
  // Scaled to unit power, so that the rank does not depend on units.
  const Eigen::VectorXd scale = s.diagonal().head(inputs_).real().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXcd uu = scale.asDiagonal() * s.topLeftCorner(inputs_, inputs_) * scale.asDiagonal();
  const Eigen::LLT<Eigen::MatrixXcd> factor(uu);
  const bool independent = factor.info() == Eigen::Success && factor.matrixLLT().diagonal().cwiseAbs2().minCoeff() > kDependent;
  if (!independent)
    return unexpected(
        place(line) +
        ": the inputs depend on each other, so their responses cannot be told apart; drive each with noise of its own");
  const Eigen::MatrixXcd inverse =
      scale.asDiagonal() * factor.solve(Eigen::MatrixXcd::Identity(inputs_, inputs_)) * scale.asDiagonal();
  const Eigen::MatrixXcd yu = s.bottomLeftCorner(outputs_, inputs_);
  const Eigen::MatrixXcd g = yu * inverse;
  for (Eigen::Index i = 0; i < outputs_; ++i) {
    const double power = s(inputs_ + i, inputs_ + i).real();
    const double explained = (g.row(i) * yu.row(i).adjoint()).value().real();
    const double noise = std::max(0.0, power - explained);  // below zero by rounding alone
    e.coherence(row, i) = power > 0.0 ? std::clamp(1.0 - noise / power, 0.0, 1.0) : 0.0;
    for (Eigen::Index j = 0; j < inputs_; ++j) {
      e.response(row, i * inputs_ + j) = g(i, j);
      e.variance(row, i * inputs_ + j) = noise * inverse(j, j).real() / e.degrees_of_freedom;
    }
  }
  return {};
}

Expected<void> Welch::other_form(WelchForm form, std::int64_t line, Eigen::Index row, WelchEstimate& e) const {
  const Eigen::MatrixXcd s = mean_at(line);
  const double uu = s(0, 0).real();
  for (Eigen::Index i = 0; i < outputs_; ++i) {
    const double yy = s(1 + i, 1 + i).real(), coherence = e.coherence(row, i);
    const Complex yu = s(1 + i, 0);
    const Complex g = form == WelchForm::h2 ? yy / std::conj(yu) : std::sqrt(yy / uu) * yu / std::abs(yu);
    const double relative =
        form == WelchForm::h2 ? (1.0 - coherence) / coherence : (1.0 - coherence * coherence) / (2.0 * coherence);
    const double variance = std::norm(g) * relative / e.degrees_of_freedom;
    if (!std::isfinite(variance) || !std::isfinite(std::abs(g)))
      return unexpected(place(line) + ": output " + std::to_string(i + 1) + " has nothing in common with the input");
    e.response(row, i) = g;
    e.variance(row, i) = variance;
  }
  return {};
}

Expected<WelchEstimate> Welch::estimate(WelchForm form, std::int64_t first, std::int64_t last) const {
  WelchEstimate e;
  e.averages = averages_;
  e.effective_averages = effective_averages(window_, settings_.hop, averages_);
  e.degrees_of_freedom = degrees_of_freedom();
  if (!(e.degrees_of_freedom > 0.0)) {
    return unexpected(counted(averages_, "segment") + ", worth " + short_number(e.effective_averages) +
                      " averages; needed: more than " + std::to_string(inputs_) + ", one an input");
  }
  const Eigen::Index rows = last - first + 1;
  e.response.resize(rows, outputs_ * inputs_);
  e.variance.resize(rows, outputs_ * inputs_);
  e.coherence.resize(rows, outputs_);
  e.input_density.resize(rows, inputs_);
  e.output_density.resize(rows, outputs_);
  const Eigen::Index channels = inputs_ + outputs_;
  for (Eigen::Index j = 0; j < inputs_; ++j) {
    const auto power = sums_.col(j * channels + j).real();
    const double least = kSilent * power.maxCoeff();
    for (std::int64_t k = first; k <= last; ++k) {
      if (!(power[k] > least)) return unexpected(place(k) + ": input " + std::to_string(j + 1) + " is silent there");
    }
  }
  for (Eigen::Index row = 0; row < rows; ++row) {
    const std::int64_t k = first + row;
    e.lines.push_back(k);
    densities(k, row, e);
    if (auto done = least_squares(k, row, e); !done) return unexpected(done.error().text);
    if (form == WelchForm::h1) continue;
    if (auto done = other_form(form, k, row, e); !done) return unexpected(done.error().text);
  }
  return e;
}

}  // namespace bodeflow::spectrum
