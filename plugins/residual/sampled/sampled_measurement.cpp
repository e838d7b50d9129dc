#include "sampled/sampled_measurement.hpp"

#include <algorithm>
#include <cmath>

#include "records/checksum.hpp"
#include "records/signals.hpp"
#include "sampled/base_level.hpp"
#include "sampled/block_statistics.hpp"
#include "sampled/correlation_tests.hpp"
#include "sampled/noise_model.hpp"
#include "sampled/observations.hpp"
#include "sampled/open_loop.hpp"
#include "sampled/record_residual.hpp"
#include "sampled/record_spectra.hpp"
#include "sampled/record_spectrum.hpp"
#include "sampled/residual_looks.hpp"
#include "sampled/what_is_left.hpp"

namespace bodeflow::residual {
namespace {

constexpr Eigen::Index kLeastSamples = 128;  // for a response to start from
constexpr double kCoarseStep = 1e-3;
constexpr double kFeedback = 1e-3, kDrift = 4.0;
constexpr Eigen::Index kMostDrawn = 4000;
// Rows of an excerpt, for records of at least so many: an effect that lowers the error by 2 % gains 96 on them.
constexpr Eigen::Index kExcerpt = 2400, kLongRecord = 12000;
constexpr Eigen::Index kRowsOfBase = 12288;
constexpr std::size_t kMostPlaces = 3;  // whose flow and stored quantity a residual is looked at over

class SampledMeasurement final : public Measurement {
 public:
  SampledMeasurement(SampledRecord record, MeasurementFacts facts, std::vector<std::string> observations, double filter_hz)
      : record_(std::move(record)), facts_(std::move(facts)), observations_(std::move(observations)), filter_hz_(filter_hz) {}

  void cut(Layout layout) {
    record_.layout = std::move(layout);
    facts_.samples = record_.layout.rows;
  }
  void count_in(double unit) { unit_ = unit; }
  const SampledRecord& record() const { return record_; }

  const MeasurementFacts& facts() const override { return facts_; }
  bool floor_known() const override { return false; }
  Eigen::Index rows() const override { return record_.layout.rows; }
  Eigen::VectorXd residual(const JointModel& model, const Eigen::VectorXd& values) const override {
    return unexplained(record_, model, values) / unit_;
  }
  Eigen::Index eliminated(const JointModel& model, const Eigen::VectorXd& values) const override;
  std::shared_ptr<const Measurement> excerpt() const override {
    if (rows() < kLongRecord) return nullptr;
    auto part = excerpt_of(record_.layout, kExcerpt);
    if (!part) return nullptr;
    auto m = std::make_shared<SampledMeasurement>(*this);
    m->cut(std::move(*part));
    return m;
  }
  std::unique_ptr<const OpenLoop> open_loop(const JointModel& model, const Eigen::VectorXd& values,
                                            const Eigen::VectorXd& /*residual*/, const Addition& effect) const override {
    return sampled_open_loop(record_, model, values, effect, unit_);
  }
  /// The states that segments begin with are found to about 1e-5 where laws have kinks.
  double difference_step(const JointModel& model) const override {
    return record_.layout.segments.size() > 1 && model.has(Acts::law) ? kCoarseStep : Measurement::difference_step(model);
  }

  std::vector<ClassTest> tests(const Eigen::VectorXd& residual, const Eigen::MatrixXd& jacobian,
                               const Eigen::MatrixXd& covariance, bool fitted) const override;
  Gain gain(const Eigen::VectorXd& before, const Eigen::VectorXd& after) const override;
  HeldOutError error(const Eigen::VectorXd& residual) const override;
  ResidualPicture picture(const Eigen::VectorXd& residual) const override;
  std::vector<SeenOver> signals(const JointModel& model, const Eigen::VectorXd& values,
                                const Eigen::VectorXd& residual) const override;
  ResidualViews views(const Eigen::VectorXd& residual, const std::vector<SeenOver>& over) const override;
  std::vector<std::string> observations() const override;
  std::vector<std::string> remarks(const Eigen::VectorXd& residual) const override;
  std::vector<MeasuredResponse> response() const override;
  void say(const JointModel& base, const Eigen::VectorXd& values, std::size_t place, Situation& s) const override;

 private:
  /// What residuals are compared with: the input, of a position its velocity.
  Eigen::VectorXd input_rows() const {
    const Eigen::MatrixXd& u = record_.input.at_samples();
    return record_.rows_of(u.col(filter_hz_ > 0.0 && u.cols() > 1 ? 1 : 0));
  }
  double row_time_s() const { return record_.input.sample_time_s() * static_cast<double>(record_.layout.stride); }

  SampledRecord record_;
  MeasurementFacts facts_;
  std::vector<std::string> observations_;
  double filter_hz_ = 0.0;
  double unit_ = 1.0;  ///< of the output, for residuals
};

Eigen::Index SampledMeasurement::eliminated(const JointModel& model, const Eigen::VectorXd& values) const {
  LinearPlant plant;
  Eigen::Index count = 0;
  if (model.base->has_state_space() && model.base->state_space(values.data(), facts_.known.data(), plant))
    count = plant.states * static_cast<Eigen::Index>(record_.layout.segments.size());
  for (std::size_t a = 0; a < model.additions.size(); ++a)
    if (model.additions[a].what.acts == Acts::tone)
      count += 2 * static_cast<Eigen::Index>(model.additions[a].effect->tones_hz(model.values_of(a, values)).size());
  return count;
}

std::vector<ClassTest> SampledMeasurement::tests(const Eigen::VectorXd& residual, const Eigen::MatrixXd& jacobian,
                                                 const Eigen::MatrixXd& /*covariance*/, bool /*fitted*/) const {
  const Correlations c = correlate(residual, input_rows(), jacobian, record_.layout.row_stretches);
  const double root = std::sqrt(static_cast<double>(rows()));
  return {{"whiteness", c.colour, c.whiteness_p},
          {"input", std::abs(c.input.largest) * root, c.input.p},
          {"input_square", std::abs(c.input_square.largest) * root, c.input_square.p}};
}

Gain SampledMeasurement::gain(const Eigen::VectorXd& before, const Eigen::VectorXd& after) const {
  Gain g;
  g.likelihood = likelihood_gain(before, after, record_.layout.row_stretches);
  g.block_z = block_deviates(before, after);
  g.excess_before = before.squaredNorm();
  g.excess_after = after.squaredNorm();
  return g;
}

HeldOutError SampledMeasurement::error(const Eigen::VectorXd& residual) const {
  HeldOutError e;
  e.error = unit_ * residual.norm() / std::sqrt(static_cast<double>(residual.size()));
  return e;
}

/// Of as many rows as can be drawn: where there are more, the one with the greatest residual of each group.
ResidualPicture SampledMeasurement::picture(const Eigen::VectorXd& residual) const {
  const Eigen::Index count = std::min(kMostDrawn, residual.size());
  const std::vector<Eigen::Index> samples = record_.row_samples();
  ResidualPicture p;
  p.axis = "time";
  p.at.resize(count);
  p.measured.resize(count);
  p.residual.resize(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Index first = i * residual.size() / count, next = (i + 1) * residual.size() / count;
    Eigen::Index greatest = 0;
    residual.segment(first, next - first).cwiseAbs().maxCoeff(&greatest);
    const Eigen::Index row = first + greatest, sample = samples[static_cast<std::size_t>(row)];
    p.at[i] = static_cast<double>(sample) * record_.input.sample_time_s();
    p.measured[i] = record_.output[sample];
    p.residual[i] = unit_ * residual[row];
  }
  return p;
}

/// What the model predicts stands for the output: measured, it would hold the same noise as the residual.
std::vector<SeenOver> SampledMeasurement::signals(const JointModel& model, const Eigen::VectorXd& values,
                                                  const Eigen::VectorXd& residual) const {
  const Eigen::VectorXd output = record_.rows_of(record_.output) - unit_ * residual;
  std::vector<SeenOver> over = {
      {"input", facts_.input_unit, record_.rows_of(record_.input.channel(0))},
      {"output", facts_.output_unit, output},
      {"slope of the output", facts_.output_unit + "/s", slope_of(output, row_time_s(), record_.layout.row_stretches)}};
  const std::vector<Place> places = model.base->places();
  if (places.empty()) return over;
  const auto predicted = predict(record_, model, values, true);
  for (std::size_t n = 0; predicted && n < std::min(places.size(), kMostPlaces); ++n) {
    const auto column = static_cast<Eigen::Index>(n);
    if (predicted->flow.cols() <= column) break;
    over.push_back({"flow at " + places[n].name, places[n].flow_unit, record_.rows_of(predicted->flow.col(column))});
    over.push_back({"stored at " + places[n].name, places[n].stored_unit, record_.rows_of(predicted->stored.col(column))});
  }
  return over;
}

ResidualViews SampledMeasurement::views(const Eigen::VectorXd& residual, const std::vector<SeenOver>& over) const {
  const Eigen::VectorXd left = unit_ * residual;
  const std::vector<Eigen::Index> samples = record_.row_samples();
  Eigen::VectorXd time_s(left.size());
  for (Eigen::Index n = 0; n < left.size(); ++n)
    time_s[n] = static_cast<double>(samples[static_cast<std::size_t>(n)]) * record_.input.sample_time_s();
  ResidualViews views;
  for (const SeenOver& signal : over) views.maps.push_back(mean_map(left, signal.values));
  views.course = course_by_blocks(left, time_s);
  views.autocorrelation = autocorrelation(left, row_time_s(), record_.layout.row_stretches);
  return views;
}

std::vector<std::string> SampledMeasurement::observations() const {
  std::vector<std::string> said = observations_;
  if (!record_.layout.words.empty()) said.insert(said.begin(), record_.layout.words);
  return said;
}

std::vector<std::string> SampledMeasurement::remarks(const Eigen::VectorXd& residual) const {
  std::vector<std::string> said;
  const Correlations c = correlate(residual, input_rows(), Eigen::MatrixXd(rows(), 0), record_.layout.row_stretches);
  const auto where = [this](const Correlation& r) {
    return records::short_number(r.largest, 2) + " at a lag of " +
           records::short_number(1e3 * static_cast<double>(r.lag) * row_time_s(), 4) + " ms";
  };
  said.push_back("largest correlation of the residual with the input: " + where(c.input) +
                 "; of their squares: " + where(c.input_square));
  said.push_back("the residual is " + records::short_number(c.colour, 3) + " times its innovations: " +
                 records::short_number(unit_ * residual.norm() / std::sqrt(static_cast<double>(rows())) / c.colour, 3) + " " +
                 facts_.output_unit + " can't be told from what came before");
  if (c.future.p < kFeedback)
    said.push_back(
        "the residual goes with later samples of the input (" + where(c.future) +
        "): the record is of a closed loop, its noise comes back through the input and biases what a model without the loop "
        "fits");
  const Drift drift = drift_of(residual);
  if (std::abs(drift.rise) > kDrift * drift.std)
    said.push_back("the residual drifts by " + records::short_number(unit_ * drift.rise, 3) + " " + facts_.output_unit +
                   " from the begin to the end");
  return said;
}

std::vector<MeasuredResponse> SampledMeasurement::response() const {
  const double t = record_.input.sample_time_s();
  std::vector<MeasuredResponse> all = {averaged_response(record_.input.channel(0), record_.output, t)};
  for (MeasuredResponse& r : all) {
    r.known = facts_.known;
    for (std::size_t i = 0; i < r.response.size(); ++i) {
      const std::complex<double> path = record_.input.path(r.frequency_hz[i]);
      r.response[i] /= path;
      r.weight[i] *= std::abs(path);
    }
  }
  return all;
}

void SampledMeasurement::say(const JointModel& base, const Eigen::VectorXd& values, std::size_t place, Situation& s) const {
  s.input_unit = facts_.input_unit;
  s.output_unit = facts_.output_unit;
  describe_situation(record_, filter_hz_ > 0.0, base, values, place, s);
}

std::string not_finite(const Eigen::MatrixXd& samples, const records::Signals& signals) {
  for (Eigen::Index c = 0; c < samples.cols(); ++c)
    for (Eigen::Index n = 0; n < samples.rows(); ++n)
      if (!std::isfinite(samples(n, c)))
        return "'" + signals.names[static_cast<std::size_t>(c)] + "' is not finite at sample " + std::to_string(n);
  return {};
}

Expected<void> check(const records::Recording& r, const std::vector<double>& known, const BaseModel& base) {
  int channels = 0;
  for (const PlantInput& input : base.inputs()) channels = std::max(channels, input.channel + 1);
  if (r.input.cols() != channels)
    return refused("the base model has " + records::counted(channels, "input channel") + ", the record has " +
                   std::to_string(r.input.cols()));
  if (r.output.cols() != 1) return refused("the base model has one output, the record has " + std::to_string(r.output.cols()));
  if (r.samples() < kLeastSamples)
    return refused("the record has " + std::to_string(r.samples()) + " samples; needed: at least " +
                   std::to_string(kLeastSamples));
  if (known.size() != base.known().size())
    return refused("the base model needs " + records::counted(static_cast<std::int64_t>(base.known().size()), "known value") +
                   ", found " + std::to_string(known.size()));
  for (const std::string& text : {not_finite(r.input, r.input_signals), not_finite(r.output, r.output_signals)})
    if (!text.empty()) return refused(text);
  for (Eigen::Index c = 0; c < r.input.cols(); ++c)
    if (r.input.col(c).minCoeff() == r.input.col(c).maxCoeff())
      return refused("input '" + r.input_signals.names[static_cast<std::size_t>(c)] + "' does not change: nothing is excited");
  if (r.output.minCoeff() == r.output.maxCoeff()) return refused("output '" + r.output_signals.names[0] + "' does not change");
  return {};
}

MeasurementFacts facts_of(const records::Recording& r, const std::string& name, std::vector<double> known) {
  MeasurementFacts f;
  f.name = name;
  f.input_name = r.input_signals.names[0];
  f.output_name = r.output_signals.names[0];
  f.input_unit = r.input_signals.units[0];
  f.output_unit = r.output_signals.units[0];
  records::Checksum sum;
  for (Eigen::Index c = 0; c < r.input.cols(); ++c) sum.add({r.input.col(c).data(), static_cast<std::size_t>(r.samples())});
  sum.add({r.output.col(0).data(), static_cast<std::size_t>(r.samples())});
  f.checksum = sum.text();
  f.sample_rate_hz = r.sample_rate_hz;
  f.samples = r.samples();
  f.level = std::sqrt(r.input.col(0).squaredNorm() / static_cast<double>(r.samples()));
  f.known = std::move(known);
  return f;
}

/// At most about so many rows, told in its words; 0: as it is.
Layout shortened(Layout layout, Eigen::Index most_rows) {
  if (most_rows == 0 || layout.rows <= most_rows) return layout;
  auto part = excerpt_of(layout, most_rows);
  if (!part) return layout;
  part->words += (part->words.empty() ? "" : "; ") + std::to_string(part->rows) + " of " + std::to_string(layout.rows) +
                 " samples are looked at, in " + std::to_string(part->segments.size()) + " pieces spread over the record";
  return std::move(*part);
}

Expected<std::shared_ptr<const Measurement>> made(const records::Recording& r, const std::string& name, std::vector<double> known,
                                                  const BaseModel& base, const SampledOptions& options) {
  if (auto fits = check(r, known, base); !fits) return tl::unexpected(fits.error());
  const double t = 1.0 / r.sample_rate_hz, corner = base.filter_hz();
  if (corner > 0.0 && !(corner < 0.25 * r.sample_rate_hz))
    return refused("the filter's corner of " + records::short_number(corner) + " Hz is not below a quarter of the sample rate");
  SampledRecord record{RecordInput(r.input, t, known, base), r.output.col(0), {}};
  if (corner > 0.0) record.output = smooth_derivative(r.output.col(0), t, corner, 0);
  auto m = std::make_shared<SampledMeasurement>(std::move(record), facts_of(r, name, known), observe(r), corner);
  const JointModel alone{std::shared_ptr<const BaseModel>(std::shared_ptr<const BaseModel>(), &base), {}};
  const std::vector<std::vector<double>> starts = base.starts(m->response());
  Eigen::VectorXd values = Eigen::Map<const Eigen::VectorXd>(starts.at(0).data(), static_cast<Eigen::Index>(starts[0].size()));
  // Cut twice: by the start, then by the fit.
  for (int round = 0; round < 2; ++round) {
    auto layout = make_layout(r.samples(), t, base, values, known, options.segment_s);
    if (!layout) return tl::unexpected(layout.error());
    // The base's own fit to so many rows tells the unit and the length of segments well enough.
    m->cut(shortened(std::move(*layout), round > 0 ? options.most_rows : kRowsOfBase));
    if (round > 0) break;
    auto fitted = fit_base(alone, *m, starts);
    if (!fitted) return tl::unexpected(fitted.error());
    values = *fitted;
  }
  const Eigen::VectorXd left = m->residual(alone, values);
  if (!left.allFinite()) return refused("the base model can't be computed on the record");
  const double rms = left.norm() / std::sqrt(static_cast<double>(left.size()));
  if (rms > 0.0) m->count_in(rms);
  return m;
}

}  // namespace

Expected<std::shared_ptr<const Measurement>> sampled_measurement(const records::Recording& recording, const std::string& name,
                                                                 std::vector<double> known, const BaseModel& base,
                                                                 const SampledOptions& options) {
  try {
    return made(recording, name, std::move(known), base, options);
  } catch (const Failure& failure) {
    return refused(failure.what());
  }
}

}  // namespace bodeflow::residual
