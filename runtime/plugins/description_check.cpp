#include "plugins/description_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bodeflow/error.hpp>
#include <bodeflow/utf8.hpp>
#include <cctype>
#include <cmath>
#include <initializer_list>
#include <set>
#include <string_view>

#include "plugins/part_descriptors.hpp"

namespace bodeflow {
namespace {

bool is_word(std::string_view text) {
  return !text.empty() && text.size() <= 255 && std::all_of(text.begin(), text.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  });
}

/// Words between single dots.
bool is_dotted(std::string_view text) {
  for (;;) {
    const std::size_t dot = text.find('.');
    if (!is_word(text.substr(0, dot))) return false;
    if (dot == std::string_view::npos) return true;
    text.remove_prefix(dot + 1);
  }
}

/// `text` for a message: short, and valid UTF-8.
std::string shown(const std::string& text) {
  if (!is_text(text)) return "(not UTF-8)";
  return text.size() > 80 ? "(longer than 80 bytes)" : "'" + text + "'";
}

bool all_text(std::initializer_list<const std::string*> texts) {
  return std::all_of(texts.begin(), texts.end(), [](const std::string* t) { return is_text(*t); });
}

bool all_text(const std::vector<std::string>& texts) {
  return std::all_of(texts.begin(), texts.end(), [](const std::string& t) { return is_text(t); });
}

std::string check_port(const PortDescription& port) {
  if (!is_word(port.name)) return fmt::format("a port is named {}; allowed: letters, digits, _", shown(port.name));
  const auto bad = [&](const std::string& what) { return fmt::format("port '{}': {}", port.name, what); };
  if (port.kind != BF_STREAM && port.kind != BF_MESSAGE) return bad(fmt::format("unknown kind {}", port.kind));
  if (port.direction != BF_IN && port.direction != BF_OUT) return bad(fmt::format("unknown direction {}", port.direction));
  if (port.kind == BF_STREAM && port.element != BF_ANY && port.element != BF_F64 && port.element != BF_C64) {
    return bad(fmt::format("element type {} can't be a stream's; allowed: f64, c64, any", port.element));
  }
  if (!all_text({&port.record_type, &port.doc})) return bad("a text is not UTF-8");
  return {};
}

/// Whether the fields hold as many entries as `rows` and `columns` say.
bool is_consistent(const ParameterValue& v) {
  const std::uint64_t rows = v.rows;
  switch (v.type) {
    case BF_BOOL:
      return rows <= 1 && (v.integer == 0 || v.integer == 1);
    case BF_INTEGER:
      return rows <= 1;
    case BF_NUMBER:
      return rows <= 1 && v.numbers.size() == rows;
    case BF_STRING:
    case BF_CHOICE:
    case BF_FILE:
      return rows <= 1 && v.strings.size() == rows;
    case BF_NUMBERS:
      return v.numbers.size() == rows;
    case BF_INTEGERS:
      return v.integers.size() == rows;
    case BF_STRINGS:
      return v.strings.size() == rows;
    case BF_COMPLEX_LIST:
      return v.numbers.size() == 2 * rows;
    case BF_MATRIX:
      return v.columns > 0 && v.numbers.size() == rows * v.columns;
    default:
      return false;
  }
}

std::string check_default(const ParameterDescription& p) {
  const ParameterValue& v = p.fallback;
  if (v.rows == 0) return {};
  if (v.type != p.type) return fmt::format("the default is of type {}, the parameter of type {}", v.type, p.type);
  if (!is_consistent(v)) return "the default does not hold what its size says";
  if (!all_text(v.strings)) return "the default is not UTF-8";
  if (p.type == BF_CHOICE && std::find(p.choices.begin(), p.choices.end(), v.strings[0]) == p.choices.end()) {
    return fmt::format("the default {} is none of the choices", shown(v.strings[0]));
  }
  return {};
}

std::string check_parameter(const ParameterDescription& p) {
  if (!is_dotted(p.name)) return fmt::format("a parameter is named {}; allowed: letters, digits, _, dots between", shown(p.name));
  const auto bad = [&](const std::string& what) { return fmt::format("parameter '{}': {}", p.name, what); };
  if (p.type < BF_BOOL || p.type > BF_MATRIX) return bad(fmt::format("unknown type {}", p.type));
  if (!all_text({&p.unit, &p.doc}) || !all_text(p.choices)) return bad("a text is not UTF-8");
  for (const std::string& alias : p.aliases) {
    if (!is_dotted(alias)) return bad(fmt::format("alias {}; allowed: letters, digits, _, dots between", shown(alias)));
  }
  if (p.type == BF_CHOICE && p.choices.empty()) return bad("a choice without choices");
  if (!(p.minimum <= p.maximum)) return bad(fmt::format("the range {} .. {} is empty", p.minimum, p.maximum));
  if (const std::string why = check_default(p); !why.empty()) return bad(why);
  return {};
}

/// `kind` is "block" or "base model".
std::string check(const BlockDescription& block, const char* kind) {
  if (!is_dotted(block.id) || block.id.find('.') == std::string::npos) {
    return fmt::format("a {}'s id is {}; allowed: family.name of letters, digits, _", kind, shown(block.id));
  }
  const auto bad = [&](const std::string& what) { return fmt::format("{} '{}': {}", kind, block.id, what); };
  if (!all_text({&block.summary, &block.doc, &block.references}) || !all_text(block.roles)) return bad("a text is not UTF-8");
  if (!std::isfinite(block.cost_ns) || block.cost_ns < 0.0) return bad(fmt::format("the cost of {} ns", block.cost_ns));
  std::set<std::pair<std::uint32_t, std::string>> ports;
  for (const PortDescription& port : block.ports) {
    if (const std::string why = check_port(port); !why.empty()) return bad(why);
    if (!ports.emplace(port.direction, port.name).second) {
      return bad(fmt::format("two {} are named '{}'", port.direction == BF_IN ? "inputs" : "outputs", port.name));
    }
  }
  std::set<std::string> names;
  for (const ParameterDescription& parameter : block.parameters) {
    if (const std::string why = check_parameter(parameter); !why.empty()) return bad(why);
    if (!names.insert(parameter.name).second) return bad(fmt::format("two parameters are named '{}'", parameter.name));
    for (const std::string& alias : parameter.aliases) {
      if (!names.insert(alias).second) return bad(fmt::format("two parameters are named '{}'", alias));
    }
  }
  return {};
}

}  // namespace

std::string check(const BlockDescription& block) { return check(block, "block"); }

std::string check_base_model(const BlockDescription& model) {
  if (std::string why = check(model, "base model"); !why.empty()) return why;
  if (!model.ports.empty()) return fmt::format("base model '{}': has ports", model.id);
  try {
    PartDescriptors().add_base_model(model);
  } catch (const Failure& failure) {
    return failure.what();
  }
  return {};
}

std::string check(const EffectDescription& effect) {
  const bool texts = all_text({&effect.id, &effect.summary, &effect.doc, &effect.references, &effect.separation}) &&
                     all_text(effect.kinds) && all_text(effect.equivalents);
  if (!texts) return fmt::format("effect {}: a text is not UTF-8", shown(effect.id));
  try {
    PartDescriptors().add(effect);
  } catch (const Failure& failure) {
    return failure.what();
  }
  return {};
}

}  // namespace bodeflow
