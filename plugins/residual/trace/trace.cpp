#include "trace/trace.hpp"

#include <algorithm>
#include <cmath>

#include "records/signals.hpp"
#include "trace/final_fit.hpp"

namespace bodeflow::residual {
namespace {

Expected<void> check_alike(const MeasurementFacts& a, const MeasurementFacts& b) {
  if ((a.sample_rate_hz > 0.0) != (b.sample_rate_hz > 0.0))
    return refused("record '" + a.name + "' and record '" + b.name +
                   "' are a recording and a frequency response; allowed: all of one kind");
  if (std::abs(a.sample_rate_hz - b.sample_rate_hz) > 1e-9 * b.sample_rate_hz) {
    return refused("record '" + a.name + "' has " + records::short_number(a.sample_rate_hz) + " samples a second, record '" +
                   b.name + "' " + records::short_number(b.sample_rate_hz) + "; allowed: the same");
  }
  if (a.input_unit != b.input_unit || a.output_unit != b.output_unit) {
    return refused("record '" + a.name + "' is in " + a.input_unit + " and " + a.output_unit + ", record '" + b.name + "' in " +
                   b.input_unit + " and " + b.output_unit + "; allowed: the same");
  }
  return {};
}

Expected<void> check(const TraceData& data) {
  if (data.fit.empty()) return refused("no record to fit");
  Measurements held = {data.select, data.test};
  Measurements all = data.fit;
  all.insert(all.end(), held.begin(), held.end());
  for (const auto& m : all) {
    if (auto alike = check_alike(m->facts(), data.fit.front()->facts()); !alike) return alike;
    if (m->floor_known() != data.fit.front()->floor_known())
      return refused("the noise of record '" + m->facts().name + "' is " + (m->floor_known() ? "known" : "not known") +
                     ", unlike that of record '" + data.fit.front()->facts().name + "'; allowed: of all, or of none");
  }
  if (data.select->facts().checksum == data.test->facts().checksum)
    return refused("the records 'select' and 'test' hold the same samples");
  for (std::size_t n = 0; n < data.fit.size(); ++n) {
    for (std::size_t before = 0; before < n; ++before) {
      if (data.fit[before]->facts().checksum == data.fit[n]->facts().checksum)
        return refused("the records '" + data.fit[before]->facts().name + "' and '" + data.fit[n]->facts().name +
                       "' hold the same samples; fitted twice they would seem to say more than they do");
    }
  }
  for (const auto& fitted : data.fit) {
    for (const auto& h : held) {
      if (fitted->facts().checksum == h->facts().checksum)
        return refused("the records '" + fitted->facts().name + "' and '" + h->facts().name +
                       "' hold the same samples; one of them must not be fitted");
    }
  }
  return {};
}

/// Parameters to set out from, for the first record that says something about them.
std::vector<Eigen::VectorXd> starts_of(const BaseModel& base, const Measurements& records) {
  std::vector<MeasuredResponse> measured;
  for (const auto& r : records) {
    for (MeasuredResponse& m : r->response()) measured.push_back(std::move(m));
  }
  std::vector<Eigen::VectorXd> starts;
  for (const std::vector<double>& s : base.starts(measured))
    starts.push_back(Eigen::Map<const Eigen::VectorXd>(s.data(), static_cast<Eigen::Index>(s.size())));
  return starts;
}

/// Adds the equivalents that effects declare, where the base has a place for them.
void declare_equivalents(const BaseModel& base, const std::vector<EffectDescription>& known, Searched& s) {
  const std::vector<Place> places = base.places();
  const auto possible = [&](const EffectDescription& what) {
    if (what.acts != Acts::law && what.acts != Acts::immittance) return true;
    return std::any_of(places.begin(), places.end(), [&](const Place& p) {
      return std::find(what.kinds.begin(), what.kinds.end(), p.kind) != what.kinds.end();
    });
  };
  for (Found& f : s.found) {
    for (const std::string& name : f.addition.what.equivalents) {
      const auto what = std::find_if(known.begin(), known.end(), [&](const auto& k) { return k.name() == name; });
      if (what == known.end() || !possible(*what)) continue;
      const bool there = std::any_of(f.equivalents.begin(), f.equivalents.end(),
                                     [&](const std::string& e) { return e == name || e.rfind(name + " at ", 0) == 0; });
      if (!there) f.equivalents.push_back(name);
      f.separation = f.addition.what.separation;
    }
  }
}

Verdict verdict_of(const Trace& t) {
  const Searched& s = t.searched;
  if (s.found.empty()) return s.base.smallest_p() > s.levels.p_class() ? Verdict::none : Verdict::unexplained;
  if (t.floor_known && !s.explains) return Verdict::unexplained;
  const bool twins = std::any_of(s.found.begin(), s.found.end(), [](const Found& f) { return !f.equivalents.empty(); });
  return twins ? Verdict::not_separable : Verdict::named;
}

/// Two families of tests, each priced by how many it has (Sidak).
double overall_p(const Searched& s) {
  const auto of_any = [](double least, std::size_t count) {
    return least < 1.0 ? -std::expm1(static_cast<double>(count) * std::log1p(-least)) : 1.0;
  };
  double least = 1.0;
  std::size_t count = 0;
  if (!s.steps.empty()) {
    count = s.steps.front().candidates.size();
    for (const Candidate& c : s.steps.front().candidates) least = std::min(least, c.p);
  }
  const double of_classes = of_any(s.base.smallest_p(), s.base.test_count());
  return count == 0 ? of_classes : of_any(std::min(of_classes, of_any(least, count)), 2);
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

Expected<Trace> trace(std::shared_ptr<const BaseModel> base, const Catalogue& catalogue, const TraceData& data,
                      const TraceSettings& settings) {
  if (auto sound = check(data); !sound) return tl::unexpected(sound.error());
  const std::vector<Eigen::VectorXd> starts = starts_of(*base, data.fit);
  const Bench bench{data.fit, data.select};
  auto searched = search(JointModel{base, {}}, starts, catalogue, bench, settings);
  if (!searched) return tl::unexpected(searched.error());
  Trace t;
  t.searched = std::move(*searched);
  t.floor_known = data.select->floor_known();
  declare_equivalents(*base, settings.known, t.searched);
  t.verdict = verdict_of(t);
  if (t.added()) t.searched.best.fit = final_fit(t.searched.best.fit, data.fit);
  t.p = overall_p(t.searched);
  auto before = hold_out(t.searched.base.fit, *data.test);
  if (!before) return tl::unexpected(before.error());
  t.test_before = std::move(*before);
  t.before = data.test->error(t.test_before.residual);
  auto after = hold_out(t.extended().fit, *data.test);
  if (!after) return tl::unexpected(after.error());
  t.test_after = std::move(*after);
  t.after = data.test->error(t.test_after.residual);
  if (t.added() && (t.after.leak() || !(t.after.error < t.before.error))) t.verdict = Verdict::unexplained;
  t.classes_before = held_out_tests(t.searched.base.fit, t.test_before, *data.test);
  t.classes_after = t.added() ? held_out_tests(t.extended().fit, t.test_after, *data.test) : t.classes_before;
  return t;
}

}  // namespace bodeflow::residual
