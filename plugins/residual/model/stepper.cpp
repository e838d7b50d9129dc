#include "model/stepper.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bodeflow::residual {
namespace {

// The law's reaction is solved to this part of the largest one: derivatives are differences over 1e-5.
constexpr double kSolved = 1e-12;
constexpr int kNewton = 8;
constexpr int kSweeps = 30;
constexpr int kBisections = 200;
// A rough law bends within a double step where its middle leaves the chord by more than this part of the largest reaction.
constexpr double kBend = 1e-3;
// The flow over which a law may spread a jump: a part of what the jump changes itself, since the end of a step is implicit.
constexpr double kSpread = 0.05;

}  // namespace

Stepper::Stepper(const StepPlan& plan, const StepGrid& grid)
    : plan_(plan),
      laws_(*plan.laws),
      grid_(grid),
      n_(static_cast<int>(plan.plant->states())),
      q_(static_cast<int>(plan.plant->inputs())),
      k_(static_cast<int>(plan.laws->count())) {
  const double h = grid.sample_time_s / grid.steps, fine_h = h / grid.fine;
  sample_step_ = std::min(static_cast<int>(grid.offset_s / h), grid.steps - 1);
  const double within = grid.offset_s - sample_step_ * h;
  sample_fine_ = std::min(static_cast<int>(within / fine_h), grid.fine - 1);
  Transition t = transition(plan.plant->A, fine_h);
  single_ = single_step(plan, t, -1.0);
  single_sampled_ = single_step(plan, t, std::max(within - sample_fine_ * fine_h, 0.0));
  if (grid.doubles) {
    for (int i = 2; i < grid.fine; i *= 2) t = t.doubled();
    double_ = double_step(plan, t, -1.0);
    double_sampled_ = double_step(plan, t, std::max(within, 0.0));
  }
  feeds_through_ = false;
  for (std::size_t i = 0; i < laws_.count(); ++i) {
    const auto place = static_cast<Eigen::Index>(laws_.place(i));
    feeds_through_ = feeds_through_ || !plan.plant->Df.row(place).isZero(0.0) || !plan.plant->Ds.row(place).isZero(0.0);
    gain_.push_back(std::max(-single_.unknown.column(static_cast<int>(i))[n_ + static_cast<int>(i)], 0.0) * kSpread);
  }
  const auto size = [](int count) { return static_cast<std::size_t>(count); };
  x_.assign(size(n_ + 1), 0.0);
  v_.assign(size(single_.known.columns), 0.0);
  out_.assign(size(n_ + 4 * k_ + 2), 0.0);
  w_.assign(size(3 * k_), 0.0);
  last_.assign(size(3 * k_), 0.0);
  scale_.assign(size(k_), 0.0);
  memory_.assign(laws_.memory() + 1, 0.0);
  next_.assign(laws_.memory() + 1, 0.0);
  u_.assign(size(q_), std::numeric_limits<double>::quiet_NaN());
  ua_.assign(size(q_), 0.0);
  ub_.assign(size(q_), 0.0);
  sample_.assign(size(2 + 2 * static_cast<int>(plan.plant->places()) + 1), 0.0);
}

void Stepper::begin(const Eigen::VectorXd& state, const double* input, double time_s) {
  std::copy(state.data(), state.data() + n_, x_.begin());
  std::fill(w_.begin(), w_.end(), 0.0);
  std::fill(memory_.begin(), memory_.end(), 0.0);
  predicts_ = false;
  sound_ = state.allFinite();
  resettle(time_s, input);
}

void Stepper::load(const double* u0, const double* u1) {
  double* v = std::copy(x_.data(), x_.data() + n_, v_.data());
  v = std::copy(u0, u0 + q_, v);
  if (plan_.push == Push::straight) v = std::copy(u1, u1 + q_, v);
  std::copy(w_.data(), w_.data() + k_, v);
}

bool Stepper::advance(int step, const double* u0, const double* u1, double time_s) {
  const bool sample = step == sample_step_;
  if (feeds_through_ && plan_.push == Push::held && !std::equal(u_.begin(), u_.end(), u0)) {
    resettle(time_s, u0);
    std::copy(u0, u0 + q_, u_.begin());
  }
  if (grid_.doubles) {
    load(u0, u1);
    if (advance_double(sample ? double_sampled_ : double_, time_s, sample)) return sample;
  }
  return advance_fine(u0, u1, time_s, sample);
}

// ---- double steps

bool Stepper::advance_double(const StepMaps& maps, double time_s, bool sample) {
  if (!settle_double(maps, time_s) || bends()) {
    predicts_ = false;
    return false;
  }
  std::copy(out_.begin(), out_.begin() + n_, x_.begin());
  if (sample) take_sample(maps, 2);
  keep_scale();
  std::copy(w_.begin(), w_.end(), last_.begin());
  std::copy(w_.begin() + 2 * k_, w_.end(), w_.begin());
  predicts_ = true;
  return true;
}

bool Stepper::settle_double(const StepMaps& maps, double time_s) {
  for (int i = 0; i < k_; ++i) {
    const auto begin = static_cast<std::size_t>(i), middle = begin + static_cast<std::size_t>(k_),
               end = middle + static_cast<std::size_t>(k_);
    const bool parabola = predicts_ && !laws_.rough(begin);
    w_[middle] = parabola ? last_[begin] - 3.0 * last_[middle] + 3.0 * last_[end] : w_[begin];
    w_[end] = parabola ? 3.0 * last_[begin] - 8.0 * last_[middle] + 6.0 * last_[end] : w_[begin];
  }
  product(maps.known, v_.data(), out_.data());
  for (int c = 0; c < 2 * k_; ++c) add_column(maps.unknown, c, w_[static_cast<std::size_t>(k_ + c)], out_.data());
  double before = std::numeric_limits<double>::infinity();
  for (int round = 0; round < kNewton; ++round) {
    double change = 0.0;
    for (std::size_t i = 0; i < laws_.count(); ++i) change = std::max(change, correct_double(i, maps, time_s));
    if (!(change < 1e300)) return false;
    // Newton's steps shrink by their own ratio at least, so what is left is below the step times it.
    const double ratio = std::min(change / before, 1.0);
    if (change == 0.0 || (round > 0 && change * ratio <= kSolved) || change <= kSolved) return true;
    before = change;
  }
  return false;
}

/// One step of Newton's method in the two reactions of place i; its size over the largest reaction.
double Stepper::correct_double(std::size_t i, const StepMaps& maps, double time_s) {
  const int p = static_cast<int>(i), fm = n_ + p, sm = fm + k_, fe = sm + k_, se = fe + k_;
  const double* const out = out_.data();
  const double half = 0.5 * maps.h;
  const Reaction middle = laws_.react(i, {out[fm], out[sm], time_s + half, half, gain_[i]}, memory_.data(), next_.data());
  const Reaction end = laws_.react(i, {out[fe], out[se], time_s + maps.h, half, gain_[i]}, memory_.data(), next_.data());
  const double *by_middle = maps.unknown.column(p), *by_end = maps.unknown.column(k_ + p);
  double &wm = w_[i + static_cast<std::size_t>(k_)], &we = w_[i + 2 * static_cast<std::size_t>(k_)];
  const double a = 1.0 - middle.by_flow * by_middle[fm] - middle.by_stored * by_middle[sm];
  const double b = -middle.by_flow * by_end[fm] - middle.by_stored * by_end[sm];
  const double c = -end.by_flow * by_middle[fe] - end.by_stored * by_middle[se];
  const double d = 1.0 - end.by_flow * by_end[fe] - end.by_stored * by_end[se];
  const double rm = middle.value - wm, re = end.value - we, determinant = a * d - b * c;
  const double dm = (d * rm - b * re) / determinant, de = (a * re - c * rm) / determinant;
  wm += dm;
  we += de;
  add_column(maps.unknown, p, dm, out_.data());
  add_column(maps.unknown, k_ + p, de, out_.data());
  const double size = std::max({scale_[i], std::abs(wm), std::abs(we)});
  const double change = std::max(std::abs(dm), std::abs(de));
  return change == 0.0 ? 0.0 : change / size;
}

bool Stepper::bends() const {
  for (std::size_t i = 0; i < laws_.count(); ++i) {
    if (!laws_.rough(i)) continue;
    const auto k = static_cast<std::size_t>(k_);
    const double size = std::max({scale_[i], std::abs(w_[i + k]), std::abs(w_[i + 2 * k])});
    if (std::abs(w_[i] - 2.0 * w_[i + k] + w_[i + 2 * k]) > kBend * size) return true;
  }
  return false;
}

// ---- single steps

bool Stepper::advance_fine(const double* u0, const double* u1, double time_s, bool sample) {
  const bool straight = plan_.push == Push::straight;
  for (int f = 0; f < grid_.fine; ++f) {
    const bool here = sample && f == sample_fine_;
    const StepMaps& maps = here ? single_sampled_ : single_;
    if (straight) {
      const double from = static_cast<double>(f) / grid_.fine, to = static_cast<double>(f + 1) / grid_.fine;
      for (int j = 0; j < q_; ++j) {
        const auto at = static_cast<std::size_t>(j);
        ua_[at] = u0[j] + from * (u1[j] - u0[j]);
        ub_[at] = u0[j] + to * (u1[j] - u0[j]);
      }
    }
    load(straight ? ua_.data() : u0, ub_.data());
    const double begin_s = time_s + f * maps.h;
    sound_ = settle_single(maps, begin_s) && sound_;
    std::copy(out_.begin(), out_.begin() + n_, x_.begin());
    if (here) take_sample(maps, 1);
    if (laws_.keeps_memory()) keep_memory(maps, begin_s);
    std::copy(w_.begin() + k_, w_.begin() + 2 * k_, w_.begin() + 2 * k_);
    keep_scale();
    std::copy(w_.begin() + 2 * k_, w_.end(), w_.begin());
  }
  return sample;
}

bool Stepper::settle_single(const StepMaps& maps, double time_s) {
  product(maps.known, v_.data(), out_.data());
  for (int i = 0; i < k_; ++i) {
    w_[static_cast<std::size_t>(k_ + i)] = w_[static_cast<std::size_t>(i)];
    add_column(maps.unknown, i, w_[static_cast<std::size_t>(i)], out_.data());
  }
  if (k_ == 0) return true;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    double most = 0.0;
    for (std::size_t i = 0; i < laws_.count(); ++i) {
      double change = 0.0;
      if (!solve_place(i, maps, time_s, &change)) return false;
      most = std::max(most, change);
    }
    if (k_ == 1 || most <= kSolved) return true;
  }
  return false;
}

/// The reaction of place i at the end of a single step with the others as they stand: the root of w - law(signals(w)), which
/// rises in w for laws that rise in flow and stored quantity. Newton's method, and halving of the interval where it leaves it.
bool Stepper::solve_place(std::size_t i, const StepMaps& maps, double time_s, double* change) {
  const int p = static_cast<int>(i), f = n_ + p, s = f + k_;
  const double *by = maps.unknown.column(p), flow = out_[static_cast<std::size_t>(f)], stored = out_[static_cast<std::size_t>(s)];
  const double begin = w_[i + static_cast<std::size_t>(k_)];
  double w = begin, low = -std::numeric_limits<double>::infinity(), high = -low;
  double before = high;
  bool solved = false;
  for (int round = 0; round < kBisections; ++round) {
    const double moved = w - begin;
    const Signals signals{flow + by[f] * moved, stored + by[s] * moved, time_s + maps.h, maps.h, gain_[i]};
    const Reaction r = laws_.react(i, signals, memory_.data(), next_.data());
    const double error = r.value - w;
    if (!std::isfinite(error)) return false;
    (error > 0.0 ? low : high) = w;
    const double slope = 1.0 - r.by_flow * by[f] - r.by_stored * by[s];
    double next = w + error / slope;
    const bool bounded = std::isfinite(low) && std::isfinite(high);
    if (!(slope > 0.0) || (bounded && !(next > low && next < high))) next = bounded ? 0.5 * (low + high) : w + error;
    const double step = std::abs(next - w), size = std::max({scale_[i], std::abs(next), std::abs(w)}) * kSolved;
    solved = error == 0.0 || step <= size || (bounded && high - low <= size) ||
             (round > 0 && step < 0.1 * before && step * step / before <= size);
    w = error == 0.0 ? w : next;
    if (solved) break;
    before = step;
  }
  add_column(maps.unknown, p, w - begin, out_.data());
  w_[i + static_cast<std::size_t>(k_)] = w;
  const double size = std::max(scale_[i], std::abs(w));
  *change = w == begin ? 0.0 : std::abs(w - begin) / size;
  return solved;
}

/// Reactions that fit the state as it stands and this input, without time passing.
void Stepper::resettle(double time_s, const double* u) {
  const PlantMatrices& plant = *plan_.plant;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    double most = 0.0;
    for (std::size_t i = 0; i < laws_.count(); ++i) {
      const auto place = static_cast<Eigen::Index>(laws_.place(i));
      double flow = 0.0, stored = 0.0;
      for (int j = 0; j < n_; ++j) {
        flow += plant.Cf(place, j) * x_[static_cast<std::size_t>(j)];
        stored += plant.Cs(place, j) * x_[static_cast<std::size_t>(j)];
      }
      for (int j = 0; j < q_; ++j) {
        flow += plant.Df(place, j) * u[j];
        stored += plant.Ds(place, j) * u[j];
      }
      for (std::size_t other = 0; other < laws_.count(); ++other) {
        const auto from = static_cast<Eigen::Index>(laws_.place(other));
        flow += plant.Ff(place, from) * w_[other];
        stored += plant.Fs(place, from) * w_[other];
      }
      const Reaction r = laws_.react(i, {flow, stored, time_s, 0.0, gain_[i]}, memory_.data(), next_.data());
      const double slope = 1.0 - r.by_flow * plant.Ff(place, place) - r.by_stored * plant.Fs(place, place);
      const double step = (r.value - w_[i]) / (slope > 0.0 ? slope : 1.0);
      if (!std::isfinite(step)) {
        sound_ = false;
        return;
      }
      w_[i] += step;
      const double size = std::max(scale_[i], std::abs(w_[i]));
      if (step != 0.0) most = std::max(most, std::abs(step) / size);
    }
    if (most <= kSolved) return;
  }
}

void Stepper::keep_memory(const StepMaps& maps, double time_s) {
  for (std::size_t i = 0; i < laws_.count(); ++i) {
    const auto f = static_cast<std::size_t>(n_) + i, s = f + static_cast<std::size_t>(k_);
    laws_.react(i, {out_[f], out_[s], time_s + maps.h, maps.h, gain_[i]}, memory_.data(), next_.data());
  }
  memory_.swap(next_);
}

void Stepper::keep_scale() {
  for (std::size_t i = 0; i < laws_.count(); ++i)
    scale_[i] = std::max(scale_[i], std::abs(w_[i + 2 * static_cast<std::size_t>(k_)]));
}

void Stepper::take_sample(const StepMaps& maps, int nodes) {
  product(maps.sample_known, v_.data(), sample_.data());
  for (int c = 0; c < nodes * k_; ++c) add_column(maps.sample_unknown, c, w_[static_cast<std::size_t>(k_ + c)], sample_.data());
}

}  // namespace bodeflow::residual
