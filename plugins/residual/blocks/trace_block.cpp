#include "blocks/trace_block.hpp"

#include <algorithm>
#include <bodeflow/parts.hpp>

#include "records/record_copy.hpp"
#include "trace/fitted_model.hpp"
#include "trace/trace_record.hpp"
#include "trace/words.hpp"

namespace bodeflow::residual {
namespace {

template <class T>
T valid(Expected<T> result) {
  if (!result) fail(result.error().text);
  return std::move(*result);
}

std::string with_family(const std::string& id) { return id.find('.') == std::string::npos ? "residual." + id : id; }

Given read(const RecordView& record, const std::string& name) {
  if (record.type() == "frequency_response") {
    auto response = records::read_response(record);
    if (!response) fail("record '" + name + "': " + response.error().text);
    return std::move(*response);
  }
  auto recording = records::read_recording(record);
  if (!recording) fail("record '" + name + "': " + recording.error().text);
  return std::move(*recording);
}

std::shared_ptr<const BaseModel> base_model(const Parts& parts, const std::string& id, const std::vector<std::string>& declared,
                                            const std::optional<RecordBuilder>& model) {
  if (!model) return parts.base_model(id, declared);
  struct alignas(64) Line {
    std::uint8_t bytes[64];
  };
  std::vector<Line> memory(static_cast<std::size_t>(model->size()) / sizeof(Line));
  model->write(memory.data());
  const auto view = RecordView::check({memory.front().bytes, static_cast<std::size_t>(model->size())});
  if (!view) fail("record 'model': " + view.error().text);
  return parts.base_model(id, declared, *view);
}

/// Effects among the parts of the host by name or id.
class Choice {
 public:
  explicit Choice(const Parts& parts) : parts_(parts), all_(parts.effects()) {}

  const std::vector<EffectDescription>& all() const { return all_; }

  /// Those of `names` (all where it is empty) that are not in `left_out`.
  Catalogue catalogue(const std::vector<std::string>& names, const std::vector<std::string>& left_out) const {
    std::vector<std::size_t> chosen, dropped;
    for (const std::string& name : names) chosen.push_back(find(name));
    for (const std::string& name : left_out) dropped.push_back(find(name));
    if (names.empty())
      for (std::size_t n = 0; n < all_.size(); ++n) chosen.push_back(n);
    Catalogue catalogue;
    for (std::size_t n = 0; n < chosen.size(); ++n) {
      const EffectDescription& what = all_[chosen[n]];
      if (std::find(chosen.begin(), chosen.begin() + static_cast<std::ptrdiff_t>(n), chosen[n]) !=
          chosen.begin() + static_cast<std::ptrdiff_t>(n))
        fail("effect '" + what.name() + "' is named twice");
      if (std::find(dropped.begin(), dropped.end(), chosen[n]) != dropped.end()) continue;
      catalogue.push_back({what, parts_.effect(what.id)});
    }
    if (catalogue.empty() && !all_.empty()) fail("`effects` and `without` leave no effect to try");
    return catalogue;
  }

 private:
  std::size_t find(const std::string& name) const {
    std::vector<std::string> names;
    for (std::size_t n = 0; n < all_.size(); ++n) {
      if (all_[n].name() == name || all_[n].id == name) return n;
      names.push_back(all_[n].name());
    }
    fail("effect '" + name + "' is not known" + detail::meant(name, names) + "; there are: " + detail::listed(names));
  }

  const Parts& parts_;
  std::vector<EffectDescription> all_;
};

}  // namespace

void TraceBlock::describe(Describe& d) {
  d.id("residual.trace")
      .summary("Names the physical effects that a declared model lacks, adds them, and tells the error before and after.");
  d.doc(
      "The base model is fitted to the records at `fit` (two or more of different level and phases, where there is a choice) and "
      "its residual tested by class: periodic records against the noise between their lines, measured responses against their "
      "variance, others against a model of their own noise, as no floor is known. Every effect of the catalogue, from any "
      "plugin, "
      "is fitted jointly with the base parameters at every place it knows; the record at `select` ranks them, the one at `test` "
      "is used once for the errors. Up to `most_effects` are added one after the other. The verdict is none, named, "
      "not_separable or "
      "unexplained; an effect outside of the catalogue that acts like one in it takes its name.");
  d.reference(
      "R. Pintelon, J. Schoukens, System Identification: A Frequency Domain Approach, 2nd ed., 2012, chapters 4, 9 and 11");
  d.reference("Q. H. Vuong, Likelihood ratio tests for model selection and non-nested hypotheses, 1989, doi:10.2307/1912557");
  d.reference(
      "R. B. Davies, Hypothesis testing when a nuisance parameter is present only under the alternative, 1987, "
      "doi:10.1093/biomet/74.1.33");
  d.parameter("base", "motor_standstill")
      .doc("what the plant is declared to be: the id of a base model, `residual.` may be left out");
  d.parameter("declare", std::vector<std::string>{}).doc("what the base model declares: name=value, with units");
  d.parameter("effects", std::vector<std::string>{}).doc("names of those to try; all that plugins give where none is named");
  d.parameter("without", std::vector<std::string>{}).doc("names of effects that are not tried");
  d.parameter("known", std::vector<std::string>{}).doc("what single records state: 'fit 1: added_mass=8 g'");
  d.parameter("engine", "auto")
      .choices({"auto", "periodic", "sampled"})
      .doc("periodic: against the noise between the lines; sampled: over time; auto: periodic where all records repeat a period");
  d.optional<double>("segment").unit("s").above(0.0).doc(
      "of records over time: length of the parts that are simulated from a state of their own; without it the whole record where "
      "the plant settles, short parts where it integrates; longer than the record: the whole record");
  d.optional<double>("test_segment")
      .unit("s")
      .above(0.0)
      .doc(
          "the same for the record at `test` alone; without it that of `segment`. Effects are told from short parts, and an "
          "error that "
          "grows with the time, as of a simulated position, from a long one");
  d.parameter("alpha", 0.01)
      .unit("1")
      .range(1e-6, 0.2)
      .doc("probability of a finding where nothing is missing; half of it for the classes, half for the candidates");
  d.parameter("share", 0.97)
      .unit("1")
      .range(0.5, 1)
      .doc("part of what is missing that named effects have to explain, where what they leave is not noise");
  d.parameter("most_effects", std::int64_t{3}).range(1, 5).doc("that may be added");
  d.message_in(fit).doc("recordings or frequency responses, one or more");
  d.message_in(select).optional().doc("one; without it a part of what arrives at `fit` is set aside");
  d.message_in(test).optional().doc("one; without it a part of what arrives at `fit` is set aside");
  d.message_in(model).optional().doc("for a base model that is a black box: a model, or a frequency response");
  d.message_out(out).record_type("trace");
  d.message_out(base).record_type("model").doc("the base model");
  d.message_out(extended).record_type("model").doc("with the effects that were found; the base model where there are none");
}

void TraceBlock::configure(const Parameters& p) {
  base_ = with_family(p.text("base"));
  declare_ = p.texts("declare");
  effects_ = p.texts("effects");
  without_ = p.texts("without");
  known_ = p.texts("known");
  const std::string& engine = p.text("engine");
  engine_ = engine == "periodic" ? Engine::periodic : engine == "sampled" ? Engine::sampled : Engine::automatic;
  segment_s_ = p.has("segment") ? p.number("segment") : 0.0;
  test_segment_s_ = p.has("test_segment") ? p.number("test_segment") : segment_s_;
  settings_.alpha = p.number("alpha");
  settings_.share = p.number("share");
  settings_.most_effects = static_cast<std::size_t>(p.integer("most_effects"));
}

void TraceBlock::receive(int port, const RecordView& record, Io&) {
  if (port == fit.index) {
    given_.fit.push_back(read(record, "fit " + std::to_string(given_.fit.size() + 1)));
    return;
  }
  if (port == model.index) {
    if (model_) fail("a second record arrived at 'model', allowed: one");
    model_ = records::copy_of(record);
    return;
  }
  std::optional<Given>& one = port == select.index ? given_.select : given_.test;
  const std::string name = port == select.index ? select.name : test.name;
  if (one) fail("a second record arrived at '" + name + "', allowed: one");
  one = read(record, name);
}

void TraceBlock::finish(Io& io) {
  const Parts all = parts();
  const Choice choice(all);
  const std::shared_ptr<const BaseModel> made = base_model(all, base_, declare_, model_);
  const Catalogue catalogue = choice.catalogue(effects_, without_);
  Engine engine = engine_for(given_, engine_);
  auto whole = with_all_parts(given_, engine);
  if (!whole && engine == Engine::periodic && engine_ == Engine::automatic) {
    engine = Engine::sampled;
    whole = with_all_parts(given_, engine);
  }
  const GivenRecords records = valid(std::move(whole));
  const TraceData data = valid(measurements_of(records, engine, *made, known_, segment_s_, test_segment_s_));
  TraceSettings settings = settings_;
  settings.known = choice.all();
  settings.progress = [this](const std::string& text) { log_info(text); };
  const Trace found = valid(trace(made, catalogue, data, settings));
  for (const std::string& warning : warnings(found)) log_warning(warning);
  io.emit(out, write_trace(found, data, {base_, declare_, records.notes}));
  io.emit(base, records::write_model(model_of(found.searched.base.fit, data.fit)));
  io.emit(extended, records::write_model(model_of(found.extended().fit, data.fit)));
}

void TraceBlock::reset() {
  given_ = {};
  model_.reset();
}

}  // namespace bodeflow::residual
