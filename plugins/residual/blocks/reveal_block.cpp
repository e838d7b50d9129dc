#include "blocks/reveal_block.hpp"

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

/// What a bench calls a parameter and what a base model calls it.
constexpr std::pair<const char*, const char*> kSameAs[] = {
    {"motor_inertia", "motor_inertia"}, {"load_inertia", "load_inertia"},     {"stiffness", "stiffness"},
    {"damping", "coupling_damping"},    {"motor_viscosity", "motor_damping"}, {"load_viscosity", "load_damping"},
};

}  // namespace

void Reveal::describe(Describe& d) {
  d.id("residual.reveal").summary("Holds the verdict of a trace against the truth of a bench that hid something.");
  d.doc(
      "To be run in a phase after the trace, so that the verdict stands before the truth is opened. Right is: none where nothing "
      "was "
      "hidden; the effects named, or declared not separable with them among those that can't be told apart; unexplained for an "
      "effect "
      "that the tracer does not know. Where the truth has rs, rr, ls, lr, lm, or the inertias, stiffness and damping of an axis, "
      "the "
      "true parameters of the base model stand beside the fitted ones.");
  d.message_in(trace).record_type("trace");
  d.message_in(truth).record_type("bench_properties").doc("effects, sizes, units, or effect, size, unit");
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
  if (const auto effects = record.texts("effects")) {
    const auto sizes = record.attribute("sizes");
    const std::vector<std::string> units = texts_in(record, "units");
    if (units.size() != effects->size() || !sizes || sizes->size() != effects->size())
      fail("bench_properties: effects, sizes and units have different lengths");
    for (std::size_t e = 0; e < units.size(); ++e) t.hidden.push_back({std::string((*effects)[e]), sizes->number(e), units[e]});
  } else if (const std::string effect = text_in(record, "effect"); effect != "none") {
    t.hidden.push_back({effect, record.number("size").value_or(0.0), text_in(record, "unit")});
  }
  const auto rs = record.number("rs"), rr = record.number("rr"), ls = record.number("ls"), lr = record.number("lr"),
             lm = record.number("lm");
  if (rs && rr && ls && lr && lm) t.motor = motor_truth(*rs, *rr, *ls, *lr, *lm);
  for (const auto& [property, parameter] : kSameAs)
    if (const auto value = record.number(property)) t.by_name[parameter] = *value;
  truth_ = std::move(t);
}

void Reveal::finish(Io& io) {
  if (!said_) fail("no trace arrived at 'trace'");
  if (!truth_) fail("no truth arrived at 'truth'");
  RecordBuilder r("reveal");
  r.set("right", is_right(said_->answer, truth_->hidden));
  r.set("sentence", comparison(said_->answer, truth_->hidden));
  std::vector<std::string> names, units;
  std::vector<double> sizes;
  for (const HiddenTruth& h : truth_->hidden) {
    names.push_back(h.name);
    units.push_back(h.unit);
    sizes.push_back(h.size);
  }
  r.set("hidden", names).set("sizes", sizes).set("units", units);
  r.set("verdict", said_->answer.verdict).set("effects", said_->answer.effects);
  r.set("parameter_names", said_->parameter_names).set("parameter_units", said_->parameter_units);
  put(r, "parameters_before", said_->before);
  put(r, "parameters_after", said_->after);
  put(r, "parameters_after_std", said_->after_std);
  if (const auto values = true_values(); !values.empty()) put(r, "parameters_true", values);
  io.emit(out, r);
}

/// The true values of the base model's parameters where the truth tells all of them.
std::vector<double> Reveal::true_values() const {
  if (truth_->motor && said_->parameter_names == std::vector<std::string>{"gamma", "alpha", "Lm_beta", "sigma"})
    return {truth_->motor->begin(), truth_->motor->end()};
  std::vector<double> values;
  for (const std::string& name : said_->parameter_names) {
    const auto at = truth_->by_name.find(name);
    if (at == truth_->by_name.end()) return {};
    values.push_back(at->second);
  }
  return values;
}

void Reveal::reset() {
  said_.reset();
  truth_.reset();
}

}  // namespace bodeflow::residual
