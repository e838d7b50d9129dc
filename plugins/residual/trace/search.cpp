#include "trace/search.hpp"

#include <algorithm>
#include <bodeflow/numerics/chi_squared.hpp>
#include <cmath>

#include "records/signals.hpp"
#include "trace/excerpt.hpp"
#include "trace/support.hpp"

namespace bodeflow::residual {
namespace {

// A candidate that gains less than this part of what the best one does is no rival: it is not fitted to the end.
// One that was searched for by looks is nearer to its end; but where none of those explains, it may not have been.
constexpr double kRival = 0.5, kNearRival = 0.8;
// One that has gained so much of it after a few steps may still overtake.
constexpr double kPromising = 0.2;
constexpr std::size_t kMostSettled = 6;
// One that was fitted to parts of the records only, and lowers the error by less than this part of what it has to, is left there.
constexpr double kHalfwayThere = 0.5;
// One that chance would do once in so many times its level may be a finding once it is fitted to the end.
constexpr double kNearLevel = 100.0;

// What removes less than this part of the squared error that another does is no equivalent of it, where no floor is known.
constexpr double kAlike = 0.8;

// Deviations of chi2 by chance.
constexpr double kStandsOut = 10.0;

class Searcher {
 public:
  Searcher(const std::vector<Eigen::VectorXd>& base_starts, const Catalogue& catalogue, const Bench& bench,
           const SearchSettings& settings)
      : base_starts_(base_starts), catalogue_(catalogue), bench_(bench), settings_(settings) {
    floor_known_ = bench.select->floor_known();
    out_.levels.alpha = settings.alpha;
    out_.levels.share = settings.share;
    out_.levels.candidates = 0;
    out_.levels.support = !floor_known_ && bench.select->facts().sample_rate_hz > 0.0;
  }

  Expected<Searched> run(const JointModel& base) {
    auto fitted = fit(base, bench_.fit, base_starts_);
    if (!fitted) return refused("the base model could not be fitted: " + fitted.error().text);
    auto examined = examine(std::move(*fitted), bench_);
    if (!examined) return tl::unexpected(examined.error());
    out_.base = std::move(*examined);
    test_classes(bench_, out_.base);
    out_.levels.class_tests = out_.base.test_count();
    out_.best = out_.base;
    while (out_.found.size() < settings_.most_effects && take_step()) {
    }
    if (!out_.found.empty() && (out_.explains || !floor_known_)) find_equivalents();
    tell_passed_over();
    return std::move(out_);
  }

 private:
  std::vector<Eigen::VectorXd> values_of(const Fit& f) const {
    std::vector<Eigen::VectorXd> all;
    for (std::size_t r = 0; r < bench_.fit.size(); ++r) all.push_back(f.values(r));
    return all;
  }

  /// All that can be tried beside a model, best first, the promising ones fitted to the end.
  Step try_all(const Examined& before, const Catalogue& catalogue, bool first, bool priced) {
    Step step;
    const bool near = floor_known_ && !before.tests.empty() && before.smallest_p() > out_.levels.p_class();
    const Fit& base = out_.base.fit;
    const double known = std::max(base.chi2 - static_cast<double>(base.residual.size()), 0.0);
    const double missing = floor_known_ ? known : out_.levels.support ? before.fit.chi2 : 0.0;
    const Against against{bench_, before, out_.base.select.residual, base_starts_, near, near ? 0.0 : missing};
    const std::optional<Excerpt> excerpt = near ? std::nullopt : excerpt_of(bench_, before);
    std::vector<Bound> all = bind_all(catalogue, before.fit.model, values_of(before.fit), bench_.fit);
    if (settings_.progress) {
      const auto fit = std::count_if(all.begin(), all.end(), [](const Bound& b) { return b.refusal.empty(); });
      settings_.progress("tries " + std::to_string(fit) + " effects" +
                         (out_.found.empty() ? "" : " beside " + std::to_string(out_.found.size()) + " found before"));
    }
    for (Bound& b : all) {
      if (!b.refusal.empty()) {
        if (out_.steps.empty()) out_.refused.push_back(std::move(b));
        continue;
      }
      if (excerpt) {
        const Against part{excerpt->bench, excerpt->before,         against.original_select, base_starts_,
                           near,           excerpt->before.fit.chi2};
        step.candidates.push_back(try_effect(b.addition, part));
        step.candidates.back().on_parts = step.candidates.back().tried;
      } else {
        step.candidates.push_back(try_effect(b.addition, against));
      }
    }
    if (priced) out_.levels.candidates += step.candidates.size();
    step.levels = out_.levels;
    const bool share_counts = !first || stands_out();
    carry_over_best(against, kPromising, step);
    settle_and_judge(against, share_counts, step);
    const auto none = [&step] { return step.candidates.empty() || !step.candidates.front().accepted; };
    if (excerpt && none()) {
      carry_over_best(against, 0.0, step);
      settle_and_judge(against, share_counts, step);
    }
    judge_leaders(step);
    if (floor_known_ && leaves_something(step)) {
      settle_and_judge(against, share_counts, step, kRival);
      judge_leaders(step);
    }
    return step;
  }

  /// The best candidate is accepted, but what it leaves is more than noise, or its fit has not ended.
  static bool leaves_something(const Step& step) {
    if (step.candidates.empty() || !step.candidates.front().accepted) return false;
    const Candidate& best = step.candidates.front();
    return !best.explains || !best.with.fit.converged || best.with.smallest_p() <= step.levels.p_class();
  }

  /// Takes those that were fitted to parts of the records to the whole ones: what gains at least that part of the best on the
  /// selecting record, and lowers the error there by a good part of what it has to. The others keep what the parts say of them.
  static void carry_over_best(const Against& against, double part, Step& step) {
    double most = 0.0;
    for (const Candidate& c : step.candidates)
      if (c.tried) most = std::max(most, c.merit());
    for (Candidate& c : step.candidates) {
      const double was = std::sqrt(c.select_gain.excess_before), is = std::sqrt(c.select_gain.excess_after);
      if (c.on_parts && c.merit() >= part * most && is < (1.0 - kHalfwayThere * kLeastFall) * was) carry_over(against, c);
    }
  }

  void settle_and_judge(const Against& against, bool share_counts, Step& step, double near_rival = kNearRival) const {
    auto& all = step.candidates;
    go_on_with_rivals(against, step);
    settle_rivals(against, near_rival, step);
    for (Candidate& c : all) judge(step.levels, share_counts, floor_known_, c);
    rank(all);
    while (!all.empty() && all.front().accepted && !all.front().with.fit.polished) {
      carry_over(against, all.front());
      settle(against, all.front());
      judge(step.levels, share_counts, floor_known_, all.front());
      rank(all);
    }
    if (out_.levels.support) settle_simpler(against, share_counts, step);
  }

  /// Squares that it removes from the selecting record.
  static double removed(const Candidate& c) { return c.select_gain.excess_before - c.select_gain.excess_after; }

  /// Fits those to the end that explain nearly as much as the best with fewer parameters: `prefer_simpler` may choose them.
  void settle_simpler(const Against& against, bool share_counts, Step& step) const {
    auto& all = step.candidates;
    if (all.empty() || !all.front().accepted) return;
    const double price = all.front().price, most = removed(all.front());
    for (Candidate& c : all) {
      if (!c.accepted || c.with.fit.polished || !(c.price < price) || !(removed(c) > kAlike * most)) continue;
      carry_over(against, c);
      settle(against, c);
      judge(step.levels, share_counts, floor_known_, c);
    }
    rank(all);
  }

  /// What the base model leaves of the selecting record is so much more than noise that shares of it mean something.
  bool stands_out() const {
    const Eigen::VectorXd& left = out_.base.select.residual;
    return bench_.select->gain(left, left).excess_before > kStandsOut * std::sqrt(2.0 * static_cast<double>(left.size()));
  }

  static void rank(std::vector<Candidate>& candidates) {
    std::stable_sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
      if (a.accepted != b.accepted) return a.accepted;
      if (a.tried != b.tried) return a.tried;
      return a.merit() > b.merit();
    });
  }

  static void go_on_with_rivals(const Against& against, Step& step) {
    double most = 0.0;
    for (const Candidate& c : step.candidates)
      if (!c.on_parts) most = std::max(most, c.fit_gain);
    for (Candidate& c : step.candidates)
      if (!c.on_parts && c.fit_gain > kPromising * most && c.p < kNearLevel * step.levels.p_candidate()) go_on(against, c);
  }

  void settle_rivals(const Against& against, double near_rival, Step& step) const {
    auto& all = step.candidates;
    for (std::size_t n = 0; n < kMostSettled; ++n) {
      double best = 0.0;
      for (const Candidate& c : all)
        if (c.tried) best = std::max(best, c.merit());
      Candidate* next = nullptr;
      for (Candidate& c : all) {
        const double rival = c.approached ? near_rival : kRival;
        if (!c.tried || c.on_parts || c.with.fit.polished || c.p > kNearLevel * step.levels.p_candidate() ||
            c.merit() < rival * best || !weakness(step.levels, c).empty())
          continue;
        if (next == nullptr || c.merit() > next->merit()) next = &c;
      }
      if (next == nullptr) return;
      settle(against, *next);
    }
  }

  /// Class tests for the best and for those that are no further from it than chance.
  void judge_leaders(Step& step) const {
    auto& all = step.candidates;
    const auto leader = std::find_if(all.begin(), all.end(), [](const Candidate& c) { return c.accepted; });
    if (leader == all.end()) return;
    for (auto c = leader; c != all.end() && c->accepted; ++c) {
      if (!c->with.fit.polished) {
        c->reason = "explains less than " + leader->label;
        continue;
      }
      const double z = c == leader ? 0.0 : distinction(bench_, *leader, *c);
      if (z < step.levels.z_candidate()) {
        judge_rest(step.levels, bench_, *c);
      } else {
        c->reason = "explains less than " + leader->label + ": " + records::short_number(z, 2) + " standard deviations apart";
      }
    }
    std::stable_sort(all.begin(), all.end(), [](const Candidate& a, const Candidate& b) { return a.explains && !b.explains; });
    prefer_simpler(step);
  }

  /// Moves to the front what explains with fewer parameters, where the more of the best say nothing: a likelihood ratio that
  /// chance makes with a probability above alpha / 2. Where the floor is unknown no effect may explain all that is left, and
  /// what was not modelled makes every ratio significant: there it is what the blocks of the selecting record can't tell apart.
  void prefer_simpler(Step& step) const {
    auto& all = step.candidates;
    if (!floor_known_) {
      for (std::size_t n = 1; n < all.size() && all[n].accepted; ++n) {
        if (!all[n].with.fit.polished || !(all[n].price < all.front().price)) continue;
        if (step.levels.support && !(removed(all[n]) > kAlike * removed(all.front()))) continue;
        if (!(distinction(bench_, all.front(), all[n]) < step.levels.z_candidate())) continue;
        std::rotate(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(n), all.begin() + static_cast<std::ptrdiff_t>(n) + 1);
      }
      return;
    }
    for (std::size_t n = 1; n < all.size() && all[n].explains; ++n) {
      const double more = all.front().price - all[n].price, gain = all.front().fit_gain - all[n].fit_gain;
      if (!(more > 0.0) || numerics::chi_squared_tail(gain, more) < out_.levels.alpha / 2.0) continue;
      std::rotate(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(n), all.begin() + static_cast<std::ptrdiff_t>(n) + 1);
    }
  }

  /// Adds the best candidate; false where the search is over.
  bool take_step() {
    Step step = try_all(out_.best, catalogue_, out_.found.empty(), true);
    const bool some = !step.candidates.empty() && step.candidates.front().accepted;
    if (some) {
      Candidate& best = step.candidates.front();
      step.taken = 0;
      best.reason = "added";
      out_.best = best.with;
      out_.share = best.share;
      out_.found.push_back({best.addition, best.added_share, {}, {}, best.null.amplitudes});
      out_.explains = best.explains && (floor_known_ || best.with.smallest_p() > step.levels.p_class());
    }
    out_.steps.push_back(std::move(step));
    if (some && out_.found.size() > 1) drop_needless();
    // What passes the class tests may hide a further effect; beyond `share` none can add what it would have to.
    return some && !(floor_known_ && out_.explains && out_.share > out_.levels.share);
  }

  /// The model without the effect at `position`, fitted.
  std::optional<Examined> without(std::size_t position) const {
    JointModel model = out_.best.fit.model;
    const Eigen::VectorXd all = out_.best.fit.values();
    const Eigen::Index begin = model.begin_of(position);
    const auto count = static_cast<Eigen::Index>(model.additions[position].parameters.size());
    Eigen::VectorXd start(all.size() - count);
    start << all.head(begin), all.tail(all.size() - begin - count);
    model.additions.erase(model.additions.begin() + static_cast<std::ptrdiff_t>(position));
    auto fitted = fit(model, bench_.fit, {start});
    if (!fitted) return {};
    auto examined = examine(std::move(*fitted), bench_);
    if (!examined) return {};
    return std::move(*examined);
  }

  /// What is found later may take the ground from under what was found before.
  bool is_supported(std::size_t n) const {
    return !out_.levels.support ||
           hardly_supported(out_.best.fit, n, out_.found[n].amplitudes, out_.levels.p_candidate()).empty();
  }

  /// Drops effects whose absence costs nothing on the selecting record.
  void drop_needless() {
    for (std::size_t n = 0; n + 1 < out_.found.size();) {
      auto rest = without(n);
      if (!rest) return;
      const Gain g = bench_.select->gain(rest->select.residual, out_.best.select.residual);
      const double fitted = static_cast<double>(out_.best.select.fitted - rest->select.fitted);
      if (held_out_p(g.likelihood, fitted) < out_.levels.p_candidate() && is_supported(n)) {
        ++n;
        continue;
      }
      out_.dropped.push_back(out_.found[n].addition.label);
      out_.found.erase(out_.found.begin() + static_cast<std::ptrdiff_t>(n));
      out_.best = std::move(*rest);
      test_classes(bench_, out_.best);
      const Gain whole = bench_.select->gain(out_.base.select.residual, out_.best.select.residual);
      out_.share = whole.excess_before > 0.0 ? std::clamp(1.0 - whole.excess_after / whole.excess_before, 0.0, 1.0) : 0.0;
      out_.explains = out_.best.smallest_p() > out_.levels.p_class() || (floor_known_ && out_.share > out_.levels.share);
    }
  }

  /// The final model as a candidate whose last effect is that at `position`.
  Candidate final_candidate(double price) const {
    Candidate c;
    c.with = out_.best;
    c.price = price;
    return c;
  }

  /// Effects that passed as a candidate at some step.
  Catalogue once_accepted() const {
    Catalogue some;
    for (const CatalogueEntry& entry : catalogue_) {
      const bool passed = std::any_of(out_.steps.begin(), out_.steps.end(), [&](const Step& s) {
        return std::any_of(s.candidates.begin(), s.candidates.end(),
                           [&](const Candidate& c) { return c.accepted && c.addition.what.id == entry.what.id; });
      });
      if (passed) some.push_back(entry);
    }
    return some;
  }

  void find_equivalents() {
    const bool one = out_.found.size() == 1;
    const Catalogue rivals = once_accepted();
    for (std::size_t n = 0; n < out_.found.size(); ++n) {
      if (one && out_.dropped.empty()) {
        compare(n, out_.steps.front());
      } else if (auto rest = without(n)) {
        test_classes(bench_, *rest);
        Step step = try_all(*rest, rivals, false, false);
        compare(n, step);
      }
    }
  }

  /// What explains and was not the best of its step has a reason too.
  void tell_passed_over() {
    for (Step& step : out_.steps) {
      if (!step.taken) continue;
      for (Candidate& c : step.candidates)
        if (c.reason.empty()) c.reason = "explains it too, " + step.candidates[*step.taken].label + " was ahead";
    }
  }

  /// Where no floor is known, blocks that differ much hide that one of them removes far less of the squares.
  bool explains_alike(const Candidate& best, const Candidate& c) const {
    if (!out_.levels.support) return true;
    return removed(c) > kAlike * (c.select_gain.excess_before - best.with.select.residual.squaredNorm());
  }

  /// What the best leaves is noise, and what that one leaves is not.
  bool leaves_more(const Candidate& c, const Step& step) const {
    const double limit = step.levels.p_class();
    return floor_known_ && out_.best.smallest_p() > limit && c.with.smallest_p() <= limit;
  }

  /// Notes what explains as well as the effect at that position.
  void compare(std::size_t position, Step& step) {
    Found& f = out_.found[position];
    const auto own = std::find_if(step.candidates.begin(), step.candidates.end(),
                                  [&](const Candidate& c) { return c.label == f.addition.label; });
    if (own == step.candidates.end()) return;
    const Candidate best = final_candidate(own->price);
    for (Candidate& c : step.candidates) {
      if (c.label == f.addition.label || !c.accepted || !c.with.fit.polished || (out_.explains && !c.explains)) continue;
      const double z = distinction(bench_, best, c);
      const bool apart = z > step.levels.z_candidate() || !explains_alike(best, c) || leaves_more(c, step);
      c.reason = (apart ? "explains less than " : "explains it as well as ") + f.addition.label + (apart ? ": " : " does: ") +
                 records::short_number(z, 2) + " standard deviations apart";
      if (!apart) f.equivalents.push_back(c.label);
    }
    if (!f.equivalents.empty()) f.separation = "measure at one more level, and over a wider band";
  }

  const std::vector<Eigen::VectorXd>& base_starts_;
  const Catalogue& catalogue_;
  const Bench& bench_;
  const SearchSettings& settings_;
  bool floor_known_ = true;
  Searched out_;
};

}  // namespace

Expected<Searched> search(const JointModel& base, const std::vector<Eigen::VectorXd>& base_starts, const Catalogue& catalogue,
                          const Bench& bench, const SearchSettings& settings) {
  return Searcher(base_starts, catalogue, bench, settings).run(base);
}

}  // namespace bodeflow::residual
