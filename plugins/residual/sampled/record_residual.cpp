#include "sampled/record_residual.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <numbers>

#include "sampled/initial_state.hpp"

namespace bodeflow::residual {
namespace {

Eigen::VectorXd without_tones(const SampledRecord& record, const JointModel& model, const Eigen::VectorXd& values,
                              Eigen::VectorXd rest) {
  std::vector<double> tones;
  for (std::size_t a = 0; a < model.additions.size(); ++a) {
    if (model.additions[a].what.acts != Acts::tone) continue;
    const auto more = model.additions[a].effect->tones_hz(model.values_of(a, values));
    tones.insert(tones.end(), more.begin(), more.end());
  }
  if (tones.empty()) return rest;
  const std::vector<Eigen::Index> samples = record.row_samples();
  Eigen::MatrixXd waves(rest.size(), 2 * static_cast<Eigen::Index>(tones.size()));
  for (std::size_t k = 0; k < tones.size(); ++k) {
    const double step = 2.0 * std::numbers::pi * tones[k] * record.input.sample_time_s();
    if (!std::isfinite(step)) return Eigen::VectorXd::Constant(rest.size(), std::numeric_limits<double>::quiet_NaN());
    const auto column = 2 * static_cast<Eigen::Index>(k);
    for (Eigen::Index n = 0; n < rest.size(); ++n) {
      const double phase = step * static_cast<double>(samples[static_cast<std::size_t>(n)]);
      waves(n, column) = std::cos(phase);
      waves(n, column + 1) = std::sin(phase);
    }
  }
  const Eigen::MatrixXd normal = waves.transpose() * waves;
  const Eigen::VectorXd size = normal.completeOrthogonalDecomposition().solve(waves.transpose() * rest);
  return rest - waves * size;
}

}  // namespace

std::vector<Eigen::Index> SampledRecord::row_samples() const {
  std::vector<Eigen::Index> samples;
  for (const Layout::Segment& s : layout.segments)
    for (Eigen::Index i = 0; i < s.rows; ++i) samples.push_back(s.first_row + i * layout.stride);
  return samples;
}

Eigen::VectorXd SampledRecord::rows_of(const Eigen::VectorXd& at_samples) const {
  Eigen::VectorXd rows(layout.rows);
  Eigen::Index row = 0;
  for (const Layout::Segment& s : layout.segments)
    for (Eigen::Index i = 0; i < s.rows; ++i) rows[row++] = at_samples[s.first_row + i * layout.stride];
  return rows;
}

Expected<Predicted> predict(const SampledRecord& record, const JointModel& model, const Eigen::VectorXd& values, bool signals) {
  const auto prediction = Prediction::make(record.input, model, values);
  if (!prediction) return tl::unexpected(prediction.error());
  Predicted p;
  p.output = Eigen::VectorXd::Zero(record.output.size());
  for (const Layout::Segment& s : record.layout.segments) {
    const Stretch window{s.samples.first, s.window};
    const auto state = initial_state(*prediction, window, record.output.segment(window.first, window.count));
    if (!state) return tl::unexpected(state.error());
    const auto run = prediction->run(s.samples, *state, signals);
    if (!run) return tl::unexpected(run.error());
    p.output.segment(s.samples.first, s.samples.count) = run->output;
    if (run->flow.size() == 0) continue;
    if (p.flow.size() == 0) p.flow = p.stored = Eigen::MatrixXd::Zero(record.output.size(), run->flow.cols());
    p.flow.middleRows(s.samples.first, s.samples.count) = run->flow;
    p.stored.middleRows(s.samples.first, s.samples.count) = run->stored;
  }
  return p;
}

Eigen::VectorXd unexplained(const SampledRecord& record, const JointModel& model, const Eigen::VectorXd& values) {
  const auto predicted = predict(record, model, values);
  if (!predicted) return Eigen::VectorXd::Constant(record.layout.rows, std::numeric_limits<double>::quiet_NaN());
  return without_tones(record, model, values, record.rows_of(record.output - predicted->output));
}

}  // namespace bodeflow::residual
