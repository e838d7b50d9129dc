#include "periodic/periodic_measurement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "periodic/bin_classes.hpp"
#include "periodic/bins_left.hpp"
#include "periodic/likely_input.hpp"
#include "periodic/open_loop.hpp"
#include "periodic/periodic_prediction.hpp"
#include "periodic/periodic_views.hpp"
#include "periodic/tone_free.hpp"
#include "periodic/tones.hpp"
#include "sampled/observations.hpp"
#include "sampled/record_input.hpp"
#include "statistics.hpp"

namespace bodeflow::residual {
namespace {

constexpr double kHighest = 1e-3, kLeak = 1e-4;
// A record whose bins between the lines hold more than noise by so small a chance is judged over all its bins, else over its
// lines.
constexpr double kMoreThanNoise = 1e-4;
constexpr Eigen::Index kFewPeriods = 4;

class PeriodicMeasurement final : public Measurement {
 public:
  PeriodicMeasurement(PeriodicRecord record, std::string name, std::vector<std::string> observations, Timing timing)
      : r_(std::move(record)), observations_(std::move(observations)), timing_(timing) {
    facts_.name = std::move(name);
    facts_.input_name = r_.input_name;
    facts_.output_name = r_.output_name;
    facts_.input_unit = r_.input_unit;
    facts_.output_unit = r_.output_unit;
    facts_.checksum = r_.checksum;
    facts_.sample_rate_hz = r_.sample_rate_hz;
    facts_.samples = r_.period * r_.periods;
    facts_.periods = r_.periods;
    facts_.level = r_.input_rms;
    facts_.known = r_.known;
    const Eigen::MatrixXd none(2 * r_.bins() - 1, 0);
    for (const ClassTest& t : test_bins(r_, whitened(r_, r_.output), none, Eigen::MatrixXd(0, 0), false))
      if ((t.name == "skirts" || t.name == "peak") && t.p < kMoreThanNoise) all_bins_ = true;
    if (r_.periods < kFewPeriods)
      observations_.push_back("record '" + facts_.name + "' has " + records::counted(r_.periods, "period") +
                              ": the noise floor is uncertain and a drift hardly seen; record 6 or more");
  }

  const MeasurementFacts& facts() const override { return facts_; }
  bool floor_known() const override { return true; }
  Eigen::Index rows() const override { return 2 * r_.bins() - 1; }

  Eigen::VectorXd residual(const JointModel& model, const Eigen::VectorXd& values) const override {
    const PeriodicPrediction p = predict(r_, model, values);
    if (!p.bins.allFinite()) return Eigen::VectorXd::Constant(rows(), std::numeric_limits<double>::quiet_NaN());
    const Eigen::VectorXd left = whitened(r_, r_.output - p.bins);
    return model.has(Acts::tone) ? Tones(r_, model, values).taken_out(left) : left;
  }

  Eigen::Index eliminated(const JointModel& model, const Eigen::VectorXd& values) const override {
    return model.has(Acts::tone) ? Tones(r_, model, values).fitted() : 0;
  }

  std::unique_ptr<const OpenLoop> open_loop(const JointModel& model, const Eigen::VectorXd& values,
                                            const Eigen::VectorXd& residual, const Addition& effect) const override {
    return periodic_open_loop(r_, model, values, residual, effect);
  }

  std::shared_ptr<const Measurement> with_likely_input(const JointModel& model, const Eigen::VectorXd& values) const override {
    if (!(r_.input_variance.maxCoeff() > 0.0) || r_.input.cols() != 1) return nullptr;
    auto likely = std::make_shared<PeriodicMeasurement>(*this);
    if (!take_likely_input(model, values, likely->r_)) return nullptr;
    return likely;
  }

  std::shared_ptr<const Measurement> with_input_noise(std::uint64_t draw, double sign) const override {
    if (!(r_.input_variance.maxCoeff() > 0.0)) return nullptr;
    auto noisy = std::make_shared<PeriodicMeasurement>(*this);
    add_input_noise(draw, sign, noisy->r_);
    return noisy;
  }

  std::vector<ClassTest> tests(const Eigen::VectorXd& residual, const Eigen::MatrixXd& jacobian,
                               const Eigen::MatrixXd& covariance, bool fitted) const override {
    return test_bins(r_, residual, jacobian, covariance, fitted);
  }

  Gain gain(const Eigen::VectorXd& before, const Eigen::VectorXd& after) const override {
    Gain g;
    g.likelihood = before.squaredNorm() - after.squaredNorm();
    double expected = 0.0;
    for (Eigen::Index l = 0; l < r_.bins(); ++l) {
      if (!counts(l)) continue;
      const BinRows rows = rows_of(l);
      expected += static_cast<double>(rows.count);
      g.excess_before += before.segment(rows.begin, rows.count).squaredNorm();
      g.excess_after += after.segment(rows.begin, rows.count).squaredNorm();
    }
    g.excess_before -= expected;
    g.excess_after -= expected;
    return g;
  }

  /// error^2 / floor^2 is F distributed, with the effective degrees of freedom of the sum (F. E. Satterthwaite, Biometrics
  /// Bulletin 2 (1946) 110: 2 (sum m)^2 / sum (2 m^2 / d), m the mean and d the degrees of freedom of a bin) and those of the
  /// floor.
  HeldOutError error(const Eigen::VectorXd& residual) const override {
    const Eigen::VectorXcd left = unwhitened(r_, residual);
    double square = 0.0, mean = 0.0, spread = 0.0;
    std::vector<double> hz, part;
    for (Eigen::Index l = 0; l < r_.bins(); ++l) {
      if (!counts(l)) continue;
      const double weight = l == 0 ? 1.0 : 2.0, own = weight * r_.variance[l];
      square += weight * std::norm(left[l]);
      mean += own;
      spread += 2.0 * own * own / weight;
      hz.push_back(r_.frequency_hz[l]);
      part.push_back(own);
    }
    const double d1 = 2.0 * mean * mean / spread;
    const auto size = static_cast<Eigen::Index>(hz.size());
    const double d2 = 2.0 / r_.floor.relative_variance(Eigen::Map<const Eigen::VectorXd>(hz.data(), size),
                                                       Eigen::Map<const Eigen::VectorXd>(part.data(), size));
    HeldOutError h;
    h.error = std::sqrt(square);
    h.floor = std::sqrt(mean);
    h.highest = h.floor * std::sqrt(f_limit(kHighest, d1, d2));
    h.lowest = h.floor * std::sqrt(f_limit(1.0 - kLeak, d1, d2) * part_left_between(left));
    return h;
  }

  ResidualPicture picture(const Eigen::VectorXd& residual) const override {
    const Eigen::VectorXcd left = unwhitened(r_, residual);
    std::vector<Eigen::Index> bins;
    for (Eigen::Index l = 0; l < r_.bins(); ++l)
      if (counts(l)) bins.push_back(l);
    const auto count = static_cast<Eigen::Index>(bins.size());
    ResidualPicture p;
    p.axis = "frequency";
    p.at.resize(count);
    p.measured.resize(count);
    p.residual.resize(count);
    p.noise.resize(count);
    for (Eigen::Index n = 0; n < count; ++n) {
      const Eigen::Index l = bins[static_cast<std::size_t>(n)];
      const double rms = l == 0 ? 1.0 : std::numbers::sqrt2;
      p.at[n] = r_.frequency_hz[l];
      p.measured[n] = rms * std::abs(r_.output[l]);
      p.residual[n] = rms * std::abs(left[l]);
      p.noise[n] = rms * std::sqrt(r_.variance[l]);
      p.kind.push_back(static_cast<std::int64_t>(r_.kind[static_cast<std::size_t>(l)]));
    }
    return p;
  }

  std::vector<SeenOver> signals(const JointModel& model, const Eigen::VectorXd& values,
                                const Eigen::VectorXd& residual) const override {
    return signals_of(r_, model, values, unwhitened(r_, residual));
  }
  ResidualViews views(const Eigen::VectorXd& residual, const std::vector<SeenOver>& over) const override {
    return views_of(r_, residual, over);
  }
  std::vector<ClassSize> class_sizes(const Eigen::VectorXd& residual) const override {
    return residual::class_sizes(r_, residual);
  }

  std::vector<std::string> observations() const override { return observations_; }

  std::vector<MeasuredResponse> response() const override {
    std::vector<MeasuredResponse> all(static_cast<std::size_t>(r_.input.cols()));
    if (r_.input.cols() != 1) return all;  // one experiment does not tell several inputs apart
    MeasuredResponse& m = all.front();
    m.known = r_.known;
    for (Eigen::Index k = 1; k < r_.lines(); ++k) {
      const Eigen::Index bin = k * r_.periods;
      const std::complex<double> u = r_.input_lines(k, 0);
      if (r_.kind[static_cast<std::size_t>(bin)] != Kind::excited || u == 0.0) continue;
      const double f = r_.frequency_hz[bin];
      const std::complex<double> path =
          hold_response(timing_.hold, f, r_.sample_time_s()) * std::polar(1.0, -2.0 * std::numbers::pi * f * timing_.delay_s);
      m.frequency_hz.push_back(f);
      m.response.push_back(r_.output[bin] / (u * path));
      m.weight.push_back(std::abs(u * path) / std::sqrt(r_.variance[bin]));
    }
    return all;
  }

  void say(const JointModel& base, const Eigen::VectorXd& values, std::size_t place, Situation& s) const override {
    say_bins(r_, base, values, place, s);
  }

 private:
  /// What a model leaves between the lines, over the floor there, 1 at most: less than 1 where it explains a drift that had
  /// raised the floor.
  double part_left_between(const Eigen::VectorXcd& left) const {
    std::vector<double> hz;
    for (Eigen::Index l = 1; l < r_.bins(); ++l)
      if (!r_.is_line(l)) hz.push_back(r_.frequency_hz[l]);
    const Eigen::Map<const Eigen::VectorXd> at(hz.data(), static_cast<Eigen::Index>(hz.size()));
    const auto floor = FloorOfBins::make(at, tone_free_power(left, r_.periods, r_.period * r_.periods));
    return floor ? std::min(floor->at(at).sum() / r_.floor.at(at).sum(), 1.0) : 1.0;
  }

  bool counts(Eigen::Index bin) const { return all_bins_ || r_.is_line(bin); }

  PeriodicRecord r_;
  MeasurementFacts facts_;
  std::vector<std::string> observations_;
  Timing timing_;
  bool all_bins_ = false;
};

}  // namespace

Expected<std::shared_ptr<const Measurement>> periodic_measurement(const records::Recording& recording, const std::string& name,
                                                                  std::vector<double> known, const BaseModel& base) {
  auto record = periodic_record(recording, std::move(known), base);
  if (!record) return tl::unexpected(record.error());
  return std::make_shared<const PeriodicMeasurement>(std::move(*record), name, observe(recording), base.timing());
}

}  // namespace bodeflow::residual
