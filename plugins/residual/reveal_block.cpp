#include "reveal_block.hpp"

#include <algorithm>

namespace bodeflow::residual {
namespace {

std::vector<double> numbers_in(const RecordView& record, const char* name) {
  const auto found = record.array(name);
  if (!found || found->element != BF_F64) fail("the trace has no array '" + std::string(name) + "'");
  const auto values = found->as<double>();
  return {values.begin(), values.end()};
}

std::string text_in(const RecordView& record, const char* name) {
  const auto found = record.text(name);
  if (!found) fail("the record '" + std::string(record.type()) + "' has no text '" + name + "'");
  return std::string(*found);
}

std::vector<std::string> texts_in(const RecordView& record, const char* name) {
  const auto found = record.texts(name);
  if (!found) fail("the trace has no texts '" + std::string(name) + "'");
  return {found->begin(), found->end()};
}

void put(RecordBuilder& r, const char* name, const std::vector<double>& values) {
  const auto data = r.array<double>(name, "", {values.size()});
  std::copy(values.begin(), values.end(), data.begin());
}

}  // namespace

void Reveal::describe(Describe& d) {
  d.id("residual.reveal").summary("Holds the verdict of a trace against the truth of a bench that hid something.");
  d.doc(
      "To be run in a phase after the trace, so that the verdict stands before the truth is opened. Right is: none where nothing "
      "was "
      "hidden; the effect named, or declared not separable with it among those that can't be told apart; unexplained for an "
      "effect "
      "that the tracer does not know. Where the truth has rs, rr, ls, lr, lm, the true gamma, alpha, Lm_beta, sigma stand beside "
      "the "
      "fitted ones.");
  d.message_in(trace).record_type("trace");
  d.message_in(truth).record_type("bench_properties").doc("effect, size, unit");
  d.message_out(out).record_type("reveal").doc("right, sentence, and the parameters before, after and true");
}

void Reveal::receive(int port, const RecordView& record, Io&) {
  if (port == trace.index) {
    Said s;
    s.answer.verdict = text_in(record, "verdict");
    s.answer.effects = texts_in(record, "effects");
    s.answer.equivalents = texts_in(record, "equivalents");
    s.answer.candidates = texts_in(record, "candidate_names");
    s.parameter_names = texts_in(record, "parameter_names");
    s.parameter_units = texts_in(record, "parameter_units");
    s.before = numbers_in(record, "parameters_before");
    s.after = numbers_in(record, "parameters_after");
    s.after_std = numbers_in(record, "parameters_after_std");
    said_ = std::move(s);
    return;
  }
  Truth t;
  t.effect = text_in(record, "effect");
  t.unit = text_in(record, "unit");
  t.size = record.number("size").value_or(0.0);
  const auto rs = record.number("rs"), rr = record.number("rr"), ls = record.number("ls"), lr = record.number("lr"),
             lm = record.number("lm");
  if (rs && rr && ls && lr && lm) t.motor = motor_truth(*rs, *rr, *ls, *lr, *lm);
  truth_ = std::move(t);
}

void Reveal::finish(Io& io) {
  if (!said_) fail("no trace arrived at 'trace'");
  if (!truth_) fail("no truth arrived at 'truth'");
  RecordBuilder r("reveal");
  r.set("right", is_right(said_->answer, truth_->effect));
  r.set("sentence", comparison(said_->answer, truth_->effect, truth_->size, truth_->unit));
  r.set("hidden", truth_->effect).set("size", truth_->size).set("unit", truth_->unit);
  r.set("verdict", said_->answer.verdict).set("effects", said_->answer.effects);
  r.set("parameter_names", said_->parameter_names).set("parameter_units", said_->parameter_units);
  put(r, "parameters_before", said_->before);
  put(r, "parameters_after", said_->after);
  put(r, "parameters_after_std", said_->after_std);
  if (truth_->motor && said_->parameter_names == std::vector<std::string>{"gamma", "alpha", "Lm_beta", "sigma"})
    put(r, "parameters_true", {truth_->motor->begin(), truth_->motor->end()});
  io.emit(out, r);
}

void Reveal::reset() {
  said_.reset();
  truth_.reset();
}

}  // namespace bodeflow::residual
