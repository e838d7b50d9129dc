#include "sampled/record_input.hpp"

#include <cmath>
#include <numbers>

#include "sampled/record_spectrum.hpp"

namespace bodeflow::residual {
namespace {

constexpr int kBandLimited = 4;

}  // namespace

std::complex<double> hold_response(Hold hold, double frequency_hz, double sample_time_s) {
  const double x = std::numbers::pi * frequency_hz * sample_time_s, sinc = x == 0.0 ? 1.0 : std::sin(x) / x;
  if (hold == Hold::zero_order) return std::polar(1.0, -x) * sinc;
  return hold == Hold::first_order ? sinc * sinc : 1.0;
}

std::complex<double> RecordInput::path(double frequency_hz) const {
  if (filter_hz_ > 0.0) return 1.0;
  const double phase = -2.0 * std::numbers::pi * frequency_hz * timing_.delay_s;
  return hold_response(timing_.hold, frequency_hz, sample_time_s_) * std::polar(1.0, phase);
}

RecordInput::RecordInput(Eigen::MatrixXd channels, double sample_time_s, std::vector<double> known, const BaseModel& base)
    : channels_(std::move(channels)),
      sample_time_s_(sample_time_s),
      known_(std::move(known)),
      inputs_(base.inputs()),
      filter_hz_(base.filter_hz()),
      timing_(base.timing()),
      joined_(timing_.hold) {
  at_samples_ = plant_inputs(channels_);
  if (joined_ == Hold::band_limited && filter_hz_ == 0.0) {
    values_per_sample_ = kBandLimited;
    joined_ = Hold::first_order;
    fine_.resize(samples() * kBandLimited, at_samples_.cols());
    for (Eigen::Index i = 0; i < fine_.cols(); ++i) fine_.col(i) = interpolated(at_samples_.col(i), kBandLimited);
    ready_ = corrected(fine_);
  } else {
    if (joined_ == Hold::band_limited) joined_ = Hold::zero_order;  // of a plant without states: the samples alone count
    ready_ = at_samples_;
  }
}

Eigen::MatrixXd RecordInput::plant_inputs(const Eigen::MatrixXd& channels) const {
  Eigen::MatrixXd u(channels.rows(), static_cast<Eigen::Index>(inputs_.size()));
  for (Eigen::Index i = 0; i < u.cols(); ++i) {
    const PlantInput& input = inputs_[static_cast<std::size_t>(i)];
    if (filter_hz_ > 0.0)
      u.col(i) = smooth_derivative(channels.col(input.channel), sample_time_s_, filter_hz_, input.derivative);
    else
      u.col(i) = channels.col(input.channel);
  }
  return u;
}

/// Straight lines between values lower a frequency by sinc^2 = 1 - x^2/12 + ..., x its phase from value to value; a twelfth of
/// the second difference taken off raises it by 1 + x^2/12 - x^4/144.
Eigen::MatrixXd RecordInput::corrected(Eigen::MatrixXd fine) const {
  const Eigen::Index last = fine.rows() - 1;
  for (Eigen::Index c = 0; c < fine.cols(); ++c) {
    double before = fine(0, c);
    for (Eigen::Index n = 1; n < last; ++n) {
      const double here = fine(n, c);
      fine(n, c) = here - (before - 2.0 * here + fine(n + 1, c)) / 12.0;
      before = here;
    }
  }
  return fine;
}

Eigen::MatrixXd RecordInput::mapped_values(const JointModel& model, const Eigen::VectorXd& parameters) const {
  const bool between = fine_.rows() > 0;
  Eigen::MatrixXd mapped = between ? fine_ : channels_;
  const double step_s = sample_time_s_ / static_cast<double>(between ? values_per_sample_ : 1);
  for (std::size_t a = 0; a < model.additions.size(); ++a) {
    const Addition& addition = model.additions[a];
    if (addition.what.acts != Acts::input) continue;
    std::vector<double> memory(addition.what.memory, 0.0);
    const double* p = model.values_of(a, parameters);
    for (Eigen::Index n = 0; n < mapped.rows(); ++n)
      mapped(n, 0) = addition.effect->map(p, mapped(n, 0), static_cast<double>(n) * step_s, memory.data());
  }
  return between ? corrected(std::move(mapped)) : plant_inputs(mapped);
}

}  // namespace bodeflow::residual
