#include "periodic/bins_left.hpp"

#include <algorithm>
#include <cmath>

#include "model/place_scales.hpp"
#include "model/simulate.hpp"
#include "periodic/fourier.hpp"
#include "periodic/periodic_prediction.hpp"
#include "sampled/record_spectra.hpp"

namespace bodeflow::residual {
namespace {

constexpr std::size_t kPeaks = 6, kJumps = 6;
// Chance that noise alone has such a peak somewhere.
constexpr double kChancePeak = 1e-3;

/// The frequencies of the highest peaks between the lines, highest first: a rectangular window shows a tone between two bins by
/// amplitudes in the ratio of its distances to the other one.
std::vector<double> peaks(const PeriodicRecord& r, const Eigen::VectorXcd& residual) {
  const double limit = std::log(static_cast<double>(r.bins()) / kChancePeak);
  std::vector<std::pair<double, double>> found;  // power over the floor, frequency
  const auto size = [&](Eigen::Index l) { return std::abs(residual[l]) / std::sqrt(r.variance[l]); };
  for (Eigen::Index l = 1; l + 1 < r.bins(); ++l) {
    if (r.is_line(l) || size(l) * size(l) < limit || size(l) < size(l - 1) || size(l) < size(l + 1)) continue;
    const bool above = size(l + 1) > size(l - 1);
    const double other = size(above ? l + 1 : l - 1), part = other / (other + size(l));
    found.emplace_back(size(l) * size(l), r.frequency_hz[l] + (above ? part : -part) * r.frequency_hz[1]);
  }
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<double> hz;
  for (std::size_t n = 0; n < std::min(found.size(), kPeaks); ++n) hz.push_back(found[n].second);
  return hz;
}

/// The residual over the steady periods of the record, with the samples that its band needs.
Eigen::VectorXd course(const PeriodicRecord& r, const Eigen::VectorXcd& residual) {
  Eigen::VectorXcd lines = residual;
  lines[0] = 0.0;
  return signal_of(lines, 2 * r.bins());
}

void say_missing(const PeriodicRecord& r, const JointModel& base, const Eigen::VectorXd& values, const Eigen::VectorXcd& residual,
                 Situation& s) {
  s.line_hz.clear();
  s.missing.clear();
  s.missing_std.clear();
  s.response.clear();
  for (Eigen::Index k = 1; k < r.lines(); ++k) {
    const Eigen::Index bin = k * r.periods;
    const std::complex<double> u = r.input_lines(k, 0);
    if (r.kind[static_cast<std::size_t>(bin)] != Kind::excited || u == 0.0) continue;
    s.line_hz.push_back(r.frequency_hz[bin]);
    s.missing.push_back(residual[bin] / u);
    s.missing_std.push_back(std::sqrt(r.variance[bin]) / std::abs(u));
    s.response.push_back(sampled_response(base, values, r.known, r.frequency_hz[bin], r.sample_time_s())[0]);
  }
}

}  // namespace

void say_bins(const PeriodicRecord& r, const JointModel& base, const Eigen::VectorXd& values, std::size_t place, Situation& s) {
  const double duration_s = static_cast<double>(r.period * r.periods) / r.sample_rate_hz;
  const double skipped_s = static_cast<double>(r.skip * r.period) / r.sample_rate_hz, whole_s = skipped_s + duration_s;
  const bool louder = r.input_rms >= s.input_rms;
  s.input_unit = r.input_unit;
  s.output_unit = r.output_unit;
  s.sample_time_s = r.sample_time_s();
  s.duration_s = s.duration_s > 0.0 ? std::min(s.duration_s, whole_s) : whole_s;
  s.input_peak = std::max(s.input_peak, r.input_peak);
  s.input_rms = std::max(s.input_rms, r.input_rms);
  s.output_peak = std::max(s.output_peak, r.output_peak);
  s.output_rms = std::max(s.output_rms, r.output_rms);
  const bool wants_place = place != Addition::kNoPlace;
  const PeriodicPrediction p = predict(r, base, values, wants_place);
  if (!p.bins.allFinite()) return;
  if (wants_place) say_place(base, values, r.known, p.flow, p.stored, place, s);
  if (!louder) return;
  const Eigen::VectorXcd residual = r.output - p.bins;
  s.residual_mean = residual[0].real();
  s.residual_rms = std::sqrt(std::norm(residual[0]) + 2.0 * residual.tail(residual.size() - 1).squaredNorm());
  s.peaks_hz = peaks(r, residual);
  const Eigen::VectorXd over_time = course(r, residual);
  s.jumps_s.clear();
  for (const Eigen::Index row : change_points(over_time, kJumps))
    s.jumps_s.push_back(skipped_s + duration_s * static_cast<double>(row) / static_cast<double>(over_time.size()));
  say_missing(r, base, values, residual, s);
}

}  // namespace bodeflow::residual
