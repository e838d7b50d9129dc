#include "trace_block.hpp"

#include "base_parameters.hpp"
#include "extended_model.hpp"
#include "records/recording.hpp"
#include "trace_record.hpp"
#include "trace_words.hpp"

namespace bodeflow::residual {
namespace {

template <class T>
T valid(Expected<T> result) {
  if (!result) fail(result.error().text);
  return std::move(*result);
}

Experiment experiment_in(const RecordView& record, const std::string& name) {
  const auto recording = records::read_recording(record);
  if (!recording) fail("record '" + name + "': " + recording.error().text);
  auto experiment = experiment_of(*recording, name);
  if (!experiment) fail("record '" + name + "': " + experiment.error().text);
  return std::move(*experiment);
}

std::string names_of_effects() {
  std::string text;
  for (const std::string& name : effect_names()) text += (text.empty() ? "" : ", ") + name;
  return text;
}

}  // namespace

void TraceBlock::describe(Describe& d) {
  d.id("residual.trace")
      .summary("Names the physical effect that a declared model lacks, adds it, and tells the error before and after.");
  d.doc(
      "Periodic recordings of one input and one output. The base model is fitted to the records at `fit` (two or more, of "
      "different "
      "level and phases) by maximum likelihood, its residual is tested by class of lines against the noise between the lines, "
      "and every "
      "effect is fitted jointly with the base parameters. The record at `select` ranks them, the one at `test` is used once for "
      "the "
      "errors. The verdict is none, named, not_separable or unexplained; an effect outside of the catalogue that acts like one "
      "in it "
      "takes its name.");
  d.reference(
      "R. Pintelon, J. Schoukens, System Identification: A Frequency Domain Approach, 2nd ed., 2012, chapters 4, 9 and 11");
  d.reference("Q. H. Vuong, Likelihood ratio tests for model selection and non-nested hypotheses, 1989, doi:10.2307/1912557");
  describe_base(d);
  d.parameter("effects", std::vector<std::string>{}).doc("those to try; all where none is given: " + names_of_effects());
  d.parameter("alpha", 0.01)
      .unit("1")
      .range(1e-6, 0.2)
      .doc("probability of a finding where nothing is missing; half of it for the classes of lines, half for the candidates");
  d.parameter("share", 0.97)
      .unit("1")
      .range(0.5, 1)
      .doc("part of what is missing that a named effect has to explain, where what it leaves is not noise");
  d.message_in(fit).record_type("recording").doc("several");
  d.message_in(select).record_type("recording").doc("one");
  d.message_in(test).record_type("recording").doc("one");
  d.message_out(out).record_type("trace");
  d.message_out(base).record_type("model").doc("the base model");
  d.message_out(extended).record_type("model").doc("with the effect that was found; the base model where there is none");
}

void TraceBlock::configure(const Parameters& p) {
  base_ = base_model(p);
  catalogue_ = valid(catalogue(p.texts("effects")));
  settings_ = {p.number("alpha"), p.number("share")};
}

void TraceBlock::receive(int port, const RecordView& record, Io&) {
  if (port == fit.index) {
    fit_.push_back(experiment_in(record, "fit " + std::to_string(fit_.size() + 1)));
    return;
  }
  std::optional<Experiment>& one = port == select.index ? select_ : test_;
  const std::string name = port == select.index ? "select" : "test";
  if (one) fail("a second record arrived at '" + name + "', allowed: one");
  one = experiment_in(record, name);
}

TraceData TraceBlock::data() const {
  if (fit_.empty()) fail("no recording arrived at 'fit'");
  if (!select_) fail("no recording arrived at 'select'; it ranks the candidates and must not be one of those that are fitted");
  if (!test_) fail("no recording arrived at 'test'; it holds the error that is reported and must not be used otherwise");
  return {fit_, *select_, *test_};
}

void TraceBlock::finish(Io& io) {
  const TraceData d = data();
  const Trace found = valid(trace(*base_, catalogue_, d, settings_));
  for (const std::string& warning : warnings(found)) log_warning(warning);
  io.emit(out, write_trace(found, d, *base_));
  io.emit(base, records::write_model(model_of(found.base.fit, d.fit)));
  io.emit(extended, records::write_model(model_of(found.extended().fit, d.fit)));
}

void TraceBlock::reset() {
  fit_.clear();
  select_.reset();
  test_.reset();
}

}  // namespace bodeflow::residual
