#include "periodic/periodic_prediction.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "model/sampled_path.hpp"
#include "model/simulate.hpp"
#include "periodic/fourier.hpp"
#include "periodic/reaction_of_immittances.hpp"
#include "sampled/record_input.hpp"

namespace bodeflow::residual {
namespace {

using Complex = std::complex<double>;

// Values of a band-limited input for each sample: of a map, and of a simulation.
constexpr int kFine = 4;
constexpr int kFineSimulated = 2;
// Values of an output for each sample that goes through a map with memory: it remembers peaks between the samples too.
constexpr int kFineRemembered = 8;
constexpr double kTwoPi = 2.0 * std::numbers::pi;
// A response that grows so much from the first line to this part of it is that of an integrator.
constexpr double kNearDc = 1e-6, kIntegrates = 1e4;

Complex s_at(double frequency_hz) { return {0.0, kTwoPi * frequency_hz}; }

class Predictor {
 public:
  Predictor(const PeriodicRecord& record, const JointModel& model, const Eigen::VectorXd& values, bool signals)
      : r_(record),
        model_(model),
        values_(values),
        signals_(signals),
        path_(model, values, record.known, record.sample_time_s()) {
    const bool timed = model.nonstationary();
    periods_ = timed ? record.skip + record.periods : 1;
    simulated_ = model.has(Acts::law) || model.base->has_laws();
    held_ = model.base->timing().hold != Hold::band_limited;
    const double first_hz = record.line_hz();
    integrates_ = path_.at(kNearDc * first_hz).norm() > kIntegrates * path_.at(first_hz).norm();
    map_input();
  }

  PeriodicPrediction run() {
    PeriodicPrediction p = predicted();
    // Where an integrator stands is no matter of the model.
    if (integrates_) p.bins[0] = r_.output[0];
    return p;
  }

 private:
  PeriodicPrediction predicted() {
    const bool mapped_output = model_.has(Acts::output);
    if (!simulated_ && !mapped_output && periods_ == 1) {
      p_.bins = Eigen::VectorXcd::Zero(r_.bins());
      const Eigen::VectorXcd y = linear_lines(r_.lines());
      for (Eigen::Index k = 0; k < r_.lines(); ++k) p_.bins[k * r_.periods] = y[k];
      if (signals_) simulate_signals();
      return std::move(p_);
    }
    Eigen::VectorXd y = simulated_ ? simulated_output() : linear_output();
    if (!y.allFinite()) return failed();
    for (std::size_t a = 0; a < model_.additions.size(); ++a)
      if (model_.additions[a].what.acts == Acts::output) map_output(a, y);
    bins_of_output(y);
    if (signals_ && !simulated_) simulate_signals();
    return std::move(p_);
  }

  PeriodicPrediction failed() const {
    PeriodicPrediction f;
    f.bins = Eigen::VectorXcd::Constant(r_.bins(), std::numeric_limits<double>::quiet_NaN());
    return f;
  }

  /// In place: the samples of one period, steady, or of all `periods_`.
  void map_samples(std::size_t a, double step_s, Eigen::VectorXd& x) const {
    const Addition& addition = model_.additions[a];
    const double* p = model_.values_of(a, values_);
    std::vector<double> memory(addition.what.memory, 0.0);
    const bool timed = periods_ > 1;
    if (!timed && addition.what.memory > 0)
      for (Eigen::Index n = 0; n < x.size(); ++n) addition.effect->map(p, x[n], 0.0, memory.data());
    for (Eigen::Index n = 0; n < x.size(); ++n)
      x[n] = addition.effect->map(p, x[n], timed ? static_cast<double>(n) * step_s : 0.0, memory.data());
  }

  void map_output(std::size_t a, Eigen::VectorXd& y) const {
    const bool fine = periods_ == 1 && model_.additions[a].what.memory > 0;
    if (!fine) return map_samples(a, r_.sample_time_s(), y);
    Eigen::VectorXd between = signal_of(coefficients(y), y.size() * kFineRemembered);
    map_samples(a, r_.sample_time_s() / kFineRemembered, between);
    for (Eigen::Index n = 0; n < y.size(); ++n) y[n] = between[n * kFineRemembered];
  }

  /// The input behind the maps of Acts::input: samples of the period (or of all of the record), finer for a band-limited one.
  void map_input() {
    fine_ = 1;
    const bool mapped = model_.has(Acts::input);
    input_ = r_.input;
    // What repeats behind an integrator has a mean of 0 in front of it: the mean that was measured is balanced by a load.
    if (integrates_) input_.rowwise() -= input_.colwise().mean().eval();
    if (!mapped) {
      if (periods_ > 1 && !simulated_) input_ = input_.replicate(periods_, 1).eval();
      return;
    }
    const Eigen::MatrixXd period = input_;
    if (!held_) {
      fine_ = kFine;
      input_.resize(r_.period * fine_, period.cols());
      for (Eigen::Index j = 0; j < period.cols(); ++j) input_.col(j) = signal_of(coefficients(period.col(j)), input_.rows());
    }
    if (periods_ > 1) input_ = input_.replicate(periods_, 1).eval();
    for (std::size_t a = 0; a < model_.additions.size(); ++a) {
      if (model_.additions[a].what.acts != Acts::input) continue;
      Eigen::VectorXd u = input_.col(0);
      map_samples(a, r_.sample_time_s() / fine_, u);
      input_.col(0) = u;
    }
  }

  /// How many of the periods `input_` holds.
  Eigen::Index input_periods() const { return input_.rows() / (r_.period * fine_); }

  /// Lines 0 .. count - 1 of the output of a linear path, multiples of the line of `input_`.
  Eigen::VectorXcd linear_lines(Eigen::Index count) const {
    Eigen::MatrixXcd u(input_.rows() / 2 + 1, input_.cols());
    for (Eigen::Index j = 0; j < input_.cols(); ++j) u.col(j) = coefficients(input_.col(j));
    const double line_hz = r_.line_hz() / static_cast<double>(input_periods()), largest = u.cwiseAbs().maxCoeff();
    Eigen::VectorXcd y = Eigen::VectorXcd::Zero(count);
    for (Eigen::Index k = 0; k < std::min(count, u.rows()); ++k) {
      if (u.row(k).cwiseAbs().maxCoeff() <= 1e-15 * largest) continue;
      y[k] = (path_.at(static_cast<double>(k) * line_hz) * u.row(k).transpose())(0);
      if (k == 0) y[k] = y[k].real();
    }
    return y;
  }

  Eigen::VectorXd linear_output() const {
    const Eigen::Index samples = r_.period * input_periods();
    Eigen::VectorXd y = signal_of(linear_lines((samples + 1) / 2), samples);
    if (samples < r_.period * periods_) y = y.replicate(periods_, 1).eval();
    return y;
  }

  Drive drive() const {
    Drive d;
    d.hold = model_.base->timing().hold;
    d.sample_time_s = r_.sample_time_s();
    d.delay_s = model_.delay_s(values_);
    d.periodic = true;
    d.periods = periods_ / input_periods();
    d.signals = signals_ || model_.has(Acts::immittance);
    d.values_per_sample = simulated_values();
    d.input = held_ ? input_ : refined(input_, d.values_per_sample / fine_);
    return d;
  }

  Eigen::VectorXd simulated_output() {
    Drive d = drive();
    auto s = model_.has(Acts::immittance) ? simulate_with_immittances(model_, values_, r_.known, path_, d)
                                          : simulate(model_, values_, r_.known, d);
    if (!s) return Eigen::VectorXd::Constant(1, std::numeric_limits<double>::quiet_NaN());
    Eigen::VectorXd y = std::move(s->output);
    if (signals_) {
      p_.flow = s->flow.topRows(r_.period);
      p_.stored = s->stored.topRows(r_.period);
    }
    if (model_.has(Acts::parallel) || model_.has(Acts::series)) add_paths(y);
    if (!model_.has(Acts::immittance) && path_.path().matrices()) correct_linear_part(y);
    return y;
  }

  int simulated_values() const { return held_ ? 1 : fine_ > 1 ? fine_ : kFineSimulated; }

  /// Takes from a simulated output what its chain makes of the linear plant and adds what the linear path says: a simulation
  /// leaves images of the straight lines between the values of a band-limited input, and lets series effects act behind the
  /// sampling.
  void correct_linear_part(Eigen::VectorXd& y) const {
    const bool paths = model_.has(Acts::parallel) || model_.has(Acts::series);
    if (held_ && !paths) return;
    const Hold hold = model_.base->timing().hold;
    const int values = simulated_values();
    const double step_s = r_.sample_time_s(), delay_s = model_.delay_s(values_);
    const SampledPlant simulated(*path_.path().matrices(), path_.path().modes(), hold != Hold::zero_order, step_s, delay_s,
                                 values);
    Eigen::VectorXcd lines = coefficients(y);
    Eigen::MatrixXcd u(input_.rows() / 2 + 1, input_.cols());
    for (Eigen::Index j = 0; j < input_.cols(); ++j) u.col(j) = coefficients(input_.col(j));
    const Eigen::Index more = y.size() / (r_.period * input_periods());
    const double line_hz = r_.sample_rate_hz / static_cast<double>(y.size()), largest = u.cwiseAbs().maxCoeff();
    for (Eigen::Index k = more; k < lines.size(); k += more) {
      const auto in = u.row(k / more);
      if (in.cwiseAbs().maxCoeff() <= 1e-12 * largest) continue;
      const double f = static_cast<double>(k) * line_hz;
      Eigen::RowVectorXcd chain = simulated.at(f);
      if (!held_) chain /= hold_response(Hold::first_order, f, step_s / values);
      if (paths) {
        chain[0] += path_.path().parallel(s_at(f)) * hold_response(hold, f, step_s) * std::polar(1.0, -kTwoPi * f * delay_s);
        chain *= path_.path().series(s_at(f));
      }
      const Complex change = ((path_.at(f) - chain) * in.transpose())(0);
      if (std::isfinite(change.real()) && std::isfinite(change.imag())) lines[k] += change;
    }
    y = signal_of(lines, y.size());
  }

  /// Parallel and series effects on a simulated output.
  void add_paths(Eigen::VectorXd& y) const {
    Eigen::VectorXcd lines = coefficients(y), u;
    const Eigen::Index more = y.size() / (r_.period * input_periods());
    if (model_.has(Acts::parallel)) u = coefficients(input_.col(0));
    const double line_hz = r_.sample_rate_hz / static_cast<double>(y.size());
    const double delay_s = model_.delay_s(values_);
    const Hold hold = model_.base->timing().hold;
    for (Eigen::Index k = 0; k < lines.size(); ++k) {
      const double f = static_cast<double>(k) * line_hz;
      if (u.size() > 0 && k % more == 0 && k / more < u.size()) {
        lines[k] += path_.path().parallel(s_at(f)) * hold_response(hold, f, r_.sample_time_s()) *
                    std::polar(1.0, -kTwoPi * f * delay_s) * u[k / more];
      }
      lines[k] *= path_.path().series(s_at(f));
    }
    y = signal_of(lines, y.size());
  }

  void bins_of_output(const Eigen::VectorXd& y) {
    p_.bins = Eigen::VectorXcd::Zero(r_.bins());
    if (periods_ == 1) {
      const Eigen::VectorXcd lines = coefficients(y);
      for (Eigen::Index k = 0; k < r_.lines(); ++k) p_.bins[k * r_.periods] = lines[k];
    } else {
      p_.bins = coefficients(y.tail(r_.periods * r_.period)).head(r_.bins());
    }
    p_.bins[0] = p_.bins[0].real();
  }

  /// Flows and stored quantities of a model that was known in closed form.
  void simulate_signals() {
    if (!model_.base->has_state_space() || model_.base->places().empty()) return;
    const auto s = simulate(model_, values_, r_.known, drive());
    if (!s) return;
    p_.flow = s->flow.topRows(r_.period);
    p_.stored = s->stored.topRows(r_.period);
  }

  const PeriodicRecord& r_;
  const JointModel& model_;
  const Eigen::VectorXd& values_;
  bool signals_;
  SampledPath path_;
  Eigen::Index periods_ = 1;  ///< that are predicted: all of the record where the time counts
  bool simulated_ = false, held_ = true, integrates_ = false;
  int fine_ = 1;           ///< values of `input_` a sample
  Eigen::MatrixXd input_;  ///< behind its maps
  PeriodicPrediction p_;
};

}  // namespace

PeriodicPrediction predict(const PeriodicRecord& record, const JointModel& model, const Eigen::VectorXd& values, bool signals) {
  return Predictor(record, model, values, signals).run();
}

}  // namespace bodeflow::residual
