#include "periodic/open_loop.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "model/linear_path.hpp"
#include "model/sampled_path.hpp"
#include "periodic/fourier.hpp"
#include "periodic/periodic_prediction.hpp"
#include "sampled/record_input.hpp"

namespace bodeflow::residual {
namespace {

using Complex = std::complex<double>;

constexpr double kTwoPi = 2.0 * std::numbers::pi;
// Values of the motion for each sample: of a law with corners or a memory, and of a smooth one.
constexpr int kFineRough = 4, kFineSmooth = 2;
// Chance that noise alone stands out at one of the lines.
constexpr double kChance = 1e-3;
// The flow over which a law may spread a jump: a part of what the jump changes itself within a step.
constexpr double kSpread = 0.05;

Complex s_at(double frequency_hz) { return {0.0, kTwoPi * frequency_hz}; }

bool finite(Complex x) { return std::isfinite(x.real()) && std::isfinite(x.imag()); }

/// What a reaction at a place moves.
class ReactionPath {
 public:
  struct Moved {
    Complex output, flow, stored;
  };

  ReactionPath(const LinearPath& path, Eigen::Index place) {
    const PlantMatrices& p = *path.matrices();
    Eigen::MatrixXd seen(3, p.states());
    seen << p.C, p.Cf.row(place), p.Cs.row(place);
    resolvent_ = Resolvent(p.A, path.modes(), p.E.col(place), seen);
    direct_ = {p.F(0, place), p.Ff(place, place), p.Fs(place, place)};
  }

  Moved at(double frequency_hz) const {
    resolvent_.at(s_at(frequency_hz), g_);
    return {g_(0, 0) + direct_[0], g_(1, 0) + direct_[1], g_(2, 0) + direct_[2]};
  }

 private:
  Resolvent resolvent_;
  std::array<double, 3> direct_{};
  mutable Eigen::MatrixXcd g_;
};

/// What all looks share: the record, the model's prediction and where a change of the output ends up.
class PeriodicLook : public OpenLoop {
 public:
  PeriodicLook(const PeriodicRecord& record, const Eigen::VectorXd& values, const Eigen::VectorXd& residual,
               const Addition& effect)
      : r_(record),
        values_(values),
        left_(unwhitened(record, residual)),
        periods_(effect.what.nonstationary ? record.skip + record.periods : 1) {}

 protected:
  Eigen::VectorXd not_finite() const {
    return Eigen::VectorXd::Constant(2 * r_.bins() - 1, std::numeric_limits<double>::quiet_NaN());
  }

  /// Rows of the residual that a change of the output's lines makes; lines of a period, or of all periods that are run through.
  Eigen::VectorXd rows(const Eigen::VectorXcd& output_lines) const {
    Eigen::VectorXcd bins = Eigen::VectorXcd::Zero(r_.bins());
    if (periods_ == 1) {
      for (Eigen::Index k = 0; k < std::min(r_.lines(), output_lines.size()); ++k) bins[k * r_.periods] = output_lines[k];
    } else {
      const Eigen::VectorXd y = signal_of(output_lines, periods_ * r_.period);
      bins = coefficients(y.tail(r_.periods * r_.period)).head(r_.bins());
    }
    bins[0] = bins[0].real();
    return -whitened(r_, bins);
  }

  /// Lines of a period of the output as the model predicts it.
  Eigen::VectorXcd predicted_lines() const {
    Eigen::VectorXcd lines(r_.lines());
    for (Eigen::Index k = 0; k < r_.lines(); ++k) lines[k] = r_.output[k * r_.periods] - left_[k * r_.periods];
    return lines;
  }

  double line_hz() const { return r_.line_hz() / static_cast<double>(periods_); }

  const PeriodicRecord& r_;
  const Eigen::VectorXd values_;  ///< of the model without the effect
  Eigen::VectorXcd left_;         ///< a bin each
  Eigen::Index periods_;          ///< that are run through
};

/// A law on the motion at its place.
class LawLook final : public PeriodicLook {
 public:
  LawLook(const PeriodicRecord& record, const JointModel& model, const Eigen::VectorXd& values, const Eigen::VectorXd& residual,
          const Addition& effect, const PeriodicPrediction& predicted)
      : PeriodicLook(record, values, residual, effect),
        path_(model, values_, record.known),
        place_(static_cast<Eigen::Index>(effect.place)),
        by_reaction_(path_, place_),
        fine_(effect.what.rough || effect.what.memory > 0 ? kFineRough : kFineSmooth) {
    move_as_measured(predicted);
    output_path();
    const PlantMatrices& p = *path_.matrices();
    const double in_step = (p.Cf.row(place_) * p.E.col(place_))(0) * step_s() + p.Ff(place_, place_);
    gain_ = kSpread * std::max(-in_step, 0.0);
  }

  bool usable() const { return flow_.allFinite() && stored_.allFinite(); }

  Eigen::VectorXd change(const JointModel& model, const Eigen::VectorXd& values) const override {
    const Addition& law = model.additions.back();
    const double* p = model.values_of(model.additions.size() - 1, values);
    const Eigen::Index period = flow_.size();
    std::vector<double> memory(law.what.memory + 1, 0.0), next = memory;
    Eigen::VectorXd reaction(period * periods_);
    const auto react = [&](Eigen::Index n, double time_s) {
      const Reaction r = law.effect->react(p, {flow_[n], stored_[n], time_s, step_s(), gain_}, memory.data(), next.data());
      memory.swap(next);
      return r.value;
    };
    if (law.what.memory > 0)
      for (Eigen::Index n = 0; n < period; ++n) react(n, 0.0);
    for (Eigen::Index n = 0; n < reaction.size(); ++n)
      reaction[n] = react(n % period, periods_ > 1 ? static_cast<double>(n) * step_s() : 0.0);
    if (!reaction.allFinite()) return not_finite();
    return rows(sampled(coefficients(reaction)));
  }

 private:
  double step_s() const { return r_.sample_time_s() / fine_; }

  void move_as_measured(const PeriodicPrediction& predicted) {
    Eigen::VectorXcd flow = coefficients(predicted.flow.col(place_)), stored = coefficients(predicted.stored.col(place_));
    const double stands_out = std::log(static_cast<double>(r_.lines()) / kChance);
    for (Eigen::Index k = 1; k < std::min(r_.lines(), flow.size()); ++k) {
      const Eigen::Index bin = k * r_.periods;
      const double power = std::norm(left_[bin]) / r_.variance[bin];
      if (!(power > stands_out)) continue;
      const ReactionPath::Moved moved = by_reaction_.at(r_.frequency_hz[bin]);
      const Complex reaction = left_[bin] / moved.output * (1.0 - 1.0 / power);
      if (!finite(reaction)) continue;
      flow[k] += moved.flow * reaction;
      stored[k] += moved.stored * reaction;
    }
    flow_ = signal_of(flow, r_.period * fine_);
    stored_ = signal_of(stored, r_.period * fine_);
  }

  /// The output by the reaction, at the lines of the fine motion.
  void output_path() {
    const Eigen::Index count = flow_.size() * periods_ / 2;
    path_lines_.resize(count);
    for (Eigen::Index k = 0; k < count; ++k) {
      const double f = static_cast<double>(k) * line_hz();
      const Complex h = by_reaction_.at(f).output * path_.series(s_at(f));
      path_lines_[k] = finite(h) ? h : 0.0;
    }
  }

  /// Lines of the sampled output: those of the fine reaction through the plant, folded.
  Eigen::VectorXcd sampled(const Eigen::VectorXcd& reaction) const {
    const Eigen::Index samples = r_.period * periods_;
    Eigen::VectorXcd lines = Eigen::VectorXcd::Zero(samples / 2 + 1);
    for (Eigen::Index k = 0; k < path_lines_.size(); ++k) {
      const Complex y = times(path_lines_[k], reaction[k]);
      const Eigen::Index at = k % samples;
      if (at < lines.size()) lines[at] += y;
      if (k > 0 && samples - at < lines.size()) lines[samples - at] += std::conj(y);
    }
    return lines;
  }

  LinearPath path_;
  Eigen::Index place_;
  ReactionPath by_reaction_;
  int fine_;
  Eigen::VectorXd flow_, stored_;  ///< of a period, `fine_` values a sample
  Eigen::VectorXcd path_lines_;
  double gain_ = 0.0;
};

/// Effects on input, output and response beside a model whose laws were simulated.
class ClosedFormLook final : public PeriodicLook {
 public:
  ClosedFormLook(const PeriodicRecord& record, const JointModel& model, const Eigen::VectorXd& values,
                 const Eigen::VectorXd& residual, const Addition& effect, const PeriodicPrediction& predicted)
      : PeriodicLook(record, values, residual, effect),
        path_(model, values_, record.known, record.sample_time_s()),
        hold_(model.base->timing().hold) {
    output_ = predicted_lines();
    for (Eigen::Index j = 0; j < r_.input.cols(); ++j) input_.push_back(coefficients(r_.input.col(j)));
    if (effect.what.acts == Acts::immittance) {
      const auto place = static_cast<Eigen::Index>(effect.place);
      flow_ = coefficients(predicted.flow.col(place));
      const ReactionPath path(path_.path(), place);
      for (Eigen::Index k = 0; k < r_.lines(); ++k) by_reaction_.push_back(path.at(static_cast<double>(k) * r_.line_hz()));
    }
  }

  Eigen::VectorXd change(const JointModel& model, const Eigen::VectorXd& values) const override {
    const std::size_t last = model.additions.size() - 1;
    const Addition& a = model.additions[last];
    const double* p = model.values_of(last, values);
    switch (a.what.acts) {
      case Acts::output:
        return mapped(*a.effect, p, a.what.memory, output_, [](Eigen::Index, Complex dy) { return dy; });
      case Acts::input:
        return mapped(*a.effect, p, a.what.memory, input_.front(),
                      [&](Eigen::Index k, Complex du) { return path_.at(static_cast<double>(k) * line_hz())[0] * du; });
      default:
        break;
    }
    Eigen::VectorXcd lines = Eigen::VectorXcd::Zero(output_.size());
    for (Eigen::Index k = 0; k < lines.size(); ++k) {
      const double f = static_cast<double>(k) * r_.line_hz();
      const Complex s = s_at(f);
      Complex y = 0.0;
      if (a.what.acts == Acts::series) {
        y = (a.effect->transfer(p, s) - 1.0) * output_[k];
      } else if (a.what.acts == Acts::delay) {
        y = (std::exp(-s * a.effect->delay_s(p)) - 1.0) * output_[k];
      } else if (a.what.acts == Acts::parallel) {
        y = a.effect->transfer(p, s) * hold_response(hold_, f, r_.sample_time_s()) * input_.front()[k];
      } else {
        const ReactionPath::Moved& moved = by_reaction_[static_cast<std::size_t>(k)];
        const Complex z = a.effect->transfer(p, s);
        y = moved.output * z / (1.0 - z * moved.flow) * flow_[k];
      }
      if (k > 0 && !finite(y)) return not_finite();
      if (finite(y)) lines[k] = y;
    }
    return rows(lines);
  }

 private:
  /// A map of the samples that have these lines, its change through a path.
  template <class Path>
  Eigen::VectorXd mapped(const Effect& effect, const double* p, std::size_t memory_size, const Eigen::VectorXcd& of,
                         const Path& path) const {
    const Eigen::VectorXd x = signal_of(of, r_.period);
    std::vector<double> memory(memory_size + 1, 0.0);
    if (memory_size > 0 && periods_ == 1)
      for (Eigen::Index n = 0; n < x.size(); ++n) effect.map(p, x[n], 0.0, memory.data());
    Eigen::VectorXd change(x.size() * periods_);
    for (Eigen::Index n = 0; n < change.size(); ++n) {
      const double here = x[n % x.size()], time_s = periods_ > 1 ? static_cast<double>(n) * r_.sample_time_s() : 0.0;
      change[n] = effect.map(p, here, time_s, memory.data()) - here;
    }
    if (!change.allFinite()) return not_finite();
    Eigen::VectorXcd lines = coefficients(change);
    for (Eigen::Index k = 0; k < lines.size(); ++k) {
      lines[k] = path(k, lines[k]);
      if (!finite(lines[k])) lines[k] = 0.0;
    }
    return rows(lines);
  }

  SampledPath path_;
  Hold hold_;
  Eigen::VectorXcd output_, flow_;  ///< lines of a period
  std::vector<ReactionPath::Moved> by_reaction_;
  std::vector<Eigen::VectorXcd> input_;
};

}  // namespace

std::unique_ptr<const OpenLoop> periodic_open_loop(const PeriodicRecord& record, const JointModel& model,
                                                   const Eigen::VectorXd& values, const Eigen::VectorXd& residual,
                                                   const Addition& effect) {
  const Acts acts = effect.what.acts;
  const bool simulated = model.has(Acts::law) || model.base->has_laws();
  if (acts == Acts::tone || !model.base->has_state_space() || (acts != Acts::law && !simulated)) return nullptr;
  const bool wants_place = acts == Acts::law || acts == Acts::immittance;
  PeriodicPrediction predicted;
  if (wants_place) {
    predicted = predict(record, model, values, true);
    if (predicted.flow.rows() != record.period || !predicted.flow.allFinite() || !predicted.stored.allFinite()) return nullptr;
  }
  if (acts != Acts::law) return std::make_unique<ClosedFormLook>(record, model, values, residual, effect, predicted);
  auto look = std::make_unique<LawLook>(record, model, values, residual, effect, predicted);
  if (!look->usable()) return nullptr;
  return look;
}

}  // namespace bodeflow::residual
