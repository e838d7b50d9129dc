#include "sine_dwell.hpp"

#include <algorithm>
#include <cmath>

namespace bodeflow::spectrum {
namespace {

// A correlation rounds at about 1e-16 of the largest sample times a few: what is below this share of it is no sine.
constexpr double kRounding = 1e-12;

}  // namespace

SineDwell::SineDwell(std::int64_t window, std::int64_t cycles, std::size_t outputs, const SettlingRule& rule)
    : window_(window), rule_(rule), table_(window, cycles), sums_(1 + outputs, SineWindow(window)) {
  if (rule_.kind != SettlingRule::Kind::envelope) return;
  for (std::size_t i = 0; i < outputs; ++i) {
    const SettledStretch stretch(settling_threshold(rule_.noise.at(i), window, rule_.factor));
    stretches_.insert(stretches_.end(), 2, stretch);
  }
}

bool SineDwell::push(std::span<const double> sample) {
  const std::complex<double> turn = table_[at_];
  at_ = at_ + 1 == table_.size() ? 0 : at_ + 1;
  ++samples_;
  peak_ = std::max(peak_, std::abs(sample[0]));
  const bool complete = at_ == 0;
  for (std::size_t s = 0; s < sums_.size(); ++s) {
    const std::complex<double> amplitude = sums_[s].push(sample[s] * turn);
    if (complete) amplitudes_.push_back(amplitude);
    if (s == 0 || stretches_.empty() || samples_ < window_) continue;
    stretches_[2 * s - 2].push(amplitude.real());
    stretches_[2 * s - 1].push(amplitude.imag());
  }
  if (complete && rule_.kind == SettlingRule::Kind::repeat) compare_windows();
  return complete;
}

void SineDwell::compare_windows() {
  const std::size_t signals = sums_.size();
  if (amplitudes_.size() < 2 * signals) return;
  for (std::size_t s = 0; s < signals; ++s) {
    const auto now = amplitudes_[amplitudes_.size() - signals + s], before = amplitudes_[amplitudes_.size() - 2 * signals + s];
    if (std::abs(now - before) <= rule_.tolerance * std::abs(now)) continue;
    agreeing_from_ = windows() - 1;
    return;
  }
}

std::int64_t SineDwell::settled_from() const {
  if (rule_.kind == SettlingRule::Kind::repeat) return agreeing_from_ * window_;
  std::size_t from = 0;
  for (const SettledStretch& s : stretches_) from = std::max(from, s.from());
  return static_cast<std::int64_t>(from);
}

std::int64_t SineDwell::settled_windows() const {
  return std::max<std::int64_t>(0, windows() - (settled_from() + window_ - 1) / window_);
}

Expected<SineResponse> SineDwell::estimate(std::int64_t count) const {
  using Rows = Eigen::Matrix<std::complex<double>, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const auto signals = static_cast<Eigen::Index>(sums_.size());
  const Eigen::MatrixXcd last =
      Eigen::Map<const Rows>(amplitudes_.data(), windows(), signals).bottomRows(std::min(count, windows()));
  auto response = sine_response(last.col(0), last.rightCols(signals - 1));
  if (response && !(std::abs(response->input_mean) > kRounding * peak_))
    return unexpected("the input does not hold this frequency");
  return response;
}

}  // namespace bodeflow::spectrum
