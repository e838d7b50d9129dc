#include "plugins/describe.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <sstream>
#include <stdexcept>

#include "plugins/description_check.hpp"

namespace bodeflow {
namespace {

/// Leaves `describe` with a reason; caught there.
struct Broken : std::runtime_error {
  using std::runtime_error::runtime_error;
};

template <class T>
void require_size(const T& value, const char* what) {
  if (value.struct_size < sizeof(T)) {
    throw Broken(fmt::format("{} has {} bytes, at least {} expected", what, value.struct_size, sizeof(T)));
  }
}

std::string required_text(const char* text, const std::string& what) {
  if (text == nullptr) throw Broken(what + " is a null pointer");
  return text;
}

std::string optional_text(const char* text) { return text == nullptr ? std::string() : std::string(text); }

std::vector<std::string> words(const char* text) {
  std::istringstream in(optional_text(text));
  std::vector<std::string> found;
  for (std::string word; in >> word;) found.push_back(word);
  return found;
}

std::vector<std::string> texts(const char* const* list, std::uint64_t count, const std::string& what) {
  if (count > 0 && list == nullptr) throw Broken(what + " are a null pointer");
  std::vector<std::string> found;
  for (std::uint64_t i = 0; i < count; ++i) found.push_back(required_text(list[i], what + ": one"));
  return found;
}

template <class T>
std::vector<T> values(const T* list, std::uint64_t count, const std::string& what) {
  if (count > 0 && list == nullptr) throw Broken(what + " is a null pointer");
  return count == 0 ? std::vector<T>() : std::vector<T>(list, list + count);
}

ParameterValue fallback(const bf_parameter_value& c, std::uint32_t type, const std::string& what) {
  ParameterValue value;
  value.type = type;
  if (c.rows == 0) return value;  // no default: whatever else stands there
  require_size(c, what.c_str());
  const bool matrix = c.type == BF_MATRIX;
  const std::uint64_t count = std::uint64_t{c.rows} * (matrix ? c.columns : 1);
  if (count > kMostValues) throw Broken(fmt::format("{} has {} values, at most {} expected", what, count, kMostValues));
  value.type = c.type;
  value.rows = c.rows;
  value.columns = matrix ? c.columns : 1;
  switch (c.type) {
    case BF_BOOL:
    case BF_INTEGER:
      value.integer = c.integer;
      break;
    case BF_NUMBER:
    case BF_NUMBERS:
    case BF_MATRIX:
      value.numbers = values(c.numbers, count, what);
      break;
    case BF_COMPLEX_LIST:
      value.numbers = values(c.numbers, 2 * count, what);
      break;
    case BF_INTEGERS:
      value.integers = values(c.integers, count, what);
      break;
    case BF_STRING:
    case BF_CHOICE:
    case BF_FILE:
    case BF_STRINGS:
      value.strings = texts(c.strings, count, what);
      break;
    default:
      break;  // named by the check
  }
  return value;
}

PortDescription port(const bf_port_descriptor* c) {
  if (c == nullptr) throw Broken("a port is a null pointer");
  require_size(*c, "a port's descriptor");
  PortDescription port;
  port.name = required_text(c->name, "a port's name");
  port.kind = c->kind;
  port.direction = c->direction;
  port.optional = (c->flags & BF_PORT_OPTIONAL) != 0;
  port.element = c->kind == BF_STREAM ? c->element : static_cast<std::uint32_t>(BF_ANY);
  port.record_type = optional_text(c->record_type);
  port.doc = optional_text(c->doc);
  return port;
}

ParameterDescription parameter(const bf_parameter_descriptor* c) {
  if (c == nullptr) throw Broken("a parameter is a null pointer");
  require_size(*c, "a parameter's descriptor");
  ParameterDescription p;
  p.name = required_text(c->name, "a parameter's name");
  const std::string of = " of parameter '" + p.name + "'";
  p.type = c->type;
  p.required = (c->flags & BF_PARAMETER_REQUIRED) != 0;
  p.live = (c->flags & BF_PARAMETER_LIVE) != 0;
  p.exclusive_minimum = (c->flags & BF_PARAMETER_EXCLUSIVE_MIN) != 0;
  p.exclusive_maximum = (c->flags & BF_PARAMETER_EXCLUSIVE_MAX) != 0;
  p.unit = optional_text(c->unit);
  p.doc = optional_text(c->doc);
  if (c->choice_count > kMostChoices)
    throw Broken(fmt::format("{} choices{}, at most {} expected", c->choice_count, of, kMostChoices));
  p.choices = texts(c->choices, c->choice_count, "the choices" + of);
  p.aliases = words(c->aliases);
  p.minimum = c->minimum;
  p.maximum = c->maximum;
  p.fallback = fallback(c->fallback, p.type, "the default" + of);
  return p;
}

/// `kind` is "block" or "base model".
BlockDescription block(const bf_block_descriptor& c, const std::string& kind) {
  require_size(c, ("a " + kind + "'s descriptor").c_str());
  BlockDescription block;
  block.id = required_text(c.id, "a " + kind + "'s id");
  block.summary = optional_text(c.summary);
  block.doc = optional_text(c.doc);
  block.references = optional_text(c.references);
  block.roles = words(c.roles);
  block.realtime_safe = (c.flags & BF_BLOCK_REALTIME_SAFE) != 0;
  block.in_place = (c.flags & BF_BLOCK_IN_PLACE) != 0;
  block.asynchronous = (c.flags & BF_BLOCK_ASYNCHRONOUS) != 0;
  block.cost_ns = c.cost_ns;
  try {
    if (c.port_count > kMostPorts) throw Broken(fmt::format("{} ports, at most {} expected", c.port_count, kMostPorts));
    if (c.parameter_count > kMostParameters) {
      throw Broken(fmt::format("{} parameters, at most {} expected", c.parameter_count, kMostParameters));
    }
    if (c.port_count > 0 && c.ports == nullptr) throw Broken("the list of ports is a null pointer");
    if (c.parameter_count > 0 && c.parameters == nullptr) throw Broken("the list of parameters is a null pointer");
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> next;
    for (std::uint32_t i = 0; i < c.port_count; ++i) {
      block.ports.push_back(port(c.ports[i]));
      block.ports.back().index = next[{block.ports.back().kind, block.ports.back().direction}]++;
    }
    for (std::uint32_t i = 0; i < c.parameter_count; ++i) block.parameters.push_back(parameter(c.parameters[i]));
  } catch (const Broken& broken) {
    throw Broken(kind + " '" + block.id + "': " + broken.what());
  }
  return block;
}

EffectDescription effect(const bf_effect_descriptor& c) {
  require_size(c, "an effect's descriptor");
  EffectDescription effect;
  effect.id = required_text(c.id, "an effect's id");
  const std::string of = " of effect '" + effect.id + "'";
  if (c.acts < BF_ACTS_LAW || c.acts > BF_ACTS_TONE)
    throw Broken(fmt::format("effect '{}': unknown way to act {}", effect.id, c.acts));
  effect.acts = static_cast<Acts>(c.acts - BF_ACTS_LAW);
  effect.summary = optional_text(c.summary);
  effect.doc = optional_text(c.doc);
  effect.references = optional_text(c.references);
  effect.separation = optional_text(c.separation);
  if (c.kind_count > kMostChoices || c.equivalent_count > kMostChoices) {
    throw Broken(fmt::format("effect '{}': {} kinds of places and {} equivalents, at most {} expected", effect.id, c.kind_count,
                             c.equivalent_count, kMostChoices));
  }
  effect.kinds = texts(c.kinds, c.kind_count, "the kinds of places" + of);
  effect.equivalents = texts(c.equivalents, c.equivalent_count, "the equivalents" + of);
  effect.memory = static_cast<std::size_t>(c.memory);
  effect.steps_per_sample = static_cast<int>(std::min<std::uint32_t>(c.steps_per_sample, INT32_MAX));
  effect.rough = (c.flags & BF_EFFECT_ROUGH) != 0;
  effect.nonstationary = (c.flags & BF_EFFECT_NONSTATIONARY) != 0;
  effect.memoryless_linear = (c.flags & BF_EFFECT_MEMORYLESS_LINEAR) != 0;
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

}  // namespace

tl::expected<BlockDescription, std::string> describe(const bf_block_descriptor& descriptor) {
  return checked([&] { return block(descriptor, "block"); }, [](const BlockDescription& d) { return check(d); });
}

tl::expected<BlockDescription, std::string> describe_base_model(const bf_block_descriptor& descriptor) {
  return checked([&] { return block(descriptor, "base model"); }, check_base_model);
}

tl::expected<EffectDescription, std::string> describe(const bf_effect_descriptor& descriptor) {
  return checked([&] { return effect(descriptor); }, [](const EffectDescription& d) { return check(d); });
}

}  // namespace bodeflow
