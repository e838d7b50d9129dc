#include "trace/candidate.hpp"

#include <algorithm>
#include <bodeflow/numerics/chi_squared.hpp>
#include <cmath>

#include "records/signals.hpp"
#include "trace/attempt.hpp"
#include "trace/support.hpp"

namespace bodeflow::residual {
namespace {

using records::short_number;

constexpr int kMoreSteps = 10, kStepsCarriedOver = 2;
// An estimate may be beyond a bound by this part of the bound, or of the parameter's size, if chance can explain that.
constexpr double kAtBound = 0.1;

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

/// What is one value in all records can't be told from 0, so that all it explains are the levels that every record has for
/// itself.
std::string levels_alone(const Levels& levels, const Candidate& c) {
  if (!c.with.fit.polished) return "";
  const Eigen::VectorXd values = c.values(), std = c.std();
  const double most = numerics::chi_squared_limit(levels.p_candidate(), 1.0);
  bool own_levels = false;
  std::string names;
  for (std::size_t i = 0; i < c.addition.parameters.size(); ++i) {
    const FitParameter& p = c.addition.parameters[i];
    const auto n = static_cast<Eigen::Index>(i);
    own_levels = own_levels || p.each_record;
    if (p.each_record) continue;
    if (!(values[n] * values[n] < most * std[n] * std[n])) return "";
    names += (names.empty() ? "" : " and ") + p.name;
  }
  return own_levels && !names.empty()
             ? names + " can't be told from 0: all it explains are levels that differ from record to record"
             : "";
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

/// That of its own parameters beside the settled ones, about where it stands. The model has to live as long.
FitProblem own_problem(const JointModel& model, const Against& against, const Candidate& c) {
  const auto own = static_cast<Eigen::Index>(c.addition.parameters.size());
  FitProblem problem(model, against.bench.fit, static_cast<Eigen::Index>(model.parameters().size()) - own);
  problem.bound_base(c.with.fit.at);
  return problem;
}

/// The candidate where the linear look finds most, if that is no more than chance finds; false else.
bool look_only(const Attempt& attempt, Candidate& c) {
  const double p = c.null.p_of_look();
  if (p < kWorthASearch) return false;
  const Approach a = attempt.nearly_nothing();
  if (!a.started) return false;
  measure(attempt.against(), fit_at(attempt.problem(), a), c);
  if (!c.tried) return false;
  c.fit_gain = c.null.most;
  c.p = p;
  return true;
}

}  // namespace

double Examined::smallest_p() const {
  double least = 1.0;
  for (const RecordTests& record : tests)
    for (const ClassTest& t : record.classes) least = std::isfinite(t.p + t.multiple) ? std::min(least, t.p) : 0.0;
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
  Attempt attempt(against, problem);
  if (against.near_noise) {
    attempt.find_null(0.0);
    c.null = attempt.null();
    if (c.null.looked && look_only(attempt, c)) return c;
  }
  const Approach best = attempt.search_all();
  if (!best.started) {
    c.reason = "could not be fitted: the model with it can't be computed at any start";
    return c;
  }
  c.null = std::move(attempt.null());
  c.approached = attempt.kept(best);
  measure(against, fit_at(problem, best), c);
  c.with.fit.jacobian.resize(0, 0);  // as many as there are candidates: it is formed again where it is needed
  return c;
}

void carry_over(const Against& against, Candidate& c) {
  if (!c.tried || !c.on_parts) return;
  c.on_parts = false;
  const JointModel model = c.with.fit.model;
  FitProblem problem = own_problem(model, against, c);
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
  FitProblem problem = own_problem(model, against, c);
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

std::string weakness(const Levels& levels, const Candidate& c) {
  if (!levels.support) return "";
  return hardly_supported(c.with.fit, c.with.fit.model.additions.size() - 1, c.null.amplitudes, levels.p_candidate());
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
  } else if (const std::string none = levels_alone(levels, c); !none.empty()) {
    c.reason = none;
  } else if (const std::string weak = weakness(levels, c); !weak.empty()) {
    c.reason = "hardly supported: " + weak;
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
