#include "model/simulate.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <bodeflow/numerics/fft.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "model/sample_delay.hpp"
#include "model/stepper.hpp"

namespace bodeflow::residual {
namespace {

// A periodic simulation is steady when a period ends so near to where it began, as a part of the states.
constexpr double kSteady = 1e-6;
constexpr double kFolds = 21.0;  // further than that, since laws can slow the plant down
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

/// A plant ready to be stepped by drives of one kind.
struct Machine {
  Machine(const JointModel& model, const PlantMatrices& p, const Laws& laws, const Drive& drive)
      : extra(drive.extra_reaction.size() > 0),
        plant(extra ? with_extra(p) : p),
        plan{&plant, &laws, drive.hold == Hold::zero_order && !extra ? Push::held : Push::straight, drive.signals},
        grid(grid_of(model, laws, drive, sample_delay(drive.delay_s, drive.sample_time_s).offset_s)),
        values_per_sample(drive.values_per_sample),
        stepper(plan, grid) {}
  Machine(const Machine&) = delete;
  Machine& operator=(const Machine&) = delete;

  bool fits(const Drive& drive) const {
    const bool held = drive.hold == Hold::zero_order && !extra;
    return extra == (drive.extra_reaction.size() > 0) && plan.signals == drive.signals && held == (plan.push == Push::held) &&
           values_per_sample == drive.values_per_sample && grid.sample_time_s == drive.sample_time_s &&
           grid.offset_s == sample_delay(drive.delay_s, drive.sample_time_s).offset_s;
  }

  bool extra;
  PlantMatrices plant;
  StepPlan plan;
  StepGrid grid;
  int values_per_sample;
  Stepper stepper;
};

/// A drive on its way through a stepper.
class Run {
 public:
  Run(Machine& machine, const Drive& drive)
      : plant_(machine.plant),
        drive_(drive),
        delay_(sample_delay(drive.delay_s, drive.sample_time_s)),
        values_(static_cast<Eigen::Index>(drive.values_per_sample)),
        samples_(drive.input.rows() / values_),
        extra_(machine.extra),
        held_(drive.hold == Hold::zero_order),
        plan_(machine.plan),
        grid_(machine.grid),
        stepper_(machine.stepper) {
    input_.resize(plant_.inputs(), drive.input.rows());
    input_.topRows(drive.input.cols()) = drive.input.transpose();
    if (extra_) input_.bottomRows(drive.extra_reaction.cols()) = drive.extra_reaction.transpose();
    if (plan_.push == Push::straight) divide_input();
  }

  Simulated once();
  Simulated periodic();

 private:
  /// Runs the sample times [from, to) of the input; sample n of the output goes to row n of `into` where there is one.
  void run(Eigen::Index from, Eigen::Index to, Eigen::Index wrap, Simulated* into);
  void divide_input();
  Eigen::Index after(Eigen::Index column) const;
  Eigen::Index sample_of(Eigen::Index m) const;
  void keep(Eigen::Index row, Simulated& into) const;
  Simulated room(Eigen::Index rows) const;
  Eigen::VectorXd linear_run(const SmallMatrix& map, const Eigen::VectorXd& begin, Eigen::Index samples,
                             Eigen::VectorXd* largest) const;
  SmallMatrix linear_map() const;
  Eigen::VectorXd state() const { return Eigen::Map<const Eigen::VectorXd>(stepper_.state(), plant_.states()); }
  void begin(const Eigen::VectorXd& state, Eigen::Index m) {
    const Eigen::Index n = sample_of(m);
    stepper_.begin(state, plan_.push == Push::held ? input_.col(n * values_).data() : from_.col(n * grid_.steps).data(),
                   time_of(m));
  }
  double time_of(Eigen::Index m) const {
    return std::max(0.0, drive_.start_s + static_cast<double>(m + delay_.late) * drive_.sample_time_s - delay_.offset_s);
  }
  void take_off_drift(const Eigen::VectorXd& drift, Simulated& s) const;

  const PlantMatrices& plant_;
  const Drive& drive_;
  SampleDelay delay_;
  Eigen::Index values_, samples_;
  bool extra_, held_;
  const StepPlan& plan_;
  const StepGrid& grid_;
  Stepper& stepper_;
  Eigen::MatrixXd input_;      ///< inputs x values
  Eigen::MatrixXd from_, to_;  ///< of a straight push: inputs x steps, at their begins and ends
  bool frozen_ = false;        ///< the time of laws stands still: before the record
};

Eigen::Index Run::sample_of(Eigen::Index m) const {
  if (!drive_.periodic) return std::clamp<Eigen::Index>(m, 0, samples_ - 1);
  const Eigen::Index n = m % samples_;
  return n < 0 ? n + samples_ : n;
}

/// The column of the value that follows that one.
Eigen::Index Run::after(Eigen::Index column) const {
  if (column + 1 < input_.cols()) return column + 1;
  return drive_.periodic ? 0 : column;
}

void Run::divide_input() {
  const int each = grid_.steps / static_cast<int>(values_);
  const Eigen::Index held = held_ ? drive_.input.cols() : 0;
  from_.resize(input_.rows(), input_.cols() * each);
  to_.resizeLike(from_);
  for (Eigen::Index c = 0; c < input_.cols(); ++c) {
    const Eigen::Index next = after(c);
    for (Eigen::Index j = 0; j < input_.rows(); ++j) {
      const double here = input_(j, c), rise = j < held ? 0.0 : input_(j, next) - here;
      for (int part = 0; part < each; ++part) {
        from_(j, c * each + part) = here + static_cast<double>(part) / each * rise;
        to_(j, c * each + part) = here + static_cast<double>(part + 1) / each * rise;
      }
    }
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
  const Eigen::Index q = plant_.inputs(), each = grid_.steps / values_;
  const bool held = plan_.push == Push::held;
  Eigen::Index n = sample_of(from), row = from + delay_.late;
  if (wrap > 0) row = (row % wrap + wrap) % wrap;
  for (Eigen::Index m = from; m < to && stepper_.sound(); ++m) {
    const double begin_s = frozen_ ? 0.0 : time_of(m);
    const double* value = input_.data() + n * values_ * q;
    bool sampled = false;
    for (int step = 0, part = 0; step < grid_.steps; ++step) {
      const Eigen::Index at = (n * grid_.steps + step) * q;
      const double *u0 = held ? value : from_.data() + at, *u1 = held ? value : to_.data() + at;
      sampled = stepper_.advance(step, u0, u1, frozen_ ? 0.0 : begin_s + step * h) || sampled;
      if (++part == each) part = 0, value += q;
    }
    if (sampled && into != nullptr && row >= 0 && row < into->output.size()) keep(row, *into);
    if (++row == wrap) row = 0;
    n = drive_.periodic ? (n + 1 == samples_ ? 0 : n + 1) : sample_of(m + 1);
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

/// x after a value of the input from [x | value | the next value].
SmallMatrix Run::linear_map() const {
  const Transition t = transition(plant_.A, drive_.sample_time_s / static_cast<double>(values_));
  const Eigen::Index n = plant_.states(), q = plant_.inputs(), straight = held_ ? drive_.input.cols() : 0;
  Eigen::MatrixXd end = t.psi[1] * plant_.B / t.h;
  end.leftCols(straight).setZero();
  const Eigen::MatrixXd begin = t.psi[0] * plant_.B - end;
  SmallMatrix map(static_cast<int>(n), static_cast<int>(n + 2 * q));
  for (int r = 0; r < map.rows; ++r) {
    for (int c = 0; c < static_cast<int>(n); ++c) map.at(r, c) = t.phi(r, c);
    for (int c = 0; c < static_cast<int>(q); ++c) {
      map.at(r, static_cast<int>(n) + c) = begin(r, c);
      map.at(r, static_cast<int>(n + q) + c) = end(r, c);
    }
  }
  return map;
}

/// Where the plant without laws is after so many samples of a periodic input; the largest states on the way go to `largest`.
Eigen::VectorXd Run::linear_run(const SmallMatrix& map, const Eigen::VectorXd& begin, Eigen::Index samples,
                                Eigen::VectorXd* largest) const {
  const Eigen::Index n = plant_.states(), q = plant_.inputs();
  std::vector<double> v(static_cast<std::size_t>(map.columns)), x(static_cast<std::size_t>(map.padded));
  std::copy(begin.data(), begin.data() + n, x.begin());
  for (Eigen::Index c = 0; c < samples * values_; ++c) {
    const double *here = input_.data() + c * q, *there = c + 1 < input_.cols() ? here + q : input_.data();
    std::copy(x.data(), x.data() + n, v.data());
    std::copy(here, here + q, v.data() + n);
    std::copy(there, there + q, v.data() + n + q);
    product(map, v.data(), x.data());
    if (largest == nullptr) continue;
    for (Eigen::Index i = 0; i < n; ++i) (*largest)[i] = std::max((*largest)[i], std::abs(x[static_cast<std::size_t>(i)]));
  }
  return Eigen::Map<const Eigen::VectorXd>(x.data(), n);
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
  const SmallMatrix map = linear_map();
  const Eigen::VectorXd reached = linear_run(map, Eigen::VectorXd::Zero(n), samples_, nullptr);
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
  const Eigen::VectorXd before = linear_run(map, steady, samples_ - warm, &size);
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
  // By when it was simulated: samples of a late output stand at the begin of the period and come from its end.
  Eigen::VectorXd ramp(samples_);
  for (Eigen::Index n = 0; n < samples_; ++n)
    ramp[n] = static_cast<double>(sample_of(n - delay_.late)) / static_cast<double>(samples_);
  s.output -= (plant_.C * drift)(0) * ramp;
  if (!drive_.signals) return;
  s.flow -= ramp * (plant_.Cf * drift).transpose();
  s.stored -= ramp * (plant_.Cs * drift).transpose();
}

Expected<void> check(const PlantMatrices& plant, const Drive& drive) {
  if (drive.input.cols() != plant.inputs()) {
    return refused("the plant has " + std::to_string(plant.inputs()) + " input(s), the drive has " +
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

struct Simulation::Ready {
  std::optional<PlantMatrices> plant;
  std::optional<Laws> laws;
  std::unique_ptr<Machine> machine;
};

Simulation::Simulation(const JointModel& model, const Eigen::VectorXd& values, std::span<const double> known)
    : model_(&model), ready_(std::make_unique<Ready>()) {
  if (!model.base->has_state_space()) return;
  ready_->plant = plant_matrices(*model.base, values.data(), known);
  if (ready_->plant) ready_->laws.emplace(model, values, known);
}

Simulation::~Simulation() = default;

Expected<Simulated> Simulation::run(const Drive& drive) {
  if (!model_->base->has_state_space()) return refused("a base model without a state space can't be simulated");
  const auto not_finite = [&] {
    Simulated s;
    const Eigen::Index samples = drive.input.rows() / std::max(drive.values_per_sample, 1) * (drive.periodic ? drive.periods : 1);
    s.output = Eigen::VectorXd::Constant(samples, std::numeric_limits<double>::quiet_NaN());
    const Eigen::Index places = static_cast<Eigen::Index>(model_->base->places().size());
    s.flow = s.stored = Eigen::MatrixXd::Constant(samples, places, std::numeric_limits<double>::quiet_NaN());
    return s;
  };
  if (!ready_->plant) return not_finite();
  if (auto fits = check(*ready_->plant, drive); !fits) return tl::unexpected(fits.error());
  if (!ready_->machine || !ready_->machine->fits(drive))
    ready_->machine = std::make_unique<Machine>(*model_, *ready_->plant, *ready_->laws, drive);
  Run run(*ready_->machine, drive);
  Simulated s = drive.periodic ? run.periodic() : run.once();
  if (!s.output.allFinite() || !s.state.allFinite()) return not_finite();
  return s;
}

Expected<Simulated> simulate(const JointModel& model, const Eigen::VectorXd& values, std::span<const double> known,
                             const Drive& drive) {
  return Simulation(model, values, known).run(drive);
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
