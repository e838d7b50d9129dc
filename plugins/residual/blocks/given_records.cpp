#include "blocks/given_records.hpp"

#include <algorithm>
#include <bodeflow/declarations.hpp>
#include <bodeflow/units.hpp>
#include <cmath>
#include <map>

#include "periodic/periodic_measurement.hpp"
#include "records/response_units.hpp"
#include "response/hold_out_bands.hpp"
#include "response/response_measurement.hpp"
#include "sampled/sampled_measurement.hpp"

namespace bodeflow::residual {
namespace {

using records::Recording;
using records::ResponseData;

constexpr Eigen::Index kLeastPeriods = 2;
constexpr Eigen::Index kLeastSamples = 200;
// Samples of a record over time that is fitted or selects: spectra of more take minutes.
constexpr Eigen::Index kLongest = 131072;
constexpr double kBandOctaves = 1.0 / 3.0;
// Rows of a record over time that is fitted or selects: more take time and change no verdict, as what is not modelled outweighs
// the noise by far there. The one that tells the error is taken whole.
constexpr Eigen::Index kMostRows = 12288;

bool repeats(const Given& g) {
  const auto* r = std::get_if<Recording>(&g);
  return r == nullptr || (r->period > 0 && r->periods >= kLeastPeriods);
}

Recording part_of(const Recording& r, Eigen::Index first, Eigen::Index count, std::int64_t periods) {
  Recording p = r;
  p.input = r.input.middleRows(first, count);
  p.output = r.output.middleRows(first, count);
  p.skip = 0;
  p.periods = periods;
  if (periods == 0) p.period = 0;
  return p;
}

/// Parts of a periodic recording: select and test get a quarter of the periods each.
Expected<std::vector<Recording>> split_periods(const Recording& r, std::size_t parts) {
  const Eigen::Index others = static_cast<Eigen::Index>(parts) - 1;
  const Eigen::Index own = std::max<Eigen::Index>(kLeastPeriods, r.periods / 4), rest = r.periods - others * own;
  if (rest < kLeastPeriods) {
    return refused("the recording has " + records::counted(r.periods, "period") +
                   ", allowed: " + std::to_string(kLeastPeriods * (others + 1)) +
                   " or more where it is split; give records of their own at 'select' and 'test'");
  }
  std::vector<Recording> all;
  Eigen::Index at = r.skip;
  for (Eigen::Index n = 0; n <= others; ++n) {
    const Eigen::Index count = n == 0 ? rest : own;
    all.push_back(part_of(r, at * r.period, count * r.period, count));
    at += count;
  }
  return all;
}

/// The middle of a record that is longer than it need be.
void shorten(Given& g, const std::string& name, std::vector<std::string>& notes) {
  const auto* r = std::get_if<Recording>(&g);
  if (r == nullptr || r->samples() <= kLongest) return;
  notes.push_back("record '" + name + "' has " + std::to_string(r->samples()) + " samples, of which the " +
                  std::to_string(kLongest) + " in its middle are looked at");
  g = part_of(*r, (r->samples() - kLongest) / 2, kLongest, 0);
}

Expected<std::vector<Recording>> split_time(const Recording& r, std::size_t parts) {
  const auto first = static_cast<Eigen::Index>(r.skip * r.period), count = r.samples() - first;
  if (count < static_cast<Eigen::Index>(parts) * kLeastSamples) {
    return refused("the recording has " + records::counted(count, "sample") +
                   ", allowed: " + std::to_string(static_cast<Eigen::Index>(parts) * kLeastSamples) +
                   " or more where it is split; give records of their own at 'select' and 'test'");
  }
  const Eigen::Index quarter = count / 4, others = static_cast<Eigen::Index>(parts) - 1;
  std::vector<Recording> all = {part_of(r, first, count - others * quarter, 0)};
  for (Eigen::Index n = others; n > 0; --n) all.push_back(part_of(r, r.samples() - n * quarter, quarter, 0));
  return all;
}

/// Parts of a response: every fourth band of a third of an octave, and where two are wanted every third of the others.
Expected<std::vector<ResponseData>> split_bands(const ResponseData& r, std::size_t parts) {
  std::vector<ResponseData> all = {r};
  for (int every = 4; all.size() < parts; --every) {
    auto pieces = hold_out_bands(all.front(), kBandOctaves, every);
    if (!pieces) return tl::unexpected(pieces.error());
    all.front() = std::move(pieces->kept);
    all.push_back(std::move(pieces->held_out));
  }
  return all;
}

Expected<std::vector<Given>> split(const Given& g, std::size_t parts, Engine engine) {
  const auto as_given = [](auto pieces) -> Expected<std::vector<Given>> {
    if (!pieces) return tl::unexpected(pieces.error());
    return std::vector<Given>(pieces->begin(), pieces->end());
  };
  if (const auto* response = std::get_if<ResponseData>(&g)) return as_given(split_bands(*response, parts));
  const Recording& r = std::get<Recording>(g);
  return as_given(engine == Engine::periodic ? split_periods(r, parts) : split_time(r, parts));
}

std::string how(const Given& g, Engine engine) {
  if (std::holds_alternative<ResponseData>(g)) return "some bands of a third of an octave";
  return engine == Engine::periodic ? "a quarter of the periods at its end" : "a quarter of the samples at its end";
}

/// Values of `known` for each record, by its name.
class Known {
 public:
  Known(const BaseModel& base, const std::vector<std::string>& statements) : names_(base.known()) {
    for (const FitParameter& k : names_) {
      ParameterDraft draft;
      draft.type = parameter_type<double>();
      draft.name = k.name;
      draft.unit = k.unit;
      draft.fallback = stored_value(0.0);
      drafts_.push_back(std::move(draft));
    }
    for (const std::string& s : statements) {
      const std::size_t colon = s.find(':');
      if (colon == std::string::npos) fail("known: '" + s + "' has not the form record: name=value");
      of_record_[s.substr(0, colon)].push_back(s.substr(colon + 1));
    }
  }

  std::vector<double> of(const std::string& record) {
    used_.push_back(record);
    const auto found = of_record_.find(record);
    std::vector<double> values;
    for (const StoredValue& v : declared_values(drafts_, found == of_record_.end() ? std::vector<std::string>{} : found->second,
                                                "known of '" + record + "'"))
      values.push_back(v.numbers.at(0));
    return values;
  }

  void check_all_used() const {
    for (const auto& [record, statements] : of_record_) {
      if (std::find(used_.begin(), used_.end(), record) != used_.end()) continue;
      std::string names;
      for (const std::string& u : used_) names += (names.empty() ? "" : ", ") + u;
      fail("known: there is no record '" + record + "'; there are: " + names);
    }
  }

 private:
  std::vector<FitParameter> names_;
  std::vector<ParameterDraft> drafts_;
  std::map<std::string, std::vector<std::string>> of_record_;
  std::vector<std::string> used_;
};

/// Why a recording is of something else than the base model; "" where it is not, or units are not given.
std::string wrong_units(const Recording& r, const BaseModel& base) {
  const std::string needed = base.response_unit(), &in = r.input_signals.units[0], &out = r.output_signals.units[0];
  for (const std::string& unit : {needed, in, out})
    if (unit.empty() || unit == "1" || !parse_unit(unit)) return "";
  const std::string ratio = records::ratio_unit(out, in);
  if (!parse_unit(ratio) || same_dimension(ratio, needed)) return "";
  return "'" + r.output_signals.names[0] + "' is in " + out + " and '" + r.input_signals.names[0] + "' in " + in +
         "; the base model needs output over input in " + needed + ": check the signals and what is declared";
}

Expected<std::shared_ptr<const Measurement>> measurement_of(const Given& g, const std::string& name, Engine engine,
                                                            const BaseModel& base, Known& known, const SampledOptions& options) {
  auto made = [&]() -> Expected<std::shared_ptr<const Measurement>> {
    if (const auto* response = std::get_if<ResponseData>(&g)) return response_measurement(*response, name, known.of(name), base);
    const Recording& r = std::get<Recording>(g);
    if (const std::string wrong = wrong_units(r, base); !wrong.empty()) return refused(wrong);
    if (engine == Engine::periodic) return periodic_measurement(r, name, known.of(name), base);
    return sampled_measurement(r, name, known.of(name), base, options);
  }();
  if (!made) return refused("record '" + name + "': " + made.error().text);
  return made;
}

GivenRecords with_short_records(GivenRecords g, Engine engine) {
  if (engine != Engine::sampled) return g;
  for (std::size_t n = 0; n < g.fit.size(); ++n) shorten(g.fit[n], "fit " + std::to_string(n + 1), g.notes);
  shorten(*g.select, "select", g.notes);
  return g;
}

}  // namespace

Engine engine_for(const GivenRecords& g, Engine wished) {
  if (wished != Engine::automatic) return wished;
  bool all = std::all_of(g.fit.begin(), g.fit.end(), repeats);
  for (const auto* one : {&g.select, &g.test}) all = all && (!one->has_value() || repeats(**one));
  return all ? Engine::periodic : Engine::sampled;
}

Expected<GivenRecords> with_all_parts(GivenRecords g, Engine engine) {
  if (g.fit.empty()) return refused("no record arrived at 'fit'");
  for (auto [part, name] : {std::pair{&g.test, "test"}, std::pair{&g.select, "select"}}) {
    if (part->has_value() || g.fit.size() < 3) continue;
    *part = std::move(g.fit.back());
    g.fit.pop_back();
    g.notes.push_back("record 'fit " + std::to_string(g.fit.size() + 1) + "' is not fitted but serves as '" + name + "'");
  }
  const std::size_t parts = 1 + (g.select ? 0 : 1) + (g.test ? 0 : 1);
  if (parts == 1) return with_short_records(std::move(g), engine);
  auto pieces = split(g.fit.back(), parts, engine);
  if (!pieces) return refused("record 'fit " + std::to_string(g.fit.size()) + "': " + pieces.error().text);
  const std::string taken = how(g.fit.back(), engine),
                    from = "' is " + taken + " of record 'fit " + std::to_string(g.fit.size()) + "'";
  g.fit.back() = std::move((*pieces)[0]);
  std::size_t next = 1;
  for (auto [part, name] : {std::pair{&g.select, "select"}, std::pair{&g.test, "test"}}) {
    if (part->has_value()) continue;
    *part = std::move((*pieces)[next++]);
    g.notes.push_back("record '" + std::string(name) + from);
  }
  return with_short_records(std::move(g), engine);
}

Expected<TraceData> measurements_of(const GivenRecords& g, Engine engine, const BaseModel& base,
                                    const std::vector<std::string>& statements, double segment_s, double test_segment_s) {
  Known known(base, statements);
  TraceData data;
  for (std::size_t n = 0; n < g.fit.size(); ++n) {
    auto m = measurement_of(g.fit[n], "fit " + std::to_string(n + 1), engine, base, known, {segment_s, kMostRows});
    if (!m) return tl::unexpected(m.error());
    data.fit.push_back(std::move(*m));
  }
  auto select = measurement_of(*g.select, "select", engine, base, known, {segment_s, kMostRows});
  if (!select) return tl::unexpected(select.error());
  auto test = measurement_of(*g.test, "test", engine, base, known, {test_segment_s, 0});
  if (!test) return tl::unexpected(test.error());
  data.select = std::move(*select);
  data.test = std::move(*test);
  known.check_all_used();
  return data;
}

}  // namespace bodeflow::residual
