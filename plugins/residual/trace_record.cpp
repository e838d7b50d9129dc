#include "trace_record.hpp"

#include <cmath>
#include <limits>

#include "records/record_arrays.hpp"
#include "trace_words.hpp"

namespace bodeflow::residual {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// One value a candidate.
template <class Value>
void put_candidates(RecordBuilder& record, const char* name, const Trace& t, Value value) {
  const auto data = record.array<double>(name, "1", {t.candidates.size()});
  for (std::size_t n = 0; n < t.candidates.size(); ++n) data[n] = value(t.candidates[n]);
}

void put_verdict(RecordBuilder& r, const Trace& t, const std::string& unit) {
  const bool named = t.verdict == Verdict::named || t.verdict == Verdict::not_separable;
  r.set("verdict", word(t.verdict));
  r.set("finding", finding(t, unit));
  r.set("effects", named ? std::vector<std::string>{t.candidates[*t.found].name} : std::vector<std::string>{});
  r.set("equivalents", named ? t.equivalents : std::vector<std::string>{});
  r.set("unit", unit);
  r.set("error_before", t.before.error);
  r.set("error_after", t.after.error);
  r.set("error_remedied", kNone);
  r.set("noise_floor", t.before.floor);
  r.set("noise_floor_99.9", t.before.highest);
  r.set("excess_before", t.before.excess());
  r.set("excess_after", t.after.excess());
  r.set("at_floor", t.after.at_floor());
  r.set("leak", t.after.leak());
  r.set("share_explained", t.found ? t.candidates[*t.found].share : 0.0);
  r.set("warnings", warnings(t));
}

void put_effect(RecordBuilder& r, const Trace& t) {
  std::vector<std::string> names, units;
  Eigen::VectorXd values(0), std(0);
  if (t.verdict == Verdict::named || t.verdict == Verdict::not_separable) {
    const Candidate& c = t.candidates[*t.found];
    for (const Parameter& p : c.effect->parameters()) {
      names.push_back(p.name);
      units.push_back(p.unit);
    }
    values = c.with.fit.values.tail(static_cast<Eigen::Index>(names.size()));
    std = c.with.fit.std.tail(static_cast<Eigen::Index>(names.size()));
  }
  r.set("effect_parameter_names", names);
  r.set("effect_parameter_units", units);
  records::put_list<double>(r, "effect_parameters", "", values);
  records::put_list<double>(r, "effect_parameter_std", "", std);
}

void put_base(RecordBuilder& r, const Trace& t, const BaseModel& base) {
  std::vector<std::string> names, units;
  for (const Parameter& p : base.parameters()) {
    names.push_back(p.name);
    units.push_back(p.unit);
  }
  const auto count = static_cast<Eigen::Index>(names.size());
  r.set("base", base.name());
  r.set("conventions", base.conventions());
  r.set("parameter_names", names);
  r.set("parameter_units", units);
  records::put_list<double>(r, "parameters_before", "", t.base.fit.values.head(count));
  records::put_list<double>(r, "parameters_before_std", "", t.base.fit.std.head(count));
  records::put_list<double>(r, "parameters_after", "", t.extended().fit.values.head(count));
  records::put_list<double>(r, "parameters_after_std", "", t.extended().fit.std.head(count));
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

void put_classes(RecordBuilder& r, const Trace& t) {
  const std::vector<std::string> classes = {"excited", "odd", "even", "dc", "skirts", "peak"};
  std::vector<std::string> record_names;
  for (const RecordTests& record : t.base.tests) record_names.push_back(record.record);
  r.set("class_names", classes);
  r.set("class_records", record_names);
  r.set("class_p_limit", t.levels.p_class);
  put_tests(r, "class_before", "class_p_before", t.base.tests, classes);
  put_tests(r, "class_after", "class_p_after", t.extended().tests, classes);
}

void put_all_candidates(RecordBuilder& r, const Trace& t) {
  std::vector<std::string> names, reasons;
  for (const Candidate& c : t.candidates) {
    names.push_back(c.name);
    reasons.push_back(c.reason);
  }
  r.set("candidate_names", names);
  r.set("candidate_reasons", reasons);
  r.set("candidate_p_limit", t.levels.p_candidate);
  r.set("candidate_select_limit", t.levels.select_gain);
  put_candidates(r, "candidate_fit_gain", t, [](const Candidate& c) { return c.fit_gain; });
  put_candidates(r, "candidate_p", t, [](const Candidate& c) { return c.p; });
  put_candidates(r, "candidate_select_gain", t, [](const Candidate& c) { return c.select_gain; });
  put_candidates(r, "candidate_share", t, [](const Candidate& c) { return c.share; });
}

/// Root mean square values of the lines of the test record: sqrt(2) |Y|.
void put_spectra(RecordBuilder& r, const Trace& t, const Experiment& e) {
  const double rms = std::sqrt(2.0);
  records::put_list<double>(r, "frequency", "Hz", e.frequency_hz);
  records::put_list<double>(r, "residual_before", e.output_unit, rms * t.residual_before.cwiseAbs());
  records::put_list<double>(r, "residual_after", e.output_unit, rms * t.residual_after.cwiseAbs());
  records::put_list<double>(r, "residual_noise", e.output_unit, rms * e.variance.cwiseSqrt());
  records::put_list<double>(r, "measured", e.output_unit, rms * e.output.cwiseAbs());
  const auto kind = r.array<std::int64_t>("kind", "", {e.kind.size()});
  for (std::size_t k = 0; k < e.kind.size(); ++k) kind[k] = static_cast<std::int64_t>(e.kind[k]);
}

}  // namespace

RecordBuilder write_trace(const Trace& t, const TraceData& data, const BaseModel& base) {
  const Experiment& e = data.test;
  RecordBuilder r("trace");
  put_verdict(r, t, e.output_unit);
  put_effect(r, t);
  put_base(r, t, base);
  put_classes(r, t);
  put_all_candidates(r, t);
  r.set("input_name", e.input_name);
  r.set("output_name", e.output_name);
  r.set("periods", e.periods);
  r.set("noise_std", std::sqrt(e.floor.at(e.frequency_hz).mean() * static_cast<double>(e.period * e.periods)));
  std::vector<double> levels;
  std::vector<std::string> names, checksums;
  std::vector<const Experiment*> all;
  for (const Experiment& x : data.fit) all.push_back(&x);
  all.push_back(&data.select);
  all.push_back(&data.test);
  for (const Experiment* x : all) {
    names.push_back(x->name);
    checksums.push_back(x->checksum);
    levels.push_back(std::sqrt(x->input.squaredNorm() / static_cast<double>(x->period)));
  }
  r.set("records", names);
  r.set("record_checksums", checksums);
  records::put_list<double>(r, "record_levels", e.input_unit,
                            Eigen::Map<Eigen::VectorXd>(levels.data(), static_cast<Eigen::Index>(levels.size())));
  put_spectra(r, t, e);
  return r;
}

}  // namespace bodeflow::residual
