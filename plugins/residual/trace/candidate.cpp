#include "trace/candidate.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "records/signals.hpp"

namespace bodeflow::residual {
namespace {

using records::short_number;

constexpr std::size_t kSearches = 2;
// The linear look promises so much more than was found.
constexpr double kMoreThere = 1.05;
// A simulation that does so much of what the look promised confirms it.
constexpr double kKept = 0.8;
constexpr int kFirstSteps = 3, kMoreSteps = 10, kStepsCarriedOver = 2;
// What chance does more often than that is not looked at more closely near the noise.
constexpr double kWorthASearch = 0.05;
// Nor what can be no more than so small a part of what is missing.
constexpr double kWorthOfMissing = 0.02;
// In units of minus twice the log likelihood: what chance alone moves by more.
constexpr double kLeastFallOfCost = 0.05;
// A base that leaves more than this many times the noise may have been pulled far by what is missing: its own starts help.
constexpr double kPulled = 1.5;
// An estimate may be beyond a bound by this part of the bound, or of the parameter's size, if chance can explain that.
constexpr double kAtBound = 0.1;

Eigen::VectorXd joined(const Eigen::VectorXd& a, const std::vector<double>& b) {
  Eigen::VectorXd all(a.size() + static_cast<Eigen::Index>(b.size()));
  all << a, Eigen::Map<const Eigen::VectorXd>(b.data(), static_cast<Eigen::Index>(b.size()));
  return all;
}

/// The coordinates of a fit with further values of parameters that it does not have.
Eigen::VectorXd extended(const Fit& from, const Coordinates& layout, const std::vector<double>& own) {
  Eigen::VectorXd at(layout.size());
  for (std::size_t r = 0; r < layout.records(); ++r) layout.put(joined(from.values(r), own), r, at);
  return at;
}

std::vector<Eigen::VectorXd> points(const Against& against, const FitProblem& problem,
                                    const std::vector<std::vector<double>>& own) {
  const Fit& from = against.before.fit;
  std::vector<Eigen::VectorXd> all;
  for (const auto& values : own) all.push_back(extended(from, problem.layout(), values));
  if (from.model.additions.empty() && from.chi2 > kPulled * static_cast<double>(from.residual.size()))
    for (const Eigen::VectorXd& base : against.base_starts)
      for (const auto& values : own) all.push_back(problem.layout().of(joined(base, values)));
  return all;
}

/// The best of quick searches from the most promising points.
Approach search(const Against& against, FitProblem& problem, const std::vector<Eigen::VectorXd>& points) {
  std::vector<std::pair<double, Approach>> open;
  for (const Eigen::VectorXd& point : points) {
    Approach a = approach_from(problem, point, against.before.fit.jacobian);
    if (!a.started) continue;
    const double promised = promised_cost(a);
    open.emplace_back(promised, std::move(a));
  }
  std::stable_sort(open.begin(), open.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  Approach best;
  for (std::size_t n = 0; n < std::min(open.size(), kSearches); ++n) {
    Approach& a = open[n].second;
    problem.bound_base(a.at);
    approach(problem, kFirstSteps, kLeastFallOfCost, false, a);
    if (!best.started || a.cost < best.cost) best = std::move(a);
  }
  return best;
}

/// An effect with all that its search needs.
struct Attempt {
  const Against& against;
  FitProblem& problem;
  std::optional<Looks> looks;
  std::vector<Eigen::VectorXd> starts;  ///< values of the effect's parameters
  Null null;
  double promised = 0.0;  ///< the most that the looks found

  std::vector<Eigen::VectorXd> points_at(const std::vector<Eigen::VectorXd>& own) const {
    std::vector<std::vector<double>> values;
    for (const Eigen::VectorXd& v : own) values.emplace_back(v.begin(), v.end());
    return points(against, problem, values);
  }
  double gain(const Approach& a) const { return a.started ? against.before.fit.chi2 - a.cost : 0.0; }
  void find_null(double found) {
    null = null_distribution(problem, against.before.fit, starts, found, looks ? &*looks : nullptr);
  }
};

/// The model with the effect where the linear look finds most, however little that is.
Approach nearly_nothing(const Attempt& attempt) {
  Approach a;
  const Null& null = attempt.null;
  a.at = extended(attempt.against.before.fit, attempt.problem.layout(), {null.nearest.begin(), null.nearest.end()});
  a.residual = attempt.problem.residual(a.at);
  a.cost = a.residual.squaredNorm();
  a.jacobian = Eigen::MatrixXd::Zero(0, a.at.size());
  a.started = a.residual.allFinite();
  return a;
}

/// The best that the looks find from some values, simulated; one that matters and that the looks can't be trusted with is
/// searched for by simulations too, where `thorough` from all these values.
Approach search_by_looks(Attempt& attempt, const std::vector<Eigen::VectorXd>& starts, bool thorough) {
  const Against& against = attempt.against;
  std::vector<Eigen::VectorXd> from;
  for (const Eigen::VectorXd& start : starts)
    from.push_back(extended(against.before.fit, attempt.problem.layout(), {start.begin(), start.end()}));
  LookedUp up = look_up(attempt.problem, *attempt.looks, against.before.fit, from);
  attempt.promised = std::max(attempt.promised, up.promised);
  if (!attempt.null.looked) attempt.find_null(up.promised);
  const double seen = std::max(up.promised, attempt.gain(up.approach));
  const bool matters = attempt.null.p(seen) < kWorthASearch && seen > kWorthOfMissing * against.missing;
  const auto kept = [&](const Approach& a) { return a.started && attempt.gain(a) >= kKept * up.promised; };
  const EffectDescription& what = attempt.problem.model().additions.back().what;
  const bool smooth = !what.rough && what.memory == 0;
  if (!matters && !up.approach.started && attempt.null.looked) up.approach = nearly_nothing(attempt);
  if (up.approach.started && (!matters || (smooth && kept(up.approach)))) return std::move(up.approach);
  Approach best;
  if (up.approach.started) best = search(against, attempt.problem, {up.approach.at});
  if (kept(best) || !thorough) return best;
  Approach other = search(against, attempt.problem, attempt.points_at(starts));
  return other.started && (!best.started || other.cost < best.cost) ? other : best;
}

/// The best of searches from the starts of the effect, and from where the linear look finds more than these do.
Approach search_all(Attempt& attempt) {
  const auto from = [&](const std::vector<Eigen::VectorXd>& starts, bool thorough) {
    return attempt.looks ? search_by_looks(attempt, starts, thorough)
                         : search(attempt.against, attempt.problem, attempt.points_at(starts));
  };
  Approach best = from(attempt.starts, true);
  if (!best.started) return best;
  if (!attempt.null.looked) attempt.find_null(attempt.gain(best));
  if (attempt.null.starts.empty() || !(attempt.null.most > kMoreThere * std::max(attempt.promised, attempt.gain(best))))
    return best;
  Approach other = from(attempt.null.starts, false);
  return other.started && other.cost < best.cost ? other : best;
}

std::string unphysical(const Candidate& c) {
  const Eigen::VectorXd values = c.values(), std = c.std();
  for (std::size_t i = 0; i < c.addition.parameters.size(); ++i) {
    const FitParameter& p = c.addition.parameters[i];
    const auto n = static_cast<Eigen::Index>(i);
    const double bound = values[n] < p.low ? p.low : p.high;
    const double size = std::max(std::isfinite(bound) ? std::abs(bound) : 0.0, p.logarithmic ? 0.0 : std::abs(p.scale));
    const std::string where = beyond(p, values[n], std::min(2.0 * std[n], kAtBound * size));
    if (!where.empty()) return p.name + " would be " + where;
  }
  return "";
}

/// A parameter whose bound is at 0 is beyond it.
bool wrong_sign(const Candidate& c) {
  const Eigen::VectorXd values = c.values();
  for (std::size_t i = 0; i < c.addition.parameters.size(); ++i) {
    const FitParameter& p = c.addition.parameters[i];
    const double v = values[static_cast<Eigen::Index>(i)];
    if ((p.low == 0.0 && v < 0.0) || (p.high == 0.0 && v > 0.0)) return true;
  }
  return false;
}

double sum_of_gains(const Measurements& records, const Eigen::VectorXd& before, const Eigen::VectorXd& after) {
  double sum = 0.0;
  Eigen::Index at = 0;
  for (const auto& r : records) {
    sum += r->gain(before.segment(at, r->rows()), after.segment(at, r->rows())).likelihood;
    at += r->rows();
  }
  return sum;
}

double share_of(const Gain& g) {
  return g.excess_before > 0.0 ? std::clamp(1.0 - g.excess_after / g.excess_before, 0.0, 1.0) : 0.0;
}

/// The numbers of a candidate whose model has been fitted so far.
void measure(const Against& against, Fit f, Candidate& c) {
  auto examined = examine(std::move(f), against.bench);
  if (!examined) {
    c.tried = false;
    c.reason = "could not be fitted: " + examined.error().text;
    return;
  }
  const Examined& before = against.before;
  const Measurement& select = *against.bench.select;
  c.tried = true;
  c.with = std::move(*examined);
  c.fit_gain = sum_of_gains(against.bench.fit, before.fit.residual, c.with.fit.residual);
  c.p = c.null.p(c.fit_gain);
  if (c.null.one_sided && wrong_sign(c)) c.p = 1.0 - c.p;
  c.select_gain = select.gain(before.select.residual, c.with.select.residual);
  const double fitted = static_cast<double>(c.with.select.fitted - before.select.fitted);
  c.select_p = held_out_p(c.select_gain.likelihood, fitted);
  c.price = static_cast<double>(c.with.fit.layout.shared() - before.fit.layout.shared()) + fitted;
  c.share = share_of(select.gain(against.original_select, c.with.select.residual));
  c.added_share = c.share - share_of(select.gain(against.original_select, before.select.residual));
}

/// The candidate where the linear look finds most, if that is no more than chance finds; false else.
bool look_only(const Attempt& attempt, Candidate& c) {
  const double p = c.null.p_of_look();
  if (p < kWorthASearch) return false;
  const Approach a = nearly_nothing(attempt);
  if (!a.started) return false;
  measure(attempt.against, fit_at(attempt.problem, a), c);
  if (!c.tried) return false;
  c.fit_gain = c.null.most;
  c.p = p;
  return true;
}

}  // namespace

double Examined::smallest_p() const {
  double least = 1.0;
  for (const RecordTests& record : tests)
    for (const ClassTest& t : record.classes) least = std::min(least, t.p);
  return least;
}

std::size_t Examined::test_count() const {
  std::size_t count = 0;
  for (const RecordTests& record : tests) count += record.classes.size();
  return count;
}

Expected<Examined> examine(Fit fit, const Bench& bench) {
  auto held = hold_out(fit, *bench.select);
  if (!held) return tl::unexpected(held.error());
  return Examined{std::move(fit), std::move(*held), {}};
}

void test_classes(const Bench& bench, Examined& x) {
  if (!x.tests.empty()) return;
  for (std::size_t r = 0; r < bench.fit.size(); ++r)
    x.tests.push_back({bench.fit[r]->facts().name, fitted_tests(x.fit, bench.fit, r)});
  x.tests.push_back({bench.select->facts().name, held_out_tests(x.fit, x.select, *bench.select)});
}

Eigen::VectorXd Candidate::values(std::size_t record) const {
  return with.fit.values(record).tail(static_cast<Eigen::Index>(addition.parameters.size()));
}

Eigen::VectorXd Candidate::std(std::size_t record) const {
  return with.fit.std(record).tail(static_cast<Eigen::Index>(addition.parameters.size()));
}

Candidate try_effect(const Addition& addition, const Against& against) {
  Candidate c;
  c.addition = addition;
  c.label = addition.label;
  JointModel model = against.before.fit.model;
  const Eigen::Index settled = static_cast<Eigen::Index>(model.parameters().size());
  model.additions.push_back(addition);
  FitProblem problem(model, against.bench.fit, settled);
  Attempt attempt{against, problem, Looks::make(problem, against.before.fit), {}, {}, 0.0};
  for (const auto& values : addition.effect->starts(addition.situation))
    attempt.starts.push_back(Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size())));
  if (against.near_noise) {
    attempt.find_null(0.0);
    c.null = attempt.null;
    if (c.null.looked && look_only(attempt, c)) return c;
  }
  const Approach best = search_all(attempt);
  if (!best.started) {
    c.reason = "could not be fitted: the model with it can't be computed at any start";
    return c;
  }
  c.null = std::move(attempt.null);
  c.approached = attempt.looks && attempt.gain(best) >= kKept * attempt.promised;
  measure(against, fit_at(problem, best), c);
  c.with.fit.jacobian.resize(0, 0);  // as many as there are candidates: it is formed again where it is needed
  return c;
}

void carry_over(const Against& against, Candidate& c) {
  if (!c.tried || !c.on_parts) return;
  c.on_parts = false;
  const JointModel model = c.with.fit.model;
  const auto own = static_cast<Eigen::Index>(c.addition.parameters.size());
  FitProblem problem(model, against.bench.fit, static_cast<Eigen::Index>(model.parameters().size()) - own);
  problem.bound_base(c.with.fit.at);
  Approach a = approach_from(problem, c.with.fit.at, against.before.fit.jacobian);
  approach(problem, kStepsCarriedOver, kLeastFallOfCost, false, a);
  if (!a.started) {
    c.tried = false;
    c.reason = "could not be fitted: the model with it can't be computed on the whole of the records";
    return;
  }
  // A tone is looked for among the bins of the whole record.
  if (c.addition.what.acts == Acts::tone) c.null = null_distribution(problem, against.before.fit, {c.values()}, 0.0, nullptr);
  measure(against, fit_at(problem, a), c);
  c.with.fit.jacobian.resize(0, 0);
}

void go_on(const Against& against, Candidate& c) {
  if (!c.tried || c.approached || c.with.fit.polished) return;
  const JointModel model = c.with.fit.model;
  const auto own = static_cast<Eigen::Index>(c.addition.parameters.size());
  FitProblem problem(model, against.bench.fit, static_cast<Eigen::Index>(model.parameters().size()) - own);
  problem.bound_base(c.with.fit.at);
  Approach a = approach_from(problem, c.with.fit.at, against.before.fit.jacobian);
  approach(problem, kMoreSteps, kLeastFallOfCost, true, a);
  if (!a.started || !(a.cost < c.with.fit.chi2)) return;
  measure(against, fit_at(problem, a), c);
  c.with.fit.jacobian.resize(0, 0);
}

void settle(const Against& against, Candidate& c) {
  if (!c.tried || c.with.fit.polished) return;
  const JointModel model = c.with.fit.model;
  FitProblem problem(model, against.bench.fit);
  problem.bound_base(c.with.fit.at);
  auto fitted = polish(problem, c.with.fit.at);
  if (!fitted) {
    c.tried = false;
    c.reason = "could not be fitted to the end: " + fitted.error().text;
    return;
  }
  measure(against, std::move(*fitted), c);
  c.with.fit.polished = true;
}

void judge(const Levels& levels, bool share_counts, bool floor_known, Candidate& c) {
  c.accepted = false;
  if (!c.tried) return;
  const auto below = [](double limit) { return ", needed below " + short_number(limit, 2); };
  const double was = std::sqrt(c.select_gain.excess_before), is = std::sqrt(c.select_gain.excess_after);
  // A noise model takes what changes slowly, an offset or a drift, for noise: blocks that show it at the same price are enough.
  const bool by_blocks = !floor_known && c.select_gain.block_z > levels.z_candidate();
  if (const std::string where = unphysical(c); !where.empty() && std::min(c.p, 1.0 - c.p) < levels.p_candidate()) {
    c.reason = "not physical: " + where;
  } else if (!(c.p < levels.p_candidate())) {
    c.reason = "improves the fit no more than chance does: p = " + short_number(c.p, 2) + below(levels.p_candidate());
  } else if (!(c.select_p < levels.p_candidate()) && !by_blocks) {
    c.reason =
        "does not help on the record that was not fitted: p = " + short_number(c.select_p, 2) + below(levels.p_candidate());
  } else if (!floor_known && !(c.select_gain.block_z > levels.z_block())) {
    c.reason = "helps in parts of the record that was not fitted and harms in others: " + short_number(c.select_gain.block_z, 2) +
               " deviations by blocks, needed above " + short_number(levels.z_block(), 2);
  } else if (!floor_known && !(is < (1.0 - kLeastFall) * was)) {
    c.reason = "lowers the error on the record that was not fitted by less than " + short_number(100.0 * kLeastFall, 2) + " %";
  } else if (floor_known && share_counts && !(c.added_share > kLeastShare)) {
    c.reason = "adds " + short_number(100.0 * c.added_share, 2) + " % to what is explained, needed above " +
               short_number(100.0 * kLeastShare, 2) + " %";
  } else {
    c.accepted = true;
    c.reason = "";
  }
}

void judge_rest(const Levels& levels, const Bench& bench, Candidate& c) {
  if (!c.accepted) return;
  test_classes(bench, c.with);
  c.explains = c.share > levels.share || c.with.smallest_p() > levels.p_class();
  if (!c.explains) {
    c.reason = "explains only " + short_number(100.0 * c.share, 3) + " % of what is missing, needed above " +
               short_number(100.0 * levels.share, 3) + " %, and what it leaves is not noise";
  }
}

double distinction(const Bench& bench, const Candidate& better, const Candidate& other) {
  if (!bench.select->floor_known()) return bench.select->gain(other.with.select.residual, better.with.select.residual).block_z;
  const auto squares = [](const Candidate& c) {
    Eigen::VectorXd all(c.with.fit.residual.size() + c.with.select.residual.size());
    all << c.with.fit.residual.cwiseAbs2(), c.with.select.residual.cwiseAbs2();
    return all;
  };
  const Eigen::VectorXd d = squares(other) - squares(better);
  const double std = std::sqrt((d.array() - d.mean()).square().sum());
  return std > 0.0 ? (d.sum() + other.price - better.price) / std : 0.0;
}

}  // namespace bodeflow::residual
