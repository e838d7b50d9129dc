#include "trace/attempt.hpp"

#include <algorithm>
#include <cmath>

namespace bodeflow::residual {
namespace {

constexpr std::size_t kSearches = 2;
// The linear look promises so much more than was found.
constexpr double kMoreThere = 1.05;
// A simulation that does so much of what the look promised confirms it.
constexpr double kKept = 0.8;
constexpr int kFirstSteps = 3;
// What can be no more than so small a part of what is missing is not searched for.
constexpr double kWorthOfMissing = 0.02;
// A base that leaves more than this many times the noise may have been pulled far by what is missing: its own starts help.
constexpr double kPulled = 1.5;

Eigen::VectorXd joined(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  Eigen::VectorXd all(a.size() + b.size());
  all << a, b;
  return all;
}

/// The coordinates of a fit with further values of parameters that it does not have.
Eigen::VectorXd extended(const Fit& from, const Coordinates& layout, const Eigen::VectorXd& own) {
  Eigen::VectorXd at(layout.size());
  for (std::size_t r = 0; r < layout.records(); ++r) layout.put(joined(from.values(r), own), r, at);
  return at;
}

}  // namespace

Attempt::Attempt(const Against& against, FitProblem& problem)
    : against_(against), problem_(problem), looks_(Looks::make(problem, against.before.fit)) {
  const Addition& addition = problem.model().additions.back();
  for (const auto& values : addition.effect->starts(addition.situation))
    starts_.push_back(Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size())));
}

bool Attempt::kept(const Approach& a) const { return looks_ && gain(a) >= kKept * promised_; }

void Attempt::find_null(double found) {
  null_ = null_distribution(problem_, against_.before.fit, starts_, found, looks_ ? &*looks_ : nullptr);
}

std::vector<Eigen::VectorXd> Attempt::points_at(const std::vector<Eigen::VectorXd>& own) const {
  const Fit& from = against_.before.fit;
  std::vector<Eigen::VectorXd> all;
  for (const Eigen::VectorXd& values : own) all.push_back(extended(from, problem_.layout(), values));
  if (from.model.additions.empty() && from.chi2 > kPulled * static_cast<double>(from.residual.size()))
    for (const Eigen::VectorXd& base : against_.base_starts)
      for (const Eigen::VectorXd& values : own) all.push_back(problem_.layout().of(joined(base, values)));
  return all;
}

Approach Attempt::search(const std::vector<Eigen::VectorXd>& points) {
  std::vector<std::pair<double, Approach>> open;
  for (const Eigen::VectorXd& point : points) {
    Approach a = approach_from(problem_, point, against_.before.fit.jacobian);
    if (!a.started) continue;
    const double promised = promised_cost(a);
    open.emplace_back(promised, std::move(a));
  }
  std::stable_sort(open.begin(), open.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  Approach best;
  for (std::size_t n = 0; n < std::min(open.size(), kSearches); ++n) {
    Approach& a = open[n].second;
    problem_.bound_base(a.at);
    approach(problem_, kFirstSteps, kLeastFallOfCost, false, a);
    if (!best.started || a.cost < best.cost) best = std::move(a);
  }
  return best;
}

Approach Attempt::nearly_nothing() const {
  Approach a;
  a.at = extended(against_.before.fit, problem_.layout(), null_.nearest);
  a.residual = problem_.residual(a.at);
  a.cost = a.residual.squaredNorm();
  a.jacobian = Eigen::MatrixXd::Zero(0, a.at.size());
  a.started = a.residual.allFinite();
  return a;
}

Approach Attempt::search_by_looks(const std::vector<Eigen::VectorXd>& starts, bool thorough) {
  std::vector<Eigen::VectorXd> from;
  for (const Eigen::VectorXd& start : starts) from.push_back(extended(against_.before.fit, problem_.layout(), start));
  LookedUp up = look_up(problem_, *looks_, against_.before.fit, from);
  promised_ = std::max(promised_, up.promised);
  if (!null_.looked) find_null(up.promised);
  const double seen = std::max(up.promised, gain(up.approach));
  const bool matters = null_.p(seen) < kWorthASearch && seen > kWorthOfMissing * against_.missing;
  const auto kept_here = [&](const Approach& a) { return a.started && gain(a) >= kKept * up.promised; };
  const EffectDescription& what = problem_.model().additions.back().what;
  const bool smooth = !what.rough && what.memory == 0;
  if (!matters && !up.approach.started && null_.looked) up.approach = nearly_nothing();
  if (up.approach.started && (!matters || (smooth && kept_here(up.approach)))) return std::move(up.approach);
  Approach best;
  if (up.approach.started) best = search({up.approach.at});
  if (kept_here(best) || !thorough) return best;
  Approach other = search(points_at(starts));
  return other.started && (!best.started || other.cost < best.cost) ? other : best;
}

Approach Attempt::search_all() {
  const auto from = [&](const std::vector<Eigen::VectorXd>& starts, bool thorough) {
    return looks_ ? search_by_looks(starts, thorough) : search(points_at(starts));
  };
  Approach best = from(starts_, true);
  if (!best.started) return best;
  if (!null_.looked) find_null(gain(best));
  if (null_.starts.empty() || !(null_.most > kMoreThere * std::max(promised_, gain(best)))) return best;
  const std::vector<Eigen::VectorXd> there = null_.starts;
  Approach other = from(there, false);
  return other.started && other.cost < best.cost ? other : best;
}

}  // namespace bodeflow::residual
