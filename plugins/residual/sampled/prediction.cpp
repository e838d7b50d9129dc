#include "sampled/prediction.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "model/laws.hpp"
#include "model/plant_matrices.hpp"
#include "model/sample_delay.hpp"
#include "model/sampled_path.hpp"
#include "model/transition.hpp"
#include "sampled/record_spectrum.hpp"

namespace bodeflow::residual {
namespace {

using Complex = std::complex<double>;

Complex s_at(double frequency_hz) { return {0.0, 2.0 * std::numbers::pi * frequency_hz}; }

}  // namespace

Expected<Prediction> Prediction::make(const RecordInput& record, const JointModel& model, const Eigen::VectorXd& values) {
  Prediction p(record, model, values);
  const bool immittance = model.has(Acts::immittance);
  if (immittance && !model.linear()) return refused("an immittance beside a law or a map is not predicted over time");
  if (model.base->has_state_space()) {
    const auto plant = plant_matrices(*model.base, values.data(), record.known());
    if (!plant) return refused("the values are outside of the domain");
    p.states_ = plant->states();
  } else if (!model.linear()) {
    return refused("a base model without a state space takes no laws and maps");
  }
  if (immittance || !model.base->has_state_space()) {
    if (auto done = p.answer_by_spectrum(); !done) return tl::unexpected(done.error());
  } else {
    if (model.has(Acts::parallel)) p.add_parallel();
    if (p.states_ > 0) p.simulation_ = std::make_shared<Simulation>(model, values, record.known());
    if (model.has(Acts::input)) p.own_input_ = record.mapped_values(model, values);
  }
  return p;
}

Expected<void> Prediction::answer_by_spectrum() {
  by_spectrum_ = true;
  const SampledPath path(*model_, *values_, record_->known(), record_->sample_time_s());
  const Eigen::MatrixXd& u = record_->at_samples();
  added_ = Eigen::VectorXd::Zero(u.rows());
  for (Eigen::Index j = 0; j < u.cols(); ++j) {
    added_ += filtered(u.col(j), record_->sample_time_s(), 1, Beyond::mirrored, [&](double f) { return path.at(f)[j]; });
  }
  if (!added_.allFinite()) return refused("the response is not finite: an immittance needs a plant that settles");
  return {};
}

void Prediction::add_parallel() {
  const double t = record_->sample_time_s(), more_s = model_->delay_s(*values_) - model_->base->timing().delay_s;
  added_ = filtered(record_->at_samples().col(0), t, 1, Beyond::mirrored, [&](double f) {
    Complex sum = 0.0;
    for (std::size_t a = 0; a < model_->additions.size(); ++a)
      if (model_->additions[a].what.acts == Acts::parallel) sum += model_->additions[a].effect->transfer(values_of(a), s_at(f));
    return sum * record_->path(f) * std::exp(-s_at(f) * more_s);
  });
}

bool Prediction::rough() const {
  const auto kinks = [](const Addition& a) { return a.what.rough || a.what.memory > 0; };
  return model_->base->has_laws() || std::any_of(model_->additions.begin(), model_->additions.end(), kinks);
}

Eigen::VectorXd Prediction::certainty(const Stretch& stretch) const {
  Eigen::VectorXd c = Eigen::VectorXd::Ones(stretch.count);
  const Eigen::Index half = stretch.count / 2;
  if (by_spectrum_ || model_->has(Acts::series)) {
    c.head(half).setZero();
    return c;
  }
  const double delay = model_->delay_s(*values_) / record_->sample_time_s();
  for (Eigen::Index n = 0; n < half; ++n) c[n] = std::clamp(static_cast<double>(stretch.first + n) - delay, 0.0, 1.0);
  return c;
}

Simulated Prediction::without_states(const Stretch& stretch) const {
  LinearPlant plant;
  model_->base->state_space(values_->data(), record_->known().data(), plant);
  const Laws laws(*model_, *values_, record_->known());
  const auto q = static_cast<std::size_t>(plant.inputs), m = static_cast<std::size_t>(plant.places);
  std::vector<double> memory(laws.memory(), 0.0), next(laws.memory(), 0.0), u(q);
  const auto product = [&u, q](const std::vector<double>& rows, std::size_t row) {
    double sum = 0.0;
    for (std::size_t j = 0; j < q; ++j) sum += rows[row * q + j] * u[j];
    return sum;
  };
  Simulated s;
  s.output.resize(stretch.count);
  Eigen::VectorXd reactions(stretch.count);
  s.flow.resize(stretch.count, plant.places);
  s.stored.resize(stretch.count, plant.places);
  for (Eigen::Index n = 0; n < stretch.count; ++n) {
    for (std::size_t j = 0; j < q; ++j) u[j] = input()(stretch.first + n, static_cast<Eigen::Index>(j));
    double by_laws = 0.0;
    for (std::size_t i = 0; i < m; ++i) {
      s.flow(n, static_cast<Eigen::Index>(i)) = product(plant.Df, i);
      s.stored(n, static_cast<Eigen::Index>(i)) = product(plant.Ds, i);
    }
    for (std::size_t i = 0; i < laws.count(); ++i) {
      const auto place = static_cast<Eigen::Index>(laws.place(i));
      Signals signals;
      signals.flow = s.flow(n, place);
      signals.stored = s.stored(n, place);
      signals.time_s = static_cast<double>(stretch.first + n) * record_->sample_time_s();
      signals.step_s = record_->sample_time_s();
      by_laws += plant.F[laws.place(i)] * laws.react(i, signals, memory.data(), next.data()).value;
    }
    memory.swap(next);
    s.output[n] = product(plant.D, 0);
    reactions[n] = by_laws;
  }
  const double t = record_->sample_time_s(), corner = model_->base->filter_hz(), delay_s = model_->delay_s(*values_);
  if (laws.count() > 0) s.output += corner > 0.0 ? smooth_derivative(reactions, t, corner, 0) : reactions;
  if (delay_s != 0.0)
    s.output = filtered(s.output, t, 1, Beyond::mirrored, [delay_s](double f) { return std::exp(-s_at(f) * delay_s); });
  return s;
}

Expected<Simulated> Prediction::simulated(const Stretch& stretch, const Eigen::VectorXd& state, bool signals) const {
  const double t = record_->sample_time_s();
  // The stretch begins with its state whatever the delay: whole samples of it move the input.
  const SampleDelay delay = sample_delay(model_->delay_s(*values_), t);
  Drive drive;
  drive.values_per_sample = record_->values_per_sample();
  drive.hold = record_->joined();
  drive.sample_time_s = t;
  drive.delay_s = -delay.offset_s;
  drive.start_s = static_cast<double>(stretch.first) * t;
  drive.initial = state;
  drive.signals = signals;
  const Eigen::Index each = drive.values_per_sample, last = record_->samples() - 1;
  // One sample more than asked for: with it the input after the last one is known.
  drive.input.resize((stretch.count + 1) * each, input().cols());
  const Eigen::Index first = stretch.first - delay.late;
  for (Eigen::Index n = 0; n <= stretch.count; ++n)
    drive.input.middleRows(n * each, each) = input().middleRows(std::clamp<Eigen::Index>(first + n, 0, last) * each, each);
  auto s = simulation_->run(drive);
  if (!s) return s;
  s->output.conservativeResize(stretch.count);
  if (!signals) return s;
  s->flow.conservativeResize(stretch.count, Eigen::NoChange);
  s->stored.conservativeResize(stretch.count, Eigen::NoChange);
  return s;
}

Complex Prediction::factors(Complex s) const {
  Complex product = 1.0;
  for (std::size_t a = 0; a < model_->additions.size(); ++a)
    if (model_->additions[a].what.acts == Acts::series) product *= model_->additions[a].effect->transfer(values_of(a), s);
  return product;
}

void Prediction::apply_output_effects(const Stretch& stretch, Simulated& s) const {
  if (!by_spectrum_ && added_.size() > 0) s.output += added_.segment(stretch.first, stretch.count);
  if (!by_spectrum_ && model_->has(Acts::series)) {
    s.output = filtered(s.output, record_->sample_time_s(), 1, Beyond::mirrored, [this](double f) { return factors(s_at(f)); });
  }
  for (std::size_t a = 0; a < model_->additions.size(); ++a) {
    const Addition& addition = model_->additions[a];
    if (addition.what.acts != Acts::output) continue;
    std::vector<double> memory(addition.what.memory, 0.0);
    for (Eigen::Index n = 0; n < stretch.count; ++n) {
      const double time_s = static_cast<double>(stretch.first + n) * record_->sample_time_s();
      s.output[n] = addition.effect->map(values_of(a), s.output[n], time_s, memory.data());
    }
  }
}

Expected<Simulated> Prediction::run(const Stretch& stretch, const Eigen::VectorXd& state, bool signals) const {
  Simulated s;
  if (by_spectrum_) {
    s.output = added_.segment(stretch.first, stretch.count);
    if (states_ > 0) s.output += free_response(stretch.count) * state;
  } else if (states_ == 0) {
    s = without_states(stretch);
  } else {
    auto run = simulated(stretch, state, signals);
    if (!run) return run;
    s = std::move(*run);
  }
  apply_output_effects(stretch, s);
  return s;
}

Eigen::MatrixXd Prediction::free_response(Eigen::Index samples) const {
  Eigen::MatrixXd y(samples, states_);
  const auto plant = plant_matrices(*model_->base, values_->data(), record_->known());
  const Eigen::MatrixXd step = transition(plant->A, record_->sample_time_s()).phi;
  // A delay shows each sample the plant some time after the state.
  const double offset_s = by_spectrum_ ? 0.0 : sample_delay(model_->delay_s(*values_), record_->sample_time_s()).offset_s;
  Eigen::RowVectorXd row = plant->C * transition(plant->A, offset_s).phi * plant->scale.cwiseInverse().asDiagonal();
  const Eigen::MatrixXd in_units = plant->scale.asDiagonal() * step * plant->scale.cwiseInverse().asDiagonal();
  for (Eigen::Index n = 0; n < samples; ++n) {
    y.row(n) = row;
    row = (row * in_units).eval();
  }
  return y;
}

}  // namespace bodeflow::residual
