#include "sampled/what_is_left.hpp"

#include <algorithm>
#include <cmath>

#include "model/plant_matrices.hpp"
#include "sampled/record_spectra.hpp"

namespace bodeflow::residual {
namespace {

constexpr std::size_t kPeaks = 6, kJumps = 6;

double rms(const Eigen::VectorXd& x) {
  return std::sqrt(x.squaredNorm() / static_cast<double>(std::max<Eigen::Index>(x.size(), 1)));
}

/// The number k with which `by` times k comes nearest to `effect`.
double ratio(const Eigen::MatrixXd& effect, const Eigen::MatrixXd& by) {
  const double power = by.squaredNorm();
  return power > 0.0 ? effect.cwiseProduct(by).sum() / power : 0.0;
}

/// The linear coefficient of the plant at a place: what reaction over flow (stored) it has there already, w = k flow, from the
/// way in which w would act: A = E k Cf + ..., for a plant without states D = F k Df + ...
double coefficient(const PlantMatrices& p, Eigen::Index place, bool over_stored) {
  const Eigen::RowVectorXd seen =
      p.states() > 0 ? (over_stored ? p.Cs : p.Cf).row(place) : (over_stored ? p.Ds : p.Df).row(place);
  if (p.states() > 0) return std::abs(ratio(p.A, p.E.col(place) * seen));
  return std::abs(ratio(p.D, p.F.col(place) * seen));
}

/// A reaction that does as much as the input does: its size for a plant that the input drives, else what the output is made of.
double effort_of(const PlantMatrices& p, Eigen::Index place, double input_peak, double output_peak) {
  if (p.states() == 0) return p.F.col(place).norm() > 0.0 ? output_peak / p.F.col(place).norm() : output_peak;
  const double by_reaction = p.E.col(place).norm();
  return by_reaction > 0.0 ? input_peak * p.B.col(0).norm() / by_reaction : input_peak;
}

void describe_place(const SampledRecord& record, const JointModel& base, const Eigen::VectorXd& values,
                    const Predicted& predicted, std::size_t place, Situation& s) {
  const auto column = static_cast<Eigen::Index>(place);
  if (predicted.flow.cols() > column) {
    s.place.flow = std::max(s.place.flow, predicted.flow.col(column).cwiseAbs().maxCoeff());
    s.place.stored = std::max(s.place.stored, predicted.stored.col(column).cwiseAbs().maxCoeff());
  }
  const auto plant = plant_matrices(*base.base, values.data(), record.input.known());
  if (!plant) return;
  const std::string& kind = s.place.kind;
  const bool over_stored = kind == "spring" || kind == "coupling" || kind == "tank" || kind == "core";
  s.place.coefficient = coefficient(*plant, column, over_stored);
  s.place.effort = std::max(s.place.effort, effort_of(*plant, column, s.input_peak, s.output_peak));
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
  const auto predicted = predict(record, base, values);
  if (!predicted || !predicted->output.allFinite()) return;
  const Eigen::VectorXd residual = record.rows_of(record.output - predicted->output);
  if (place != Addition::kNoPlace) describe_place(record, base, values, *predicted, place, s);
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
