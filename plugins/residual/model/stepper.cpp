#include "model/stepper.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bodeflow::residual {
namespace {

// The law's reaction is solved to this part of the largest one: derivatives are differences over 1e-5.
constexpr double kSolved = 1e-11;
constexpr int kNewton = 8;
constexpr int kSweeps = 30;
constexpr int kBisections = 200;
// A rough law bends within a double step where its middle leaves the chord by more than this part of the largest reaction.
constexpr double kBend = 1e-3;
// The flow over which a law may spread a jump: a part of what the jump changes itself, since the end of a step is implicit.
constexpr double kSpread = 0.05;
// Halvings beyond a fine step: parts are then shorter than it takes to pass what a jump is spread over.
constexpr int kDeeper = 5;

std::size_t at(int index) { return static_cast<std::size_t>(index); }

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
  within_s_ = std::max(grid.offset_s - sample_step_ * h, 0.0);
  sample_fine_ = std::min(static_cast<int>(within_s_ / fine_h), grid.fine - 1);
  const Transition t = transition(plan.plant->A, fine_h);
  single_ = single_step(plan, t, -1.0);
  single_sampled_ = single_step(plan, t, std::max(within_s_ - sample_fine_ * fine_h, 0.0));
  any_rough_ = laws_.any_rough();
  feeds_through_ = false;
  for (std::size_t i = 0; i < laws_.count(); ++i) {
    const auto place = static_cast<Eigen::Index>(laws_.place(i));
    feeds_through_ = feeds_through_ || !plan.plant->Df.row(place).isZero(0.0) || !plan.plant->Ds.row(place).isZero(0.0);
    gain_.push_back(std::max(-single_.unknown.column(static_cast<int>(i))[i], 0.0) * kSpread);
  }
  x_.assign(at(n_ + 1), 0.0);
  v_.assign(at(single_.known.columns), 0.0);
  out_.assign(at(n_ + 4 * k_ + 2), 0.0);
  w_.assign(at(3 * k_), 0.0);
  last_.assign(at(3 * k_), 0.0);
  scale_.assign(at(k_), 0.0);
  memory_.assign(laws_.memory() + 1, 0.0);
  next_.assign(laws_.memory() + 1, 0.0);
  u_.assign(at(q_), std::numeric_limits<double>::quiet_NaN());
  ua_.assign(at(q_), 0.0);
  ub_.assign(at(q_), 0.0);
  sample_.assign(at(2 + 2 * static_cast<int>(plan.plant->places()) + 1), 0.0);
}

void Stepper::begin(const Eigen::VectorXd& state, const double* input, double time_s) {
  std::copy(state.data(), state.data() + n_, x_.begin());
  std::fill(w_.begin(), w_.end(), 0.0);
  std::fill(memory_.begin(), memory_.end(), 0.0);
  std::fill(scale_.begin(), scale_.end(), 0.0);
  std::fill(u_.begin(), u_.end(), std::numeric_limits<double>::quiet_NaN());
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
  if (grid_.doubles)
    advance_part(0, 0, u0, u1, time_s, sample);
  else
    advance_fine(u0, u1, time_s, sample);
  return sample;
}

/// x, the inputs at both ends of that part of the step, w.
void Stepper::load_part(const double* u0, const double* u1, int part, int parts) {
  if (plan_.push != Push::straight || parts == 1) return load(u0, u1);
  const double from = static_cast<double>(part) / parts, to = static_cast<double>(part + 1) / parts;
  for (int j = 0; j < q_; ++j) {
    ua_[at(j)] = u0[j] + from * (u1[j] - u0[j]);
    ub_[at(j)] = u0[j] + to * (u1[j] - u0[j]);
  }
  load(ua_.data(), ub_.data());
}

// ---- double steps

const Stepper::Level& Stepper::level(std::size_t halvings) {
  while (levels_.size() <= halvings) {
    const int parts = 1 << levels_.size();
    const double h = grid_.sample_time_s / grid_.steps / parts;
    Level l;
    l.sample_part = std::min(static_cast<int>(within_s_ / h), parts - 1);
    const double within = std::max(within_s_ - l.sample_part * h, 0.0);
    if ((grid_.fine << kDeeper) > parts) {
      const Transition half = transition(plan_.plant->A, 0.5 * h);
      l.plain = double_step(plan_, half, -1.0);
      l.sampled = double_step(plan_, half, within);
    } else {
      const Transition whole = transition(plan_.plant->A, h);
      l.plain = single_step(plan_, whole, -1.0);
      l.sampled = single_step(plan_, whole, within);
    }
    levels_.push_back(std::move(l));
  }
  return levels_[halvings];
}

/// Part `part` of a step halved so many times, in halves again where that does not do.
void Stepper::advance_part(std::size_t halvings, int part, const double* u0, const double* u1, double time_s, bool sample) {
  const Level& l = level(halvings);
  const int parts = 1 << halvings;
  const bool here = sample && part == l.sample_part;
  const StepMaps& maps = here ? l.sampled : l.plain;
  const double h = maps.h;
  load_part(u0, u1, part, parts);
  if (parts == grid_.fine << kDeeper) {
    advance_single(maps, time_s, here);
  } else if (advance_double(maps, time_s, here)) {
    predicts_ = halvings == 0;
    return;
  } else if (!any_rough_) {
    advance_fine(u0, u1, time_s, sample);
  } else {
    advance_part(halvings + 1, 2 * part, u0, u1, time_s, sample);
    advance_part(halvings + 1, 2 * part + 1, u0, u1, time_s + 0.5 * h, sample);
  }
  predicts_ = false;
}

bool Stepper::advance_double(const StepMaps& maps, double time_s, bool sample) {
  const bool settled = k_ == 1   ? settle_double<1>(maps, time_s)
                       : k_ == 2 ? settle_double<2>(maps, time_s)
                                 : settle_double<0>(maps, time_s);
  if (!settled || (any_rough_ && bends())) {
    predicts_ = false;
    return false;
  }
  move_state(maps, 4 * k_, 2 * k_);
  if (sample) take_sample(maps, 2);
  keep_scale();
  for (int i = 0; i < 3 * k_; ++i) last_[at(i)] = w_[at(i)];
  for (int i = 0; i < k_; ++i) w_[at(i)] = w_[at(2 * k_ + i)];
  predicts_ = true;
  return true;
}

/// x at the end: what is known of it (in out_) and the part of the reactions.
void Stepper::move_state(const StepMaps& maps, int signals, int unknown) {
  const double *w = w_.data() + k_, *known = out_.data() + signals;
  double* x = x_.data();
  for (int r = 0; r < n_; ++r) x[r] = known[r];
  for (int c = 0; c < unknown; ++c) {
    const double* column = maps.unknown.column(c) + signals;
    for (int r = 0; r < n_; ++r) x[r] += column[r] * w[c];
  }
}

/// The number of active places is Places, or any where that is 0.
template <int Places>
bool Stepper::settle_double(const StepMaps& maps, double time_s) {
  const int k = Places > 0 ? Places : k_;
  double *first = w_.data(), *middle = first + k, *end = middle + k;
  const double* last = last_.data();
  for (int i = 0; i < k; ++i) {
    const bool parabola = predicts_ && !laws_.rough(at(i));
    middle[i] = parabola ? last[i] - 3.0 * last[k + i] + 3.0 * last[2 * k + i] : first[i];
    end[i] = parabola ? 3.0 * last[i] - 8.0 * last[k + i] + 6.0 * last[2 * k + i] : first[i];
  }
  product(maps.known, v_.data(), out_.data());
  double before = std::numeric_limits<double>::infinity();
  for (int round = 0; round < kNewton; ++round) {
    double change = 0.0;
    for (int i = 0; i < k; ++i) change = std::max(change, correct_double<Places>(i, maps, time_s));
    if (!(change < 1e300)) return false;
    // Newton's steps shrink as the square of their ratio.
    const double ratio = std::min(change / before, 1.0);
    if (change <= kSolved || (round > 0 && change * ratio * ratio <= kSolved)) return true;
    before = change;
  }
  return false;
}

/// One step of Newton's method in the two reactions of place i; its size over the largest reaction.
template <int Places>
double Stepper::correct_double(int i, const StepMaps& maps, double time_s) {
  const int k = Places > 0 ? Places : k_;
  const double *gains = maps.gains.data() + 8 * k * i, *w = w_.data() + k;
  double now[4];  // flow and stored quantity at the middle, at the end
  for (int r = 0; r < 4; ++r) {
    now[r] = out_[at(r * k + i)];
    for (int c = 0; c < 2 * k; ++c) now[r] += gains[2 * k * r + c] * w[c];
  }
  const double half = 0.5 * maps.h, gain = gain_[at(i)];
  const Reaction middle = laws_.react(at(i), {now[0], now[1], time_s + half, half, gain}, memory_.data(), next_.data());
  const Reaction end = laws_.react(at(i), {now[2], now[3], time_s + maps.h, half, gain}, memory_.data(), next_.data());
  const auto slope = [&](const Reaction& r, int row, int column) {
    return -r.by_flow * gains[2 * k * row + column] - r.by_stored * gains[2 * k * (row + 1) + column];
  };
  double &wm = w_[at(k + i)], &we = w_[at(2 * k + i)];
  const double a = 1.0 + slope(middle, 0, i), b = slope(middle, 0, k + i), c = slope(end, 2, i), d = 1.0 + slope(end, 2, k + i);
  const double rm = middle.value - wm, re = end.value - we, per = 1.0 / (a * d - b * c);
  const double dm = (d * rm - b * re) * per, de = (a * re - c * rm) * per;
  wm += dm;
  we += de;
  const double change = std::max(std::abs(dm), std::abs(de));
  return change == 0.0 ? 0.0 : change / std::max({scale_[at(i)], std::abs(wm), std::abs(we)});
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

void Stepper::advance_fine(const double* u0, const double* u1, double time_s, bool sample) {
  for (int f = 0; f < grid_.fine; ++f) {
    const bool here = sample && f == sample_fine_;
    load_part(u0, u1, f, grid_.fine);
    advance_single(here ? single_sampled_ : single_, time_s + f * single_.h, here);
  }
}

void Stepper::advance_single(const StepMaps& maps, double time_s, bool sample) {
  sound_ = settle_single(maps, time_s) && sound_;
  move_state(maps, 2 * k_, k_);
  if (sample) take_sample(maps, 1);
  if (laws_.keeps_memory()) keep_memory(maps, time_s);
  for (int i = 0; i < k_; ++i) w_[at(i)] = w_[at(2 * k_ + i)] = w_[at(k_ + i)];
  keep_scale();
  predicts_ = false;
}

bool Stepper::settle_single(const StepMaps& maps, double time_s) {
  product(maps.known, v_.data(), out_.data());
  if (k_ == 0) return true;
  for (int i = 0; i < k_; ++i) w_[at(k_ + i)] = w_[at(i)];
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

/// Flow and stored quantity of place i at the end of a single step.
Signals Stepper::single_signals(std::size_t i, const StepMaps& maps, double time_s) const {
  const std::size_t k = at(k_);
  const double *gains = maps.gains.data() + 2 * k * i, *w = w_.data() + k_;
  double flow = out_[i], stored = out_[k + i];
  for (std::size_t c = 0; c < k; ++c) {
    flow += gains[c] * w[c];
    stored += gains[k + c] * w[c];
  }
  return {flow, stored, time_s + maps.h, maps.h, gain_[i]};
}

/// The reaction of place i at the end of a single step with the others as they stand: the root of w - law(signals(w)), which
/// rises in w for laws that rise in flow and stored quantity. Newton's method, and halving of the interval where it leaves it.
bool Stepper::solve_place(std::size_t i, const StepMaps& maps, double time_s, double* change) {
  const double *by = maps.unknown.column(static_cast<int>(i)) + i, by_flow = by[0], by_stored = by[k_];
  double& w = w_[i + at(k_)];
  const double begin = w;
  const Signals free = single_signals(i, maps, time_s);
  double low = -std::numeric_limits<double>::infinity(), high = -low, before = high;
  bool solved = false;
  for (int round = 0; round < kBisections && !solved; ++round) {
    Signals signals = free;
    signals.flow += by_flow * (w - begin);
    signals.stored += by_stored * (w - begin);
    const Reaction r = laws_.react(i, signals, memory_.data(), next_.data());
    const double error = r.value - w;
    if (!std::isfinite(error)) return false;
    (error > 0.0 ? low : high) = w;
    const double slope = 1.0 - r.by_flow * by_flow - r.by_stored * by_stored;
    double next = w + error / slope;
    const bool bounded = std::isfinite(low) && std::isfinite(high);
    if (!(slope > 0.0) || (bounded && !(next > low && next < high))) next = bounded ? 0.5 * (low + high) : w + error;
    const double step = std::abs(next - w), size = std::max({scale_[i], std::abs(next), std::abs(w)}) * kSolved;
    solved =
        step <= size || (bounded && high - low <= size) || (round > 0 && step < 0.1 * before && step * step / before <= size);
    w = next;
    before = step;
  }
  *change = w == begin ? 0.0 : std::abs(w - begin) / std::max(scale_[i], std::abs(w));
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
  for (std::size_t i = 0; i < laws_.count(); ++i) laws_.react(i, single_signals(i, maps, time_s), memory_.data(), next_.data());
  memory_.swap(next_);
}

void Stepper::keep_scale() {
  for (std::size_t i = 0; i < laws_.count(); ++i) scale_[i] = std::max(scale_[i], std::abs(w_[i + 2 * at(k_)]));
}

void Stepper::take_sample(const StepMaps& maps, int nodes) {
  product(maps.sample_known, v_.data(), sample_.data());
  for (int c = 0; c < nodes * k_; ++c) add_column(maps.sample_unknown, c, w_[at(k_ + c)], sample_.data());
}

}  // namespace bodeflow::residual
