#include "descriptor_check.hpp"

#include <bodeflow/effect_type.hpp>
#include <bodeflow/units.hpp>
#include <bodeflow/utf8.hpp>
#include <cmath>
#include <set>

namespace bodeflow::testing {
namespace {

class Checker {
 public:
  explicit Checker(const bf_block_descriptor& block) : d_(block) {}

  std::vector<std::string> run() {
    texts();
    for (std::uint32_t i = 0; i < d_.port_count; ++i) port(d_.ports[i]);
    for (std::uint32_t i = 0; i < d_.parameter_count; ++i) parameter(d_.parameters[i]);
    return problems_;
  }

 private:
  void wrong(std::string text) { problems_.push_back(std::move(text)); }

  bool text(const char* text, const std::string& what, bool required) {
    if (text == nullptr) {
      if (required) wrong(what + " is a null pointer");
      return false;
    }
    if (!is_text(text)) wrong(what + " is not UTF-8");
    if (required && *text == '\0') wrong(what + " is empty");
    return true;
  }

  static bool is_name(const std::string& name, bool dots) {
    bool begins = true;
    for (const char c : name) {
      const bool letter = c >= 'a' && c <= 'z';
      if (begins ? !letter : !(letter || (c >= '0' && c <= '9') || c == '_' || (dots && c == '.'))) return false;
      begins = c == '.';
    }
    return !begins;
  }

  void texts() {
    if (d_.struct_size < sizeof d_) wrong("struct_size " + std::to_string(d_.struct_size) + " is smaller than the ABI's");
    text(d_.summary, "summary", true);
    text(d_.doc, "doc", false);
    text(d_.references, "references", false);
    text(d_.roles, "roles", false);
    if (!(d_.cost_ns >= 0.0) || std::isinf(d_.cost_ns)) wrong("cost_ns is not a finite number of at least 0");
    if (text(d_.id, "id", true)) {
      const std::string id = d_.id;
      const auto dot = id.find('.');
      if (!is_name(id, true) || dot == std::string::npos || id.find('.', dot + 1) != std::string::npos) {
        wrong("id '" + id + "' has not the form family.name");
      }
    }
    const bool streams = [&] {
      for (std::uint32_t i = 0; i < d_.port_count; ++i) {
        if (d_.ports[i]->kind == BF_STREAM) return true;
      }
      return false;
    }();
    if ((d_.flags & BF_BLOCK_ASYNCHRONOUS) != 0 && streams) wrong("is asynchronous although it has stream ports");
  }

  void port(const bf_port_descriptor* p) {
    if (p == nullptr) return wrong("a port is a null pointer");
    if (!text(p->name, "a port's name", true)) return;
    const std::string what = "port '" + std::string(p->name) + "'";
    if (p->struct_size < sizeof *p) wrong(what + ": struct_size is smaller than the ABI's");
    if (!is_name(p->name, false)) wrong(what + ": name is not a word of lower-case letters, digits and _");
    if (p->kind != BF_STREAM && p->kind != BF_MESSAGE) wrong(what + ": kind " + std::to_string(p->kind) + " is unknown");
    if (p->direction != BF_IN && p->direction != BF_OUT)
      wrong(what + ": direction " + std::to_string(p->direction) + " is unknown");
    if (p->kind == BF_STREAM && p->element != BF_F64 && p->element != BF_C64 && p->element != BF_ANY) {
      wrong(what + ": streams do not carry element type " + std::to_string(p->element));
    }
    if (p->direction == BF_OUT && (p->flags & BF_PORT_OPTIONAL) != 0) wrong(what + ": only inputs can be optional");
    if (!port_names_.insert({p->direction, p->name}).second) wrong(what + ": name stands twice");
  }

  void parameter(const bf_parameter_descriptor* p) {
    if (p == nullptr) return wrong("a parameter is a null pointer");
    if (!text(p->name, "a parameter's name", true)) return;
    const std::string what = "parameter '" + std::string(p->name) + "'";
    if (p->struct_size < sizeof *p) wrong(what + ": struct_size is smaller than the ABI's");
    if (!is_name(p->name, true)) wrong(what + ": name is not made of words of lower-case letters, digits and _");
    if (!parameter_names_.insert(p->name).second) wrong(what + ": name stands twice");
    if (p->type < BF_BOOL || p->type > BF_MATRIX) return wrong(what + ": type " + std::to_string(p->type) + " is unknown");
    if (text(p->unit, what + ": unit", false) && !is_known_unit(p->unit))
      wrong(what + ": unit '" + std::string(p->unit) + "' is unknown");
    if (p->doc == nullptr || *p->doc == '\0') wrong(what + ": doc is missing");
    if (!(p->minimum <= p->maximum)) wrong(what + ": range is empty");
    if (p->type == BF_CHOICE && p->choice_count == 0) wrong(what + ": choices are missing");
    fallback(*p, what);
  }

  void fallback(const bf_parameter_descriptor& p, const std::string& what) {
    const bf_parameter_value& v = p.fallback;
    if (v.rows == 0) return;
    if ((p.flags & BF_PARAMETER_REQUIRED) != 0) wrong(what + ": is required and has a default");
    const auto in_range = [&](double x) {
      const bool above = (p.flags & BF_PARAMETER_EXCLUSIVE_MIN) != 0 ? x > p.minimum : x >= p.minimum;
      const bool below = (p.flags & BF_PARAMETER_EXCLUSIVE_MAX) != 0 ? x < p.maximum : x <= p.maximum;
      if (!above || !below) wrong(what + ": default is out of its range");
    };
    if (p.type == BF_INTEGER) in_range(static_cast<double>(v.integer));
    for (std::uint32_t i = 0; (p.type == BF_NUMBER || p.type == BF_NUMBERS) && i < v.rows; ++i) in_range(v.numbers[i]);
    for (std::uint32_t i = 0; p.type == BF_INTEGERS && i < v.rows; ++i) in_range(static_cast<double>(v.integers[i]));
    if (p.type != BF_CHOICE) return;
    for (std::uint32_t i = 0; i < p.choice_count; ++i) {
      if (std::string(p.choices[i]) == v.strings[0]) return;
    }
    wrong(what + ": default '" + v.strings[0] + "' is none of the choices");
  }

  const bf_block_descriptor& d_;
  std::vector<std::string> problems_;
  std::set<std::pair<std::uint32_t, std::string>> port_names_;
  std::set<std::string> parameter_names_;
};

}  // namespace

std::vector<std::string> plugin_problems(const bf_plugin& plugin, const bf_factory* const* factories, std::uint32_t count) {
  std::vector<std::string> problems;
  if (plugin.name == nullptr || *plugin.name == '\0') problems.push_back("the plugin has no name");
  if (plugin.version == nullptr || *plugin.version == '\0') problems.push_back("the plugin has no version");
  if (count == 0) problems.push_back("the plugin has no factories");
  std::set<std::string> ids;
  for (std::uint32_t i = 0; i < count; ++i) {
    const bf_factory* f = factories[i];
    if (f == nullptr || f->kind == nullptr || f->id == nullptr || f->create == nullptr) {
      problems.push_back("factory " + std::to_string(i) + " is incomplete");
    } else if (!ids.insert(f->id).second) {
      problems.push_back(std::string("id '") + f->id + "' stands twice");
    }
  }
  return problems;
}

std::vector<std::string> effect_problems(const bf_factory& factory) {
  const auto* effect = static_cast<const bf_effect_descriptor*>(factory.descriptor);
  if (effect == nullptr) return {"descriptor is a null pointer"};
  if (effect->struct_size < sizeof *effect)
    return {"struct_size " + std::to_string(effect->struct_size) + " is smaller than the ABI's"};
  if (effect->id == nullptr || std::string(effect->id) != factory.id) return {"factory and descriptor have other ids"};
  for (const char* text : {effect->id, effect->summary, effect->doc, effect->references, effect->separation}) {
    if (text != nullptr && !is_text(text)) return {"a text is not UTF-8"};
  }
  if (effect->acts < BF_ACTS_LAW || effect->acts > BF_ACTS_TONE)
    return {"way to act " + std::to_string(effect->acts) + " is unknown"};
  if ((effect->kind_count != 0 && effect->kinds == nullptr) || (effect->equivalent_count != 0 && effect->equivalents == nullptr))
    return {"the kinds of places or the equivalents are a null pointer"};
  try {
    (void)EffectType(effect_description(*effect));
  } catch (const Failure& failure) {
    return {failure.what()};
  }
  return {};
}

std::vector<std::string> descriptor_problems(const bf_factory& factory) {
  const auto* block = static_cast<const bf_block_descriptor*>(factory.descriptor);
  if (block == nullptr) return {"descriptor is a null pointer"};
  std::vector<std::string> problems = Checker(*block).run();
  if (std::string(factory.kind) == "base_model" && block->port_count != 0) problems.push_back("a base model has no ports");
  if (block->id != nullptr && std::string(block->id) != factory.id) {
    problems.push_back(std::string("factory has the id '") + factory.id + "', descriptor '" + block->id + "'");
  }
  return problems;
}

}  // namespace bodeflow::testing
