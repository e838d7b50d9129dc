#include "plugins/description_json.hpp"

#include <fmt/format.h>

#include <array>
#include <bodeflow/effect_type.hpp>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string_view>

#include "plugins/description_check.hpp"

namespace bodeflow {
namespace {

using Json = nlohmann::ordered_json;

struct Name {
  std::uint32_t value;
  const char* text;
};
constexpr std::array kTypes{Name{BF_BOOL, "bool"},       Name{BF_INTEGER, "integer"},
                            Name{BF_NUMBER, "number"},   Name{BF_STRING, "string"},
                            Name{BF_CHOICE, "choice"},   Name{BF_FILE, "file"},
                            Name{BF_NUMBERS, "numbers"}, Name{BF_INTEGERS, "integers"},
                            Name{BF_STRINGS, "strings"}, Name{BF_COMPLEX_LIST, "complex_list"},
                            Name{BF_MATRIX, "matrix"}};
constexpr std::array kElements{Name{BF_ANY, "any"}, Name{BF_F64, "f64"}, Name{BF_C64, "c64"}, Name{BF_I64, "i64"},
                               Name{BF_U8, "u8"}};
constexpr std::array kKinds{Name{BF_STREAM, "stream"}, Name{BF_MESSAGE, "message"}};
constexpr std::array kDirections{Name{BF_IN, "in"}, Name{BF_OUT, "out"}};

template <std::size_t N>
const char* name_of(const std::array<Name, N>& names, std::uint32_t value) {
  for (const Name& n : names) {
    if (n.value == value) return n.text;
  }
  return "unknown";
}

/// Leaves `from_json` with a reason; caught there.
struct Broken : std::runtime_error {
  using std::runtime_error::runtime_error;
};

template <std::size_t N>
std::uint32_t value_of(const std::array<Name, N>& names, const std::string& text, const char* what) {
  for (const Name& n : names) {
    if (text == n.text) return n.value;
  }
  throw Broken(fmt::format("unknown {} '{}'", what, text));
}

Json number_to_json(double value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  return value;
}

double number_from_json(const Json& json) {
  if (json.is_number()) return json.get<double>();
  const std::string text = json.is_string() ? json.get<std::string>() : std::string();
  if (text == "inf") return std::numeric_limits<double>::infinity();
  if (text == "-inf") return -std::numeric_limits<double>::infinity();
  if (text == "nan") return std::numeric_limits<double>::quiet_NaN();
  throw Broken("a number is expected");
}

Json list_to_json(const double* values, std::size_t count) {
  Json list = Json::array();
  for (std::size_t i = 0; i < count; ++i) list.push_back(number_to_json(values[i]));
  return list;
}

Json value_to_json(const ParameterValue& v) {
  switch (v.type) {
    case BF_BOOL:
      return v.integer != 0;
    case BF_INTEGER:
      return v.integer;
    case BF_NUMBER:
      return number_to_json(v.numbers.at(0));
    case BF_STRING:
    case BF_CHOICE:
    case BF_FILE:
      return v.strings.at(0);
    case BF_NUMBERS:
      return list_to_json(v.numbers.data(), v.numbers.size());
    case BF_INTEGERS:
      return v.integers;
    case BF_STRINGS:
      return v.strings;
    default:
      break;
  }
  Json rows = Json::array();  // of a matrix, or [re, im] pairs
  const std::size_t columns = v.type == BF_MATRIX ? v.columns : 2;
  for (std::size_t i = 0; i < v.rows; ++i) rows.push_back(list_to_json(v.numbers.data() + i * columns, columns));
  return rows;
}

const Json& list_of(const Json& json, std::uint64_t most) {
  if (!json.is_array()) throw Broken("a list is expected");
  if (json.size() > most) throw Broken(fmt::format("a list of {}, at most {} expected", json.size(), most));
  return json;
}

std::vector<double> numbers_from_json(const Json& json) {
  std::vector<double> numbers;
  for (const Json& entry : list_of(json, kMostValues)) numbers.push_back(number_from_json(entry));
  return numbers;
}

std::int64_t integer_from_json(const Json& json) {
  if (!json.is_number_integer()) throw Broken("an integer is expected");
  if (json.is_number_unsigned() && json.get<std::uint64_t>() > static_cast<std::uint64_t>(INT64_MAX))
    throw Broken("an integer is too large");
  return json.get<std::int64_t>();
}

std::string text_from_json(const Json& json) {
  if (!json.is_string()) throw Broken("a text is expected");
  return json.get<std::string>();
}

std::vector<std::string> texts_from_json(const Json& json) {
  std::vector<std::string> found;
  for (const Json& entry : list_of(json, kMostValues)) found.push_back(text_from_json(entry));
  return found;
}

void table_from_json(const Json& json, ParameterValue& v) {
  list_of(json, kMostValues);
  for (const Json& row : json) {
    const std::vector<double> numbers = numbers_from_json(row);
    if (v.numbers.empty()) v.columns = static_cast<std::uint32_t>(numbers.size());
    if (numbers.size() != v.columns || numbers.empty()) throw Broken("rows of one length are expected");
    v.numbers.insert(v.numbers.end(), numbers.begin(), numbers.end());
  }
  if (v.type != BF_COMPLEX_LIST) return;
  if (v.columns != 2) throw Broken("pairs [re, im] are expected");
  v.columns = 1;
}

ParameterValue value_from_json(const Json& json, std::uint32_t type) {
  ParameterValue v;
  v.type = type;
  v.rows = json.is_array() ? static_cast<std::uint32_t>(list_of(json, kMostValues).size()) : 1;
  switch (type) {
    case BF_BOOL:
      if (!json.is_boolean()) throw Broken("true or false is expected");
      v.integer = json.get<bool>() ? 1 : 0;
      break;
    case BF_INTEGER:
      v.integer = integer_from_json(json);
      break;
    case BF_NUMBER:
      v.numbers = {number_from_json(json)};
      break;
    case BF_STRING:
    case BF_CHOICE:
    case BF_FILE:
      v.strings = {text_from_json(json)};
      break;
    case BF_NUMBERS:
      v.numbers = numbers_from_json(json);
      break;
    case BF_INTEGERS:
      for (const Json& entry : list_of(json, kMostValues)) v.integers.push_back(integer_from_json(entry));
      break;
    case BF_STRINGS:
      v.strings = texts_from_json(json);
      break;
    default:
      table_from_json(json, v);
  }
  return v;
}

// Members of an object; absent ones have the value that a fresh description has.
const Json* member(const Json& json, const char* name) {
  const auto it = json.find(name);
  return it == json.end() ? nullptr : &*it;
}

std::string text(const Json& json, const char* name) {
  const Json* found = member(json, name);
  return found == nullptr ? std::string() : text_from_json(*found);
}

bool flag(const Json& json, const char* name) {
  const Json* found = member(json, name);
  if (found == nullptr) return false;
  if (!found->is_boolean()) throw Broken("true or false is expected");
  return found->get<bool>();
}

/// Calls `read` and puts "name: " before what it throws.
template <class Read>
auto within(const std::string& name, Read&& read) {
  try {
    return read();
  } catch (const Broken& broken) {
    throw Broken(name + ": " + broken.what());
  }
}

Json port_to_json(const PortDescription& p) {
  Json json{{"name", p.name}, {"kind", name_of(kKinds, p.kind)}, {"direction", name_of(kDirections, p.direction)}};
  if (p.optional) json["optional"] = true;
  if (p.kind == BF_STREAM) json["element"] = name_of(kElements, p.element);
  if (!p.record_type.empty()) json["record_type"] = p.record_type;
  if (!p.doc.empty()) json["doc"] = p.doc;
  return json;
}

PortDescription port_from_json(const Json& json) {
  if (!json.is_object()) throw Broken("a port is an object");
  PortDescription p;
  p.name = text(json, "name");
  p.kind = value_of(kKinds, text(json, "kind"), "kind");
  p.direction = value_of(kDirections, text(json, "direction"), "direction");
  p.optional = flag(json, "optional");
  p.element = p.kind == BF_STREAM ? value_of(kElements, text(json, "element"), "element") : static_cast<std::uint32_t>(BF_ANY);
  p.record_type = text(json, "record_type");
  p.doc = text(json, "doc");
  return p;
}

Json parameter_to_json(const ParameterDescription& p) {
  Json json{{"name", p.name}, {"type", parameter_type_name(p.type)}};
  if (p.required) json["required"] = true;
  if (p.live) json["live"] = true;
  if (!p.unit.empty()) json["unit"] = p.unit;
  if (p.fallback.rows > 0) json["default"] = value_to_json(p.fallback);
  if (!p.choices.empty()) json["choices"] = p.choices;
  if (p.minimum != -std::numeric_limits<double>::infinity()) json["minimum"] = number_to_json(p.minimum);
  if (p.exclusive_minimum) json["exclusive_minimum"] = true;
  if (p.maximum != std::numeric_limits<double>::infinity()) json["maximum"] = number_to_json(p.maximum);
  if (p.exclusive_maximum) json["exclusive_maximum"] = true;
  if (!p.aliases.empty()) json["aliases"] = p.aliases;
  if (!p.doc.empty()) json["doc"] = p.doc;
  return json;
}

ParameterDescription parameter_from_json(const Json& json) {
  if (!json.is_object()) throw Broken("a parameter is an object");
  ParameterDescription p;
  p.name = text(json, "name");
  p.type = value_of(kTypes, text(json, "type"), "type");
  p.required = flag(json, "required");
  p.live = flag(json, "live");
  p.unit = text(json, "unit");
  p.fallback.type = p.type;
  if (const Json* found = member(json, "default")) {
    p.fallback = within("default", [&] { return value_from_json(*found, p.type); });
    if (p.fallback.rows == 0) throw Broken("default: an empty list is no default");
  }
  if (const Json* found = member(json, "choices")) p.choices = texts_from_json(list_of(*found, kMostChoices));
  if (const Json* found = member(json, "minimum")) p.minimum = number_from_json(*found);
  p.exclusive_minimum = flag(json, "exclusive_minimum");
  if (const Json* found = member(json, "maximum")) p.maximum = number_from_json(*found);
  p.exclusive_maximum = flag(json, "exclusive_maximum");
  if (const Json* found = member(json, "aliases")) p.aliases = texts_from_json(list_of(*found, kMostChoices));
  p.doc = text(json, "doc");
  return p;
}

BlockDescription block_from_json(const Json& json) {
  if (!json.is_object()) throw Broken("a block is an object");
  BlockDescription block;
  block.id = text(json, "id");
  block.summary = text(json, "summary");
  block.doc = text(json, "doc");
  block.references = text(json, "references");
  if (const Json* found = member(json, "roles")) block.roles = texts_from_json(list_of(*found, kMostChoices));
  block.realtime_safe = flag(json, "realtime_safe");
  block.in_place = flag(json, "in_place");
  block.asynchronous = flag(json, "asynchronous");
  if (const Json* found = member(json, "cost_ns")) block.cost_ns = number_from_json(*found);
  if (const Json* found = member(json, "ports")) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> next;
    for (const Json& entry : list_of(*found, kMostPorts)) {
      block.ports.push_back(within("ports", [&] { return port_from_json(entry); }));
      block.ports.back().index = next[{block.ports.back().kind, block.ports.back().direction}]++;
    }
  }
  if (const Json* found = member(json, "parameters")) {
    for (const Json& entry : list_of(*found, kMostParameters)) {
      block.parameters.push_back(within("parameters", [&] { return parameter_from_json(entry); }));
    }
  }
  return block;
}

Acts acts_from_json(const std::string& name) {
  for (const Acts acts :
       {Acts::law, Acts::immittance, Acts::input, Acts::output, Acts::series, Acts::parallel, Acts::delay, Acts::tone}) {
    if (name == acts_name(acts)) return acts;
  }
  throw Broken(fmt::format("unknown way to act '{}'", name));
}

/// A whole number of at least 0 and at most `most`; `absent` where there is none.
std::int64_t count(const Json& json, const char* name, std::int64_t most, std::int64_t absent) {
  const Json* found = member(json, name);
  if (found == nullptr) return absent;
  const std::int64_t value = integer_from_json(*found);
  if (value < 0 || value > most) throw Broken(fmt::format("{}: found {}, allowed: 0 to {}", name, value, most));
  return value;
}

EffectDescription read_effect(const Json& json) {
  if (!json.is_object()) throw Broken("an effect is an object");
  EffectDescription effect;
  effect.id = text(json, "id");
  effect.summary = text(json, "summary");
  effect.doc = text(json, "doc");
  effect.references = text(json, "references");
  effect.acts = acts_from_json(text(json, "acts"));
  if (const Json* found = member(json, "kinds")) effect.kinds = texts_from_json(list_of(*found, kMostChoices));
  effect.memory = static_cast<std::size_t>(count(json, "memory", kMostEffectMemory, 0));
  effect.steps_per_sample = static_cast<int>(count(json, "steps_per_sample", kMostStepsPerSample, 1));
  effect.rough = flag(json, "rough");
  effect.nonstationary = flag(json, "nonstationary");
  effect.memoryless_linear = flag(json, "constant");
  if (const Json* found = member(json, "equivalents")) effect.equivalents = texts_from_json(list_of(*found, kMostChoices));
  effect.separation = text(json, "separation");
  return effect;
}

/// What `read` gives if `check` finds nothing wrong with it.
template <class Read, class Check>
auto checked(Read&& read, Check&& check) -> tl::expected<decltype(read()), std::string> {
  try {
    auto description = read();
    if (std::string why = check(description); !why.empty()) return tl::unexpected(std::move(why));
    return description;
  } catch (const Broken& broken) {
    return tl::unexpected(std::string(broken.what()));
  }
}

/// Reads a list of descriptions; none where it is absent.
template <class Read, class Description>
void read_list(const Json* list, Read&& read, std::vector<Description>& descriptions) {
  if (list == nullptr) return;
  for (const Json& entry : list_of(*list, kMostParameters)) {
    auto description = read(entry);
    if (!description) throw Broken(description.error());
    descriptions.push_back(std::move(*description));
  }
}

}  // namespace

const char* parameter_type_name(std::uint32_t type) { return name_of(kTypes, type); }

const char* element_name(std::uint32_t element) { return name_of(kElements, element); }

nlohmann::ordered_json to_json(const BlockDescription& block) {
  Json json{{"id", block.id}, {"summary", block.summary}};
  if (!block.doc.empty()) json["doc"] = block.doc;
  if (!block.references.empty()) json["references"] = block.references;
  if (!block.roles.empty()) json["roles"] = block.roles;
  json["realtime_safe"] = block.realtime_safe;
  json["in_place"] = block.in_place;
  json["asynchronous"] = block.asynchronous;
  json["cost_ns"] = number_to_json(block.cost_ns);
  json["ports"] = Json::array();
  for (const PortDescription& port : block.ports) json["ports"].push_back(port_to_json(port));
  json["parameters"] = Json::array();
  for (const ParameterDescription& parameter : block.parameters) json["parameters"].push_back(parameter_to_json(parameter));
  return json;
}

nlohmann::ordered_json to_json(const PluginDescription& plugin) {
  Json json{{"file", plugin.file},
            {"name", plugin.name},
            {"version", plugin.version},
            {"build", plugin.build},
            {"sha256", plugin.sha256}};
  if (!plugin.refused.empty()) {
    json["refused"] = plugin.refused;
    return json;
  }
  json["blocks"] = Json::array();
  for (const BlockDescription& block : plugin.blocks) json["blocks"].push_back(to_json(block));
  for (const EffectDescription& effect : plugin.effects) json["effects"].push_back(to_json(effect));
  for (const BlockDescription& model : plugin.base_models) json["base_models"].push_back(base_model_to_json(model));
  return json;
}

tl::expected<PluginDescription, std::string> plugin_from_json(const nlohmann::ordered_json& json) {
  try {
    if (!json.is_object()) throw Broken("a plugin is an object");
    PluginDescription plugin{text(json, "file"),
                             text(json, "name"),
                             text(json, "version"),
                             text(json, "build"),
                             text(json, "sha256"),
                             {},
                             text(json, "refused"),
                             {},
                             {}};
    const Json* blocks = member(json, "blocks");
    if (plugin.refused.empty() && blocks == nullptr) throw Broken("neither blocks nor a reason why it is refused");
    if (blocks == nullptr) return plugin;
    read_list(blocks, from_json, plugin.blocks);
    read_list(member(json, "effects"), effect_from_json, plugin.effects);
    read_list(member(json, "base_models"), base_model_from_json, plugin.base_models);
    return plugin;
  } catch (const Broken& broken) {
    return tl::unexpected(std::string(broken.what()));
  }
}

tl::expected<BlockDescription, std::string> from_json(const nlohmann::ordered_json& json) {
  return checked([&] { return block_from_json(json); }, [](const BlockDescription& d) { return check(d); });
}

nlohmann::ordered_json base_model_to_json(const BlockDescription& model) {
  Json json = to_json(model);
  for (const char* name : {"realtime_safe", "in_place", "asynchronous", "cost_ns", "ports"}) json.erase(name);
  return json;
}

tl::expected<BlockDescription, std::string> base_model_from_json(const nlohmann::ordered_json& json) {
  return checked([&] { return block_from_json(json); }, check_base_model);
}

nlohmann::ordered_json to_json(const EffectDescription& effect) {
  Json json{{"id", effect.id}, {"summary", effect.summary}};
  if (!effect.doc.empty()) json["doc"] = effect.doc;
  if (!effect.references.empty()) json["references"] = effect.references;
  json["acts"] = acts_name(effect.acts);
  if (!effect.kinds.empty()) json["kinds"] = effect.kinds;
  if (effect.memory != 0) json["memory"] = effect.memory;
  if (effect.steps_per_sample != 1) json["steps_per_sample"] = effect.steps_per_sample;
  if (effect.rough) json["rough"] = true;
  if (effect.nonstationary) json["nonstationary"] = true;
  if (effect.memoryless_linear) json["constant"] = true;
  if (!effect.equivalents.empty()) json["equivalents"] = effect.equivalents;
  if (!effect.separation.empty()) json["separation"] = effect.separation;
  return json;
}

tl::expected<EffectDescription, std::string> effect_from_json(const nlohmann::ordered_json& json) {
  return checked([&] { return read_effect(json); }, [](const EffectDescription& d) { return check(d); });
}

}  // namespace bodeflow
