#include "trace/trace_record.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "records/record_arrays.hpp"
#include "trace/record_views.hpp"
#include "trace/words.hpp"

namespace bodeflow::residual {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

std::string place_of(const Addition& a) { return a.place == Addition::kNoPlace ? "" : a.situation.place.name; }

Eigen::VectorXd list(const std::vector<double>& v) {
  return Eigen::Map<const Eigen::VectorXd>(v.data(), static_cast<Eigen::Index>(v.size()));
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& w : words) text += (text.empty() ? "" : ", ") + w;
  return text;
}

void put_verdict(RecordBuilder& r, const Trace& t, const std::string& unit) {
  std::vector<std::string> effects, places, labels, equivalents, of_each, partial;
  std::vector<double> shares;
  for (const Found& f : t.searched.found) {
    if (!t.added()) {
      partial.push_back(f.addition.label);
      continue;
    }
    effects.push_back(f.addition.name());
    places.push_back(place_of(f.addition));
    labels.push_back(f.addition.label);
    of_each.push_back(joined(f.equivalents));
    equivalents.insert(equivalents.end(), f.equivalents.begin(), f.equivalents.end());
    shares.push_back(f.share);
  }
  r.set("verdict", word(t.verdict)).set("finding", finding(t, unit));
  r.set("effects", effects).set("effect_places", places).set("effect_labels", labels);
  r.set("equivalents", equivalents).set("effect_equivalents", of_each);
  r.set("partial_effects", partial).set("partial_share", t.added() ? 0.0 : t.searched.share);
  r.set("unit", unit).set("floor_known", t.floor_known).set("p", t.p);
  r.set("error_before", t.before.error).set("error_after", t.after.error).set("error_remedied", kNone);
  r.set("noise_floor", t.before.floor).set("noise_floor_99.9", t.floor_known ? t.before.highest : kNone);
  r.set("noise_floor_0.01", t.floor_known ? (t.added() ? t.after : t.before).lowest : kNone);
  r.set("excess_before", t.before.excess()).set("excess_after", t.after.excess());
  r.set("at_floor", t.floor_known && t.after.at_floor()).set("leak", t.after.leak());
  r.set("share_explained", t.added() ? t.searched.share : 0.0);
  r.set("warnings", warnings(t));
  records::put_list<double>(r, "effect_shares", "1", list(shares));
}

void put_effects(RecordBuilder& r, const Trace& t, std::size_t records) {
  std::vector<std::string> names, units;
  std::vector<std::int64_t> counts;
  std::vector<double> values, std;
  const Fit& f = t.extended().fit;
  for (std::size_t a = 0; a < f.model.additions.size(); ++a) {
    const Addition& added = f.model.additions[a];
    const Eigen::VectorXd all = f.values(), deviations = f.std();
    for (std::size_t p = 0; p < added.parameters.size(); ++p) {
      const Eigen::Index at = f.model.begin_of(a) + static_cast<Eigen::Index>(p);
      names.push_back(added.parameters[p].name);
      units.push_back(added.parameters[p].unit);
      values.push_back(all[at]);
      std.push_back(deviations[at]);
    }
    counts.push_back(static_cast<std::int64_t>(added.parameters.size()));
  }
  r.set("effect_parameter_names", names).set("effect_parameter_units", units).set("effect_parameter_counts", counts);
  records::put_list<double>(r, "effect_parameters", "", list(values));
  records::put_list<double>(r, "effect_parameter_std", "", list(std));
  const auto own = static_cast<Eigen::Index>(values.size());
  Eigen::MatrixXd by_record(static_cast<Eigen::Index>(records), own);
  for (std::size_t n = 0; n < records; ++n) by_record.row(static_cast<Eigen::Index>(n)) = f.values(n).tail(own).transpose();
  records::put_matrix(r, "effect_parameters_by_record", "", by_record);
}

void put_base(RecordBuilder& r, const Trace& t, const Declared& declared) {
  const Fit& before = t.searched.base.fit;
  const Fit& after = t.extended().fit;
  std::vector<std::string> names, units;
  for (const FitParameter& p : before.model.base->parameters()) {
    names.push_back(p.name);
    units.push_back(p.unit);
  }
  const auto count = static_cast<Eigen::Index>(names.size());
  r.set("base", declared.base).set("declarations", declared.declarations).set("conventions", before.model.base->conventions());
  r.set("parameter_names", names).set("parameter_units", units);
  records::put_list<double>(r, "parameters_before", "", before.values().head(count));
  records::put_list<double>(r, "parameters_before_std", "", before.std().head(count));
  records::put_list<double>(r, "parameters_after", "", after.values().head(count));
  records::put_list<double>(r, "parameters_after_std", "", after.std().head(count));
}

void put_tests(RecordBuilder& r, const char* multiple_name, const char* p_name, const std::vector<RecordTests>& tests,
               const std::vector<std::string>& classes) {
  const auto fill = [&](const char* name, double ClassTest::*member) {
    const auto data = r.array<double>(name, "1", {tests.size(), classes.size()});
    std::fill(data.begin(), data.end(), kNone);
    for (std::size_t i = 0; i < tests.size(); ++i)
      for (const ClassTest& test : tests[i].classes)
        for (std::size_t c = 0; c < classes.size(); ++c)
          if (classes[c] == test.name) data[i * classes.size() + c] = test.*member;
  };
  fill(multiple_name, &ClassTest::multiple);
  fill(p_name, &ClassTest::p);
}

void put_one(RecordBuilder& r, const char* name, const std::vector<ClassTest>& tests, double ClassTest::*member,
             const std::vector<std::string>& classes) {
  const auto data = r.array<double>(name, "1", {classes.size()});
  for (std::size_t c = 0; c < classes.size(); ++c) {
    const auto test = std::find_if(tests.begin(), tests.end(), [&](const ClassTest& x) { return x.name == classes[c]; });
    data[c] = test == tests.end() ? kNone : (*test).*member;
  }
}

std::vector<std::string> put_classes(RecordBuilder& r, const Trace& t) {
  std::vector<std::string> classes, record_names;
  for (const RecordTests& record : t.searched.base.tests) {
    record_names.push_back(record.record);
    for (const ClassTest& c : record.classes)
      if (std::find(classes.begin(), classes.end(), c.name) == classes.end()) classes.push_back(c.name);
  }
  r.set("class_names", classes).set("class_records", record_names).set("class_p_limit", t.searched.levels.p_class());
  put_tests(r, "class_before", "class_p_before", t.searched.base.tests, classes);
  put_tests(r, "class_after", "class_p_after", t.extended().tests, classes);
  put_one(r, "test_class_before", t.classes_before, &ClassTest::multiple, classes);
  put_one(r, "test_class_p_before", t.classes_before, &ClassTest::p, classes);
  put_one(r, "test_class_after", t.classes_after, &ClassTest::multiple, classes);
  put_one(r, "test_class_p_after", t.classes_after, &ClassTest::p, classes);
  return classes;
}

void put_candidates(RecordBuilder& r, const Trace& t) {
  std::vector<std::string> names, effects, reasons, refused, refusals;
  std::vector<std::int64_t> steps;
  std::vector<double> fit_gain, p, trials, select_gain, select_p, share, limits;
  for (std::size_t s = 0; s < t.searched.steps.size(); ++s) {
    limits.push_back(t.searched.steps[s].levels.p_candidate());
    for (const Candidate& c : t.searched.steps[s].candidates) {
      names.push_back(c.label);
      effects.push_back(c.addition.name());
      reasons.push_back(c.reason);
      steps.push_back(static_cast<std::int64_t>(s) + 1);
      fit_gain.push_back(c.fit_gain);
      p.push_back(c.p);
      trials.push_back(c.null.trials);
      select_gain.push_back(c.select_gain.likelihood);
      select_p.push_back(c.select_p);
      share.push_back(c.share);
    }
  }
  for (const Bound& b : t.searched.refused) {
    refused.push_back(b.addition.label);
    refusals.push_back(b.refusal);
  }
  r.set("candidate_names", names).set("candidate_effects", effects).set("candidate_reasons", reasons);
  r.set("candidate_steps", steps).set("candidate_p_limit", t.searched.levels.p_candidate());
  r.set("candidate_p_limits", limits).set("dropped", t.searched.dropped);
  r.set("not_tried", refused).set("not_tried_reasons", refusals);
  records::put_list<double>(r, "candidate_fit_gain", "1", list(fit_gain));
  records::put_list<double>(r, "candidate_p", "1", list(p));
  records::put_list<double>(r, "candidate_trials", "1", list(trials));
  records::put_list<double>(r, "candidate_select_gain", "1", list(select_gain));
  records::put_list<double>(r, "candidate_select_p", "1", list(select_p));
  records::put_list<double>(r, "candidate_share", "1", list(share));
}

void put_records(RecordBuilder& r, const TraceData& data, const Declared& declared) {
  Measurements all = data.fit;
  all.push_back(data.select);
  all.push_back(data.test);
  std::vector<std::string> names, checksums, observations;
  std::vector<double> levels;
  std::vector<std::int64_t> samples;
  for (const auto& m : all) {
    names.push_back(m->facts().name);
    checksums.push_back(m->facts().checksum);
    levels.push_back(m->facts().level);
    samples.push_back(m->facts().samples);
    for (const std::string& o : m->observations()) observations.push_back(m->facts().name + ": " + o);
  }
  const MeasurementFacts& first = data.test->facts();
  r.set("input_name", first.input_name).set("output_name", first.output_name).set("periods", first.periods);
  r.set("records", names).set("record_checksums", checksums).set("record_samples", samples);
  r.set("record_notes", declared.notes).set("observations", observations);
  records::put_list<double>(r, "record_levels", first.input_unit, list(levels));
}

/// Root mean square values of the lines of the test record, or its course in time.
void put_pictures(RecordBuilder& r, const Trace& t, const Measurement& test) {
  const ResidualPicture before = test.picture(t.test_before.residual), after = test.picture(t.test_after.residual);
  const std::string unit = test.facts().output_unit;
  records::put_list<double>(r, before.axis.c_str(), before.axis == "time" ? "s" : "Hz", before.at);
  records::put_list<double>(r, "residual_before", unit, before.residual);
  records::put_list<double>(r, "residual_after", unit, after.residual);
  if (before.noise.size() == before.at.size()) records::put_list<double>(r, "residual_noise", unit, before.noise);
  records::put_list<double>(r, "measured", unit, before.measured);
  if (before.kind.empty()) return;
  const auto kind = r.array<std::int64_t>("kind", "", {before.kind.size()});
  std::copy(before.kind.begin(), before.kind.end(), kind.begin());
}

}  // namespace

RecordBuilder write_trace(const Trace& t, const TraceData& data, const Declared& declared) {
  RecordBuilder r("trace");
  put_verdict(r, t, data.test->facts().unit_of_error());
  put_effects(r, t, data.fit.size());
  put_base(r, t, declared);
  put_sizes(r, t, data, put_classes(r, t));
  put_candidates(r, t);
  r.set("advice", advice(t, data)).set("remarks", data.test->remarks(t.test_after.residual));
  put_records(r, data, declared);
  put_pictures(r, t, *data.test);
  put_views(r, t, *data.test);
  return r;
}

}  // namespace bodeflow::residual
