#include "trace.hpp"

#include <algorithm>
#include <cmath>

#include "records/signals.hpp"
#include "statistics.hpp"

namespace bodeflow::residual {
namespace {

Expected<void> check(const TraceData& data) {
  if (data.fit.empty()) return refused("no record to fit");
  const Experiment& first = data.fit.front();
  std::vector<const Experiment*> others = {&data.select, &data.test};
  for (const Experiment& e : data.fit) others.push_back(&e);
  for (const Experiment* e : others) {
    if (std::abs(e->sample_rate_hz - first.sample_rate_hz) > 1e-9 * first.sample_rate_hz) {
      return refused("record '" + e->name + "' has " + records::short_number(e->sample_rate_hz) + " samples a second, record '" +
                     first.name + "' " + records::short_number(first.sample_rate_hz) + "; allowed: the same");
    }
    if (e->input_unit != first.input_unit || e->output_unit != first.output_unit) {
      return refused("record '" + e->name + "' is in " + e->input_unit + " and " + e->output_unit + ", record '" + first.name +
                     "' in " + first.input_unit + " and " + first.output_unit + "; allowed: the same");
    }
  }
  if (data.select.checksum == data.test.checksum) return refused("the records 'select' and 'test' hold the same samples");
  for (const Experiment& e : data.fit) {
    for (const Experiment* held : {&data.select, &data.test}) {
      if (e.checksum == held->checksum)
        return refused("the records '" + e.name + "' and '" + held->name +
                       "' hold the same samples; one of them must not be fitted");
    }
  }
  return {};
}

/// Best first: those that explain, then by what they gain.
void rank(std::vector<Candidate>& candidates) {
  std::stable_sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    if (a.explains != b.explains) return a.explains;
    return a.merit() > b.merit();
  });
}

/// What can't be told from the best candidate, and why the others are not the cause.
void compare_with_best(Trace& t) {
  const Candidate& best = t.candidates.front();
  t.equivalents = best.effect->equivalents();
  t.separation = best.effect->separation();
  const double limit = normal_limit(t.levels.p_candidate);
  for (std::size_t n = 1; n < t.candidates.size(); ++n) {
    Candidate& other = t.candidates[n];
    if (!other.explains) continue;
    const double z = distinction(best.with, other.with);
    if (z < limit) {
      t.equivalents.push_back(other.name);
      other.reason =
          "explains it as well as " + best.name + " does (" + records::short_number(z, 2) + " standard deviations apart)";
      if (t.separation.empty()) t.separation = "measure at one more level, and over a wider band";
    } else {
      other.reason = "explains less than " + best.name + ": " + records::short_number(z, 2) + " standard deviations apart";
    }
  }
}

Verdict verdict_of(const Trace& t) {
  if (t.found) return t.equivalents.empty() ? Verdict::named : Verdict::not_separable;
  const bool nothing = std::none_of(t.candidates.begin(), t.candidates.end(), [](const Candidate& c) { return c.accepted; });
  return nothing && t.base.smallest_p() > t.levels.p_class ? Verdict::none : Verdict::unexplained;
}

Eigen::VectorXcd predicted(const Fit& fit, const Experiment& e) { return fit.model.steady_state(e, fit.values); }

void measure_errors(const Experiment& test, Trace& t) {
  const Eigen::VectorXcd before = predicted(t.base.fit, test), after = predicted(t.extended().fit, test);
  t.residual_before = test.output - before;
  t.residual_after = test.output - after;
  t.before = held_out_error(test, before);
  t.after = held_out_error(test, after);
}

}  // namespace

const char* word(Verdict verdict) {
  switch (verdict) {
    case Verdict::none:
      return "none";
    case Verdict::named:
      return "named";
    case Verdict::not_separable:
      return "not_separable";
    case Verdict::unexplained:
      break;
  }
  return "unexplained";
}

Expected<Trace> trace(const BaseModel& base, const Catalogue& catalogue, const TraceData& data, const TraceSettings& settings) {
  if (auto sound = check(data); !sound) return tl::unexpected(sound.error());
  const auto starts = base.starts(data.fit);
  if (!starts) return tl::unexpected(starts.error());
  auto fitted = fit(JointModel{&base, {}}, data.fit, *starts);
  if (!fitted) return refused("the base model could not be fitted: " + fitted.error().text);
  Trace t;
  t.base = examine(std::move(*fitted), data.fit, data.select);
  t.levels = Levels::of(settings.alpha, settings.share, t.base.test_count(), catalogue.size());
  t.scales = base.scales(data.fit, t.base.fit.values);
  for (const auto& effect : catalogue)
    t.candidates.push_back(try_effect(*effect, t.base, *starts, t.scales, data.fit, data.select, t.levels));
  rank(t.candidates);
  if (!t.candidates.empty() && t.candidates.front().explains) {
    t.found = 0;
    t.candidates.front().reason = "added";
    compare_with_best(t);
  }
  t.verdict = verdict_of(t);
  measure_errors(data.test, t);
  if (t.found && t.after.leak()) t.verdict = Verdict::unexplained;
  return t;
}

}  // namespace bodeflow::residual
