#include "model/simulate.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <bodeflow/numerics/fft.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "model/sample_delay.hpp"
#include "model/stepper.hpp"

namespace bodeflow::residual {
namespace {

// A periodic simulation is steady when a period ends so near to where it began, as a part of the states.
constexpr double kSteady = 1e-9;
constexpr double kFolds = 21.0;  // e^-21 is below it
constexpr int kMostPeriods = 12;
constexpr int kFineOfDouble = 8;
constexpr int kLeastSingle = 4;

int power_of_two(int at_least) {
  int p = 1;
  while (p < at_least) p *= 2;
  return p;
}

/// The grid of steps for a model: double steps where no law keeps a memory.
StepGrid grid_of(const JointModel& model, const Laws& laws, const Drive& drive, double offset_s) {
  const int v = drive.values_per_sample, wanted = model.steps_per_sample();
  StepGrid g;
  g.sample_time_s = drive.sample_time_s;
  g.offset_s = offset_s;
  g.doubles = !laws.keeps_memory() && laws.count() > 0;
  g.fine = g.doubles ? kFineOfDouble : laws.count() == 0 ? 1 : power_of_two((std::max(wanted, kLeastSingle) + v - 1) / v);
  g.steps = g.doubles ? v * std::max(1, (wanted + 2 * v - 1) / (2 * v)) : v;
  return g;
}

/// A plant whose inputs are the drive's and the extra reactions.
PlantMatrices with_extra(const PlantMatrices& p) {
  PlantMatrices all = p;
  const auto beside = [](const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
    Eigen::MatrixXd both(a.rows(), a.cols() + b.cols());
    both << a, b;
    return both;
  };
  all.B = beside(p.B, p.E);
  all.D = beside(p.D, p.F);
  all.Df = beside(p.Df, p.Ff);
  all.Ds = beside(p.Ds, p.Fs);
  return all;
}

/// A drive on its way through a stepper.
class Run {
 public:
  Run(const JointModel& model, const PlantMatrices& plant, const Laws& laws, const Drive& drive)
      : plant_(drive.extra_reaction.size() > 0 ? with_extra(plant) : plant),
        drive_(drive),
        delay_(sample_delay(drive.delay_s, drive.sample_time_s)),
        values_(static_cast<Eigen::Index>(drive.values_per_sample)),
        samples_(drive.input.rows() / values_),
        extra_(drive.extra_reaction.size() > 0),
        held_(drive.hold == Hold::zero_order),
        plan_{&plant_, &laws, held_ && !extra_ ? Push::held : Push::straight, drive.signals},
        grid_(grid_of(model, laws, drive, delay_.offset_s)),
        stepper_(plan_, grid_),
        u0_(plant_.inputs()),
        u1_(plant_.inputs()) {
    input_.resize(plant_.inputs(), drive.input.rows());
    input_.topRows(drive.input.cols()) = drive.input.transpose();
    if (extra_) input_.bottomRows(drive.extra_reaction.cols()) = drive.extra_reaction.transpose();
  }

  Simulated once();
  Simulated periodic();

 private:
  /// Runs the sample times [from, to) of the input; sample n of the output goes to row n of `into` where there is one.
  void run(Eigen::Index from, Eigen::Index to, Eigen::Index wrap, Simulated* into);
  void input_at(Eigen::Index m, int step);
  Eigen::Index column_of(Eigen::Index m, Eigen::Index value) const;
  void keep(Eigen::Index row, Simulated& into) const;
  Simulated room(Eigen::Index rows) const;
  Eigen::VectorXd linear_step(const Transition& t, const Eigen::VectorXd& x, Eigen::Index m) const;
  Eigen::VectorXd state() const { return Eigen::Map<const Eigen::VectorXd>(stepper_.state(), plant_.states()); }
  void begin(const Eigen::VectorXd& state, Eigen::Index m) {
    input_at(m, 0);
    stepper_.begin(state, u0_.data(), time_of(m));
  }
  double time_of(Eigen::Index m) const {
    return std::max(0.0, drive_.start_s + static_cast<double>(m + delay_.late) * drive_.sample_time_s - delay_.offset_s);
  }
  void take_off_drift(const Eigen::VectorXd& drift, Simulated& s) const;

  PlantMatrices plant_;
  const Drive& drive_;
  SampleDelay delay_;
  Eigen::Index values_, samples_;
  bool extra_, held_;
  StepPlan plan_;
  StepGrid grid_;
  Stepper stepper_;
  Eigen::MatrixXd input_;  ///< inputs x values
  Eigen::VectorXd u0_, u1_;
  bool frozen_ = false;  ///< the time of laws stands still: before the record
};

Eigen::Index Run::column_of(Eigen::Index m, Eigen::Index value) const {
  if (drive_.periodic) {
    const Eigen::Index n = m % samples_;
    return (n < 0 ? n + samples_ : n) * values_ + value;
  }
  return std::clamp<Eigen::Index>(m, 0, samples_ - 1) * values_ + value;
}

void Run::input_at(Eigen::Index m, int step) {
  const int each = grid_.steps / static_cast<int>(values_), value = step / each, part = step % each;
  const auto here = input_.col(column_of(m, value));
  if (plan_.push == Push::held) {
    u0_ = here;
    return;
  }
  Eigen::Index next = value + 1 < values_ ? column_of(m, value + 1) : column_of(m + 1, 0);
  if (!drive_.periodic && m + 1 >= samples_ && value + 1 == values_) next = column_of(m, value);
  const auto there = input_.col(next);
  const double from = static_cast<double>(part) / each, to = static_cast<double>(part + 1) / each;
  u0_ = here + from * (there - here);
  u1_ = here + to * (there - here);
  if (held_) {
    const Eigen::Index q = drive_.input.cols();
    u0_.head(q) = u1_.head(q) = here.head(q);
  }
}

Simulated Run::room(Eigen::Index rows) const {
  Simulated s;
  s.output = Eigen::VectorXd::Zero(rows);
  if (drive_.signals) s.flow = s.stored = Eigen::MatrixXd::Zero(rows, plant_.places());
  return s;
}

void Run::keep(Eigen::Index row, Simulated& into) const {
  const double* sampled = stepper_.sampled();
  into.output[row] = sampled[0];
  if (!drive_.signals) return;
  for (Eigen::Index p = 0; p < plant_.places(); ++p) {
    into.flow(row, p) = sampled[1 + p];
    into.stored(row, p) = sampled[1 + plant_.places() + p];
  }
}

void Run::run(Eigen::Index from, Eigen::Index to, Eigen::Index wrap, Simulated* into) {
  const double h = drive_.sample_time_s / grid_.steps;
  for (Eigen::Index m = from; m < to && stepper_.sound(); ++m) {
    const double begin_s = frozen_ ? 0.0 : time_of(m);
    for (int step = 0; step < grid_.steps; ++step) {
      input_at(m, step);
      if (!stepper_.advance(step, u0_.data(), u1_.data(), frozen_ ? 0.0 : begin_s + step * h) || into == nullptr) continue;
      Eigen::Index row = m + delay_.late;
      if (wrap > 0) row = (row % wrap + wrap) % wrap;
      if (row >= 0 && row < into->output.size()) keep(row, *into);
    }
  }
}

Simulated Run::once() {
  Simulated s = room(samples_);
  const Eigen::VectorXd first = drive_.initial.size() > 0
                                    ? Eigen::VectorXd(plant_.scale.cwiseInverse().asDiagonal() * drive_.initial)
                                    : Eigen::VectorXd::Zero(plant_.states());
  begin(first, 0);
  // Samples before the input acts show the state at rest.
  for (Eigen::Index n = 0; n < std::min(delay_.late, samples_); ++n) s.output[n] = (plant_.C * first)(0);
  if (drive_.signals) {
    for (Eigen::Index n = 0; n < std::min(delay_.late, samples_); ++n) {
      s.flow.row(n) = (plant_.Cf * first).transpose();
      s.stored.row(n) = (plant_.Cs * first).transpose();
    }
  }
  run(0, samples_ - delay_.late, 0, &s);
  s.state = plant_.scale.asDiagonal() * state();
  return s;
}

Eigen::VectorXd Run::linear_step(const Transition& t, const Eigen::VectorXd& x, Eigen::Index m) const {
  Eigen::VectorXd next = x;
  for (Eigen::Index value = 0; value < values_; ++value) {
    const auto u = input_.col(column_of(m, value));
    const Eigen::VectorXd push = plant_.B * u;
    next = (t.phi * next + t.psi[0] * push).eval();
    if (plan_.push == Push::held) continue;
    const auto v = input_.col(value + 1 < values_ ? column_of(m, value + 1) : column_of(m + 1, 0));
    Eigen::VectorXd rise = v - u;
    if (held_) rise.head(drive_.input.cols()).setZero();
    next += t.psi[1] * (plant_.B * rise) / t.h;
  }
  return next;
}

/// The slowest time constant of decaying modes.
double slowest_s(const Eigen::MatrixXd& a) {
  if (a.rows() == 0) return 0.0;
  const Eigen::VectorXcd poles = a.eigenvalues();
  const double least = 1e-9 * poles.cwiseAbs().maxCoeff();
  double slowest = 0.0;
  for (const auto& p : poles)
    if (-p.real() > least) slowest = std::max(slowest, -1.0 / p.real());
  return slowest;
}

Simulated Run::periodic() {
  const Eigen::Index n = plant_.states(), count = samples_ * drive_.periods;
  // The linear steady state at the begin of the input, x = (I - Phi^N)^-1 x_N, x_N reached from rest.
  const Transition t = transition(plant_.A, drive_.sample_time_s / static_cast<double>(values_));
  const auto linear_run = [&](Eigen::VectorXd x, Eigen::Index to, Eigen::VectorXd* largest) {
    for (Eigen::Index m = 0; m < to; ++m) {
      x = linear_step(t, x, m);
      if (largest != nullptr) *largest = largest->cwiseMax(x.cwiseAbs());
    }
    return x;
  };
  const Eigen::VectorXd reached = linear_run(Eigen::VectorXd::Zero(n), samples_, nullptr);
  const Eigen::MatrixXd whole = transition(plant_.A, drive_.sample_time_s * static_cast<double>(samples_)).phi;
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
  solver.setThreshold(kSteady);
  solver.compute(Eigen::MatrixXd::Identity(n, n) - whole);
  const Eigen::VectorXd steady = drive_.initial.size() > 0
                                     ? Eigen::VectorXd(plant_.scale.cwiseInverse().asDiagonal() * drive_.initial)
                                     : Eigen::VectorXd(solver.solve(reached));
  const double needed = std::ceil(kFolds * slowest_s(plant_.A) / drive_.sample_time_s);
  const Eigen::Index warm = needed < static_cast<double>(samples_) ? static_cast<Eigen::Index>(needed) : samples_;
  Eigen::VectorXd size = Eigen::VectorXd::Constant(n, 1e-300);
  const Eigen::VectorXd before = linear_run(steady, samples_ - warm, &size);
  frozen_ = true;
  begin(before, -warm);
  run(-warm, 0, samples_, nullptr);
  Simulated s = room(samples_);
  Eigen::VectorXd drift = Eigen::VectorXd::Zero(n), change_before = drift;
  const bool whole_record = drive_.periods > 1;
  for (int period = 0; period < kMostPeriods && stepper_.sound(); ++period) {
    const Eigen::VectorXd first = state();
    run(0, samples_, samples_, &s);
    const Eigen::VectorXd change = state() - first;
    size = size.cwiseMax(state().cwiseAbs());
    const auto small = [&](const Eigen::VectorXd& d) { return (d.cwiseAbs().array() <= kSteady * size.array()).all(); };
    if (small(change)) break;
    drift = change;
    if (period > 0 && small(change - change_before)) break;
    drift.setZero();
    change_before = change;
  }
  if (whole_record) {
    s = room(count);
    if (delay_.late > 0) run(-samples_, -delay_.late, 0, nullptr);
    frozen_ = false;
    run(-std::max<Eigen::Index>(delay_.late, 0), count - delay_.late, 0, &s);
  } else if (!drift.isZero(0.0)) {
    take_off_drift(drift, s);
  }
  s.state = plant_.scale.asDiagonal() * state();
  return s;
}

void Run::take_off_drift(const Eigen::VectorXd& drift, Simulated& s) const {
  const Eigen::VectorXd ramp =
      Eigen::VectorXd::LinSpaced(samples_, 0.0, static_cast<double>(samples_ - 1)) / static_cast<double>(samples_);
  s.output -= (plant_.C * drift)(0) * ramp;
  if (!drive_.signals) return;
  s.flow -= ramp * (plant_.Cf * drift).transpose();
  s.stored -= ramp * (plant_.Cs * drift).transpose();
}

Expected<void> check(const PlantMatrices& plant, const Drive& drive) {
  if (drive.input.cols() != plant.inputs()) {
    return refused("the plant has " + std::to_string(plant.inputs()) + " inputs, the drive has " +
                   std::to_string(drive.input.cols()));
  }
  if (drive.values_per_sample < 1 || drive.input.rows() == 0 || drive.input.rows() % drive.values_per_sample != 0)
    return refused("a drive needs whole samples of input");
  if (!(drive.sample_time_s > 0.0) || !std::isfinite(drive.sample_time_s) || !std::isfinite(drive.delay_s))
    return refused("a drive needs a sample time above 0 and a finite delay");
  if (drive.initial.size() > 0 && drive.initial.size() != plant.states())
    return refused("the initial state has " + std::to_string(drive.initial.size()) + " numbers, the plant " +
                   std::to_string(plant.states()));
  if (drive.extra_reaction.size() > 0 &&
      (drive.extra_reaction.rows() != drive.input.rows() || drive.extra_reaction.cols() != plant.places()))
    return refused("the extra reactions do not fit the input and the places");
  return {};
}

}  // namespace

Expected<Simulated> simulate(const JointModel& model, const Eigen::VectorXd& values, std::span<const double> known,
                             const Drive& drive) {
  if (!model.base->has_state_space()) return refused("a base model without a state space can't be simulated");
  const auto plant = plant_matrices(*model.base, values.data(), known);
  const auto not_finite = [&] {
    Simulated s;
    const Eigen::Index samples = drive.input.rows() / std::max(drive.values_per_sample, 1) * (drive.periodic ? drive.periods : 1);
    s.output = Eigen::VectorXd::Constant(samples, std::numeric_limits<double>::quiet_NaN());
    const Eigen::Index places = static_cast<Eigen::Index>(model.base->places().size());
    s.flow = s.stored = Eigen::MatrixXd::Constant(samples, places, std::numeric_limits<double>::quiet_NaN());
    return s;
  };
  if (!plant) return not_finite();
  if (auto fits = check(*plant, drive); !fits) return tl::unexpected(fits.error());
  const Laws laws(model, values, known);
  Run run(model, *plant, laws, drive);
  Simulated s = drive.periodic ? run.periodic() : run.once();
  if (!s.output.allFinite() || !s.state.allFinite()) return not_finite();
  return s;
}

Eigen::MatrixXd refined(const Eigen::MatrixXd& input, int values_per_sample) {
  const Eigen::Index samples = input.rows(), length = samples * values_per_sample;
  Eigen::MatrixXd fine(length, input.cols());
  for (Eigen::Index j = 0; j < input.cols(); ++j) {
    const Eigen::VectorXcd lines = numerics::half_dft(input.col(j));
    Eigen::VectorXcd full = Eigen::VectorXcd::Zero(length);
    for (Eigen::Index k = 0; k < (samples + 1) / 2; ++k) {
      const double x = std::numbers::pi * static_cast<double>(k) / static_cast<double>(length);
      const double sinc = k == 0 ? 1.0 : std::sin(x) / x;
      full[k] = lines[k] * (values_per_sample / (sinc * sinc));
      if (k > 0) full[length - k] = std::conj(full[k]);
    }
    fine.col(j) = numerics::inverse_dft(full).real();
  }
  return fine;
}

}  // namespace bodeflow::residual
