#include "sampled/what_is_left.hpp"

#include <algorithm>
#include <cmath>

#include "model/place_scales.hpp"
#include "model/simulate.hpp"
#include "sampled/record_spectra.hpp"

namespace bodeflow::residual {
namespace {

constexpr std::size_t kPeaks = 6, kJumps = 6;

double rms(const Eigen::VectorXd& x) {
  return std::sqrt(x.squaredNorm() / static_cast<double>(std::max<Eigen::Index>(x.size(), 1)));
}

void describe_missing(const SampledRecord& record, const JointModel& base, const Eigen::VectorXd& values,
                      const Eigen::VectorXd& residual, Situation& s) {
  const double t = record.input.sample_time_s();
  const MeasuredResponse missing = averaged_response(record.rows_of(record.input.channel(0)), residual, t);
  s.line_hz = missing.frequency_hz;
  s.missing = missing.response;
  s.missing_std.clear();
  s.response.clear();
  for (std::size_t i = 0; i < missing.frequency_hz.size(); ++i) {
    s.missing_std.push_back(1.0 / missing.weight[i]);
    s.response.push_back(sampled_response(base, values, record.input.known(), missing.frequency_hz[i], t)[0]);
  }
}

}  // namespace

void describe_situation(const SampledRecord& record, bool inverse, const JointModel& base, const Eigen::VectorXd& values,
                        std::size_t place, Situation& s) {
  const double t = record.input.sample_time_s(), row_time_s = t * static_cast<double>(record.layout.stride);
  const Eigen::VectorXd u = record.input.channel(0);
  const double duration_s = t * static_cast<double>(record.output.size());
  const bool louder = rms(u) >= s.input_rms;
  s.sample_time_s = t;
  s.duration_s = s.duration_s > 0.0 ? std::min(s.duration_s, duration_s) : duration_s;
  s.input_peak = std::max(s.input_peak, u.cwiseAbs().maxCoeff());
  s.input_rms = std::max(s.input_rms, rms(u));
  s.output_peak = std::max(s.output_peak, record.output.cwiseAbs().maxCoeff());
  s.output_rms = std::max(s.output_rms, rms(record.output));
  const auto predicted = predict(record, base, values, true);
  if (!predicted || !predicted->output.allFinite()) return;
  const Eigen::VectorXd residual = record.rows_of(record.output - predicted->output);
  if (place != Addition::kNoPlace) say_place(base, values, record.input.known(), predicted->flow, predicted->stored, place, s);
  if (!louder) return;
  s.residual_mean = residual.mean();
  s.residual_rms = rms(residual);
  s.peaks_hz = peak_frequencies(residual, row_time_s, kPeaks);
  s.jumps_s.clear();
  const std::vector<Eigen::Index> samples = record.row_samples();
  for (const Eigen::Index row : change_points(residual, kJumps))
    s.jumps_s.push_back(t * static_cast<double>(samples[static_cast<std::size_t>(row)]));
  if (!inverse && record.layout.stride == 1) describe_missing(record, base, values, residual, s);
}

}  // namespace bodeflow::residual
