#include "trace/told_model.hpp"

#include <algorithm>

#include "trace/binding.hpp"

namespace bodeflow::residual {
namespace {

std::string text_in(const RecordView& trace, const char* name) {
  const auto found = trace.text(name);
  if (!found) fail("the trace has no text '" + std::string(name) + "'");
  return std::string(*found);
}

std::vector<std::string> texts_in(const RecordView& trace, const char* name) {
  const auto found = trace.texts(name);
  if (!found) fail("the trace has no list of texts '" + std::string(name) + "'");
  return {found->begin(), found->end()};
}

std::vector<double> numbers_in(const RecordView& trace, const char* name) {
  const auto found = trace.array(name);
  if (!found || found->element != BF_F64) fail("the trace has no array '" + std::string(name) + "'");
  const auto values = found->as<double>();
  return {values.begin(), values.end()};
}

std::vector<NamedEffect> effects_in(const RecordView& trace) {
  const std::vector<std::string> names = texts_in(trace, "effects"), places = texts_in(trace, "effect_places"),
                                 parameters = texts_in(trace, "effect_parameter_names");
  const std::vector<double> values = numbers_in(trace, "effect_parameters");
  const auto counts = trace.attribute("effect_parameter_counts");
  if (!counts || counts->kind() != AttributeKind::integer || counts->size() != names.size() || places.size() != names.size())
    fail("the trace has " + std::to_string(names.size()) +
         " effects, and effect_places and effect_parameter_counts do not fit them");
  std::vector<NamedEffect> effects;
  std::size_t at = 0;
  for (std::size_t e = 0; e < names.size(); ++e) {
    const auto count = static_cast<std::size_t>(std::max<std::int64_t>(counts->integer(e), 0));
    if (at + count > std::min(parameters.size(), values.size()))
      fail("the trace has fewer parameters of effects than effect_parameter_counts says");
    const auto from = static_cast<std::ptrdiff_t>(at), to = static_cast<std::ptrdiff_t>(at + count);
    effects.push_back({names[e],
                       places[e],
                       {parameters.begin() + from, parameters.begin() + to},
                       {values.begin() + from, values.begin() + to}});
    at += count;
  }
  return effects;
}

std::size_t place_of(const BaseModel& base, const std::string& name) {
  if (name.empty()) return Addition::kNoPlace;
  const std::vector<Place> places = base.places();
  const auto at = std::find_if(places.begin(), places.end(), [&](const Place& p) { return p.name == name; });
  if (at == places.end()) fail("the base model has no place '" + name + "', of which the trace tells");
  return static_cast<std::size_t>(at - places.begin());
}

}  // namespace

ToldModel read_told_model(const RecordView& trace) {
  ToldModel told;
  told.verdict = text_in(trace, "verdict");
  told.unit = text_in(trace, "unit");
  told.base = text_in(trace, "base");
  told.declarations = texts_in(trace, "declarations");
  told.parameter_names = texts_in(trace, "parameter_names");
  told.before = numbers_in(trace, "parameters_before");
  told.after = numbers_in(trace, "parameters_after");
  told.effects = effects_in(trace);
  return told;
}

RebuiltModel rebuild(const ToldModel& told, const PartsInReach& parts, const std::vector<std::size_t>& left_out) {
  RebuiltModel rebuilt;
  rebuilt.model.base = parts.base(told.base, told.declarations);
  const BaseModel& base = *rebuilt.model.base;
  std::vector<double> values = told.after;
  if (base.parameters().size() != values.size()) {
    fail("the base model has " + std::to_string(base.parameters().size()) + " parameters, the trace " +
         std::to_string(values.size()));
  }
  for (std::size_t e = 0; e < told.effects.size(); ++e) {
    if (std::find(left_out.begin(), left_out.end(), e) != left_out.end()) continue;
    const NamedEffect& effect = told.effects[e];
    const std::size_t place = place_of(base, effect.place);
    Situation situation;
    if (place != Addition::kNoPlace) situation.place = base.places()[place];
    Addition addition = bound(parts.effect(effect.name), base, place, situation);
    if (addition.parameters.size() != effect.values.size()) {
      fail("effect '" + effect.name + "' has " + std::to_string(addition.parameters.size()) + " parameters, the trace " +
           std::to_string(effect.values.size()));
    }
    values.insert(values.end(), effect.values.begin(), effect.values.end());
    rebuilt.model.additions.push_back(std::move(addition));
  }
  rebuilt.values = Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
  return rebuilt;
}

}  // namespace bodeflow::residual
