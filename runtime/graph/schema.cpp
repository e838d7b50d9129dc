#include "graph/schema.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "graph/keys.hpp"
#include "graph/value.hpp"

namespace bodeflow::graph {
namespace {

using Json = nlohmann::ordered_json;

/// Whatever the value, `${name}` may stand in its place.
Json or_variable(Json alternatives) {
  alternatives.push_back({{"$ref", "#/definitions/variable"}});
  return {{"anyOf", std::move(alternatives)}};
}

Json number(const ParameterDescription* d = nullptr) {
  Json bare = {{"type", "number"}};
  if (d != nullptr && std::isfinite(d->minimum)) bare[d->exclusive_minimum ? "exclusiveMinimum" : "minimum"] = d->minimum;
  if (d != nullptr && std::isfinite(d->maximum)) bare[d->exclusive_maximum ? "exclusiveMaximum" : "maximum"] = d->maximum;
  return or_variable(Json::array({bare, {{"$ref", "#/definitions/quantity"}}}));
}

Json integer(const ParameterDescription* d = nullptr) {
  Json whole = {{"type", "integer"}};
  if (d != nullptr && std::isfinite(d->minimum)) whole["minimum"] = d->minimum + (d->exclusive_minimum ? 1.0 : 0.0);
  if (d != nullptr && std::isfinite(d->maximum)) whole["maximum"] = d->maximum - (d->exclusive_maximum ? 1.0 : 0.0);
  return or_variable(Json::array({whole}));
}

Json text() { return {{"type", Json::array({"string", "number", "boolean"})}}; }

/// A list of these, or one of them alone.
Json list_of(const Json& item) {
  return {{"anyOf", Json::array({item, {{"type", "array"}, {"items", item}}, {{"$ref", "#/definitions/variable"}}})}};
}

Json complex(const ParameterDescription& d) {
  const Json pair = {{"type", "array"}, {"items", number(&d)}, {"minItems", 2}, {"maxItems", 2}};
  return {{"anyOf", Json::array({{{"type", "number"}}, {{"type", "string"}}, pair})}};
}

Json matrix(const ParameterDescription& d) {
  const Json row = {{"type", "array"}, {"items", number(&d)}};
  return or_variable(Json::array({{{"type", "number"}}, {{"type", "array"}, {"items", row}}}));
}

Json form(const ParameterDescription& d) {
  switch (d.type) {
    case BF_BOOL:
      return or_variable(Json::array({{{"type", "boolean"}}}));
    case BF_INTEGER:
      return integer(&d);
    case BF_NUMBER:
      return number(&d);
    case BF_CHOICE:
      return or_variable(Json::array({{{"enum", d.choices}}}));
    case BF_FILE:
      return {{"type", "string"}};
    case BF_NUMBERS:
      return list_of(number(&d));
    case BF_INTEGERS:
      return {{"anyOf", Json::array({list_of(integer(&d)), {{"type", "string"}}})}};
    case BF_STRINGS:
      return list_of(text());
    case BF_COMPLEX_LIST:
      return list_of(complex(d));
    case BF_MATRIX:
      return matrix(d);
    default:
      return text();
  }
}

/// A default as it would be written, or null.
Json default_of(const ParameterValue& v) {
  if (v.rows == 0) return nullptr;
  switch (v.type) {
    case BF_BOOL:
      return v.integer != 0;
    case BF_INTEGER:
      return v.integer;
    case BF_NUMBER:
      return v.numbers.empty() ? Json() : Json(v.numbers.front());
    case BF_STRING:
    case BF_CHOICE:
    case BF_FILE:
      return v.strings.empty() ? Json() : Json(v.strings.front());
    case BF_NUMBERS:
      return v.numbers;
    case BF_INTEGERS:
      return v.integers;
    case BF_STRINGS:
      return v.strings;
    default:
      return nullptr;  // complex lists and matrices: their doc says it
  }
}

std::string description_of(const ParameterDescription& d) {
  std::string out = d.doc;
  const auto add = [&](const std::string& sentence) { out += (out.empty() ? "" : "\n") + sentence; };
  add(allowed_form(d));
  if (const std::string range = range_text(d); !range.empty()) add(range);
  if (d.live) add("live: may change while the graph runs");
  return out;
}

/// Puts a parameter at its dotted place below `object`.
void put(Json& object, const std::string& name, const Json& value, bool required) {
  const auto dot = name.find('.');
  if (required) {
    const std::string first = name.substr(0, dot);
    Json& names = object["required"];
    if (names.is_null()) names = Json::array();
    if (std::find(names.begin(), names.end(), first) == names.end()) names.push_back(first);
  }
  if (dot == std::string::npos) {
    object["properties"][name] = value;
    return;
  }
  Json& group = object["properties"][name.substr(0, dot)];
  if (group.is_null()) group = {{"type", Json::array({"object", "string"})}, {"additionalProperties", false}};  // or ${name}
  put(group, name.substr(dot + 1), value, required);
}

Json parameters_of(const BlockDescription& type) {
  Json object = {
      {"description", type.summary}, {"properties", {{"block", {{"const", type.id}}}}}, {"additionalProperties", false}};
  for (const auto& d : type.parameters) {
    Json value = {{"description", description_of(d)}};
    value.update(form(d));
    if (Json fallback = default_of(d.fallback); !fallback.is_null()) value["default"] = std::move(fallback);
    put(object, d.name, value, d.required && d.aliases.empty());
    for (const auto& alias : d.aliases) {
      Json old = value;
      old["description"] = fmt::format("earlier name of '{}'", d.name);
      put(object, alias, old, false);
    }
  }
  return object;
}

Json block_definition(const Registry& registry) {
  Json ids = Json::array(), rules = Json::array();
  for (const auto& id : registry.ids()) {
    const BlockDescription* type = registry.find(id);
    if (type == nullptr) continue;
    ids.push_back({{"const", id}, {"description", type->summary}});
    rules.push_back(
        {{"if", {{"properties", {{"block", {{"const", id}}}}}, {"required", {"block"}}}}, {"then", parameters_of(*type)}});
  }
  Json block = {
      {"type", "object"}, {"required", {"block"}}, {"properties", {{"block", {{"description", "id of a block: family.name"}}}}}};
  if (!ids.empty()) block["properties"]["block"]["oneOf"] = std::move(ids);
  if (!rules.empty()) block["allOf"] = std::move(rules);
  return block;
}

Json described(Json form, const char* text) {
  form["description"] = text;
  return form;
}

Json object_of(Json properties) {
  return {{"type", "object"}, {"additionalProperties", false}, {"properties", std::move(properties)}};
}

Json run_definition() {
  return object_of(
      {{"clock",
        described(or_variable(Json::array({{{"enum", clocks()}}})), "what paces the run; simulated: as fast as possible")},
       {"duration", described(number(), "length of the run [s]")},
       {"seed", described(integer(), "of all random numbers")},
       {"chunk", described(integer(), "samples of the fastest stream in one call, at most")},
       {"latency", described(number(), "budget [s]: a chunk is not longer")},
       {"threads", described(integer(), "threads of the engine")},
       {"on_overrun",
        described(or_variable(Json::array({{{"enum", overruns()}}})),
                  "clock realtime, a chunk that begins late; count: goes on at once until it has caught up; skip: leaves out the "
                  "whole chunks of time that were lost, no samples; stop: the run ends")},
       {"priority",
        described(integer(), "1 to 99: SCHED_FIFO priority of the compute threads, with locked memory, where permitted")},
       {"cores", described({{"type", "array"}, {"items", integer()}}, "compute threads are bound to these cores, in turn")},
       {"watchdog", described(number(), "a graph without progress for this long [s] is ended")},
       {"tolerance", described(number(), "a connection between hosts without progress for this long [s] ends the run")},
       {"launcher_lost", described(or_variable(Json::array({{{"enum", {"stop", "continue"}}}})),
                                   "what hosts do when the process that started the run is lost")},
       {"restart", described({{"type", "boolean"}},
                             "the part of a host that is lost is started again; what is missing is told to the sample")},
       {"gaps", described(or_variable(Json::array({{{"enum", {"nan", "hold"}}}})),
                          "restart: the samples that are missing are no number, or repeat the last one that came")}});
}

Json connections_definition() {
  const Json end = {{"type", "string"}};
  Json map = object_of(
      {{"from", end},
       {"to", end},
       {"latency", described({{"type", Json::array({"string", "number"})}}, "how long a record waits: 2 ms, or 3 samples")}});
  map["required"] = {"from", "to"};
  return {{"type", Json::array({"array", "null"})},
          {"description", "a -> b.port -> c; $phase.block.port -> b.port; a.changes -> b.parameters"},
          {"items", {{"anyOf", Json::array({{{"type", "string"}}, map})}}}};
}

Json schedule_definition() {
  Json change = object_of({{"at", described(number(), "time of the run [s]")},
                           {"block", {{"type", "string"}}},
                           {"set", described({{"type", "object"}}, "live parameters and their new values")}});
  change["required"] = {"at", "block", "set"};
  return {{"type", Json::array({"array", "null"})},
          {"description", "live parameters that change at stated times"},
          {"items", change}};
}

Json limits_definition() {
  Json limit = object_of(
      {{"signal", described({{"type", "string"}}, "block.port of a stream; block where it has one stream only")},
       {"side", described({{"enum", {"input", "output"}}}, "where a block's input and output have the same name")},
       {"channel", described({{"type", Json::array({"string", "integer"})}}, "name or number (from 0); without it all")},
       {"min", described(number(), "least value, in the stream's unit")},
       {"max", described(number(), "greatest value, in the stream's unit")},
       {"rate", described(number(), "greatest rate of change, in the stream's unit per second")},
       {"time", described(number(), "a violation must act within this [s], or the graph is refused")},
       {"on_violation", described(or_variable(Json::array({{{"enum", violation_actions()}}})),
                                  "clamp (default of inputs): samples are held within the limits; stop (default of outputs): the "
                                  "run ends; warn: it is told")}});
  limit["required"] = {"signal"};
  return {{"type", Json::array({"array", "null"})},
          {"description", "what the runtime enforces on streams, whatever the blocks do"},
          {"items", limit}};
}

Json phases_definition() {
  const Json condition = {{"type", "string"}, {"pattern", "^\\$"}, {"description", "$phase.block.port.attribute == value"}};
  Json repeat = object_of({{"max", described(integer(), "times, at most")}, {"until", condition}});
  repeat["required"] = {"max"};
  Json phase = object_of({{"name", {{"type", "string"}, {"pattern", "^[A-Za-z0-9_-]+$"}}},
                          {"blocks", {{"$ref", "#/definitions/blocks"}}},
                          {"connections", {{"$ref", "#/definitions/connections"}}},
                          {"schedule", {{"$ref", "#/definitions/schedule"}}},
                          {"record", {{"$ref", "#/definitions/record"}}},
                          {"limits", {{"$ref", "#/definitions/limits"}}},
                          {"run", {{"$ref", "#/definitions/run"}}},
                          {"when", condition},
                          {"repeat", repeat},
                          {"sweep", {{"type", "object"}, {"description", "seed: 1..100, or block.parameter: [values]"}}}});
  phase["required"] = {"name", "blocks"};
  return {{"type", "array"}, {"minItems", 1}, {"items", phase}};
}

Json definitions(const Registry& registry) {
  const Json strings = {{"type", "array"}, {"items", {{"type", "string"}}}};
  return {{"variable", {{"type", "string"}, {"pattern", "\\$\\{"}, {"description", "${name}: the value of a variable"}}},
          {"quantity", {{"type", "string"}, {"pattern", "^\\s*[-+]?[0-9.]"}, {"description", "a number with its unit: 10 kHz"}}},
          {"block", block_definition(registry)},
          {"blocks",
           {{"type", "object"},
            {"propertyNames", {{"pattern", "^[A-Za-z0-9_-]+$"}}},
            {"additionalProperties", or_variable(Json::array({{{"$ref", "#/definitions/block"}}}))}}},
          {"run", run_definition()},
          {"connections", connections_definition()},
          {"schedule", schedule_definition()},
          {"record", described({{"anyOf", Json::array({{{"const", "all"}}, strings, {{"type", "null"}}})}},
                               "stream outputs kept in data.h5")},
          {"limits", limits_definition()},
          {"phases", phases_definition()}};
}

}  // namespace

nlohmann::ordered_json schema(const Registry& registry) {
  const auto reference = [](const char* name) { return Json{{"$ref", std::string("#/definitions/") + name}}; };
  const Json map_of_any = {{"type", Json::array({"object", "null"})}};
  const Json files = {{"type", "array"}, {"items", {{"type", "string"}}}};
  Json out = {{"$schema", "http://json-schema.org/draft-07/schema#"}, {"title", "bodeflow graph"}};
  out.update(
      object_of({{"bodeflow", {{"const", kFormat}, {"description", "version of the format"}}},
                 {"title", {{"type", Json::array({"string", "null"})}}},
                 {"run", reference("run")},
                 {"include", described(files, "graph files whose blocks, connections and variables belong to this one")},
                 {"requires", described(map_of_any, "plugin: '>=1.2'")},
                 {"variables", described(map_of_any, "values for ${name}; one without a value must be set with --set")},
                 {"blocks", reference("blocks")},
                 {"connections", reference("connections")},
                 {"schedule", reference("schedule")},
                 {"record", reference("record")},
                 {"limits", reference("limits")},
                 {"phases", reference("phases")},
                 {"hosts", described(map_of_any, "host: [blocks]; the rest runs where the graph was started")},
                 {"summary", object_of({{"show", described(files, "results that a run prints, in this order; all otherwise")},
                                        {"next", described({{"type", "string"}}, "what to type next, printed at the end")}})}}));
  out["required"] = {"bodeflow"};
  out["definitions"] = definitions(registry);
  return out;
}

}  // namespace bodeflow::graph
