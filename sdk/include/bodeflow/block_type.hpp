#pragma once

#include <algorithm>
#include <bodeflow/describe.hpp>
#include <bodeflow/words.hpp>
#include <cmath>
#include <string>
#include <vector>

namespace bodeflow {
inline namespace v0 {

/// The checked description of a class of blocks or base models and the C descriptor that points into it. Lives as long as the
/// plugin.
class BlockType {
 public:
  /// Throws Failure with everything that is wrong with the draft, a line each. `kind` is what messages call it.
  explicit BlockType(BlockDraft draft, const char* kind = "block") : draft_(std::move(draft)), kind_(kind) {
    check();
    build();
  }
  BlockType(const BlockType&) = delete;
  BlockType& operator=(const BlockType&) = delete;

  const BlockDraft& draft() const { return draft_; }
  const bf_block_descriptor& c() const { return descriptor_; }

  int count(std::uint32_t kind, std::uint32_t direction) const {
    int n = 0;
    for (const PortDraft& p : draft_.ports) n += p.kind == kind && p.direction == direction ? 1 : 0;
    return n;
  }
  const PortDraft& port(std::uint32_t kind, std::uint32_t direction, int index) const {
    for (const PortDraft& p : draft_.ports) {
      if (p.kind == kind && p.direction == direction && p.index == index) return p;
    }
    fail("block " + draft_.id + " has no such port");
  }

 private:
  void wrong(const std::string& what) {
    if (!problems_.empty()) problems_ += '\n';
    problems_ += kind_ + " '" + draft_.id + "': " + what;
  }

  void check() {
    if (!detail::is_dotted(draft_.id, 2, 2)) wrong("id has not the form family.name (lower-case letters, digits, _)");
    if (draft_.summary.empty()) wrong("summary is missing");
    if (!(draft_.cost_ns >= 0.0) || std::isinf(draft_.cost_ns)) wrong("cost_ns is not a finite number of at least 0");
    check_ports();
    for (std::size_t i = 0; i < draft_.parameters.size(); ++i) check_parameter(i);
    if (!problems_.empty()) fail(problems_);
  }

  void check_ports() {
    int next[2][2] = {{0, 0}, {0, 0}};
    for (std::size_t i = 0; i < draft_.ports.size(); ++i) {
      const PortDraft& p = draft_.ports[i];
      const char* kind = p.kind == BF_STREAM ? "stream" : "message";
      const char* direction = p.direction == BF_IN ? "input" : "output";
      const std::string what = std::string(kind) + " " + direction + " '" + p.name + "'";
      if (!detail::is_word(p.name)) wrong(what + ": name is not a word of lower-case letters, digits and _");
      int& expected = next[p.kind == BF_STREAM ? 0 : 1][p.direction == BF_IN ? 0 : 1];
      if (p.index != expected) {
        wrong(what + " has index " + std::to_string(p.index) + ", but stands at place " + std::to_string(expected) +
              " among the " + kind + " " + direction + "s");
      }
      ++expected;
      for (std::size_t j = 0; j < i; ++j) {
        if (draft_.ports[j].name == p.name && draft_.ports[j].direction == p.direction) wrong(what + ": name stands twice");
      }
      if (p.optional && p.direction != BF_IN) wrong(what + ": only inputs can be optional");
      if (p.kind == BF_STREAM && !p.record_type.empty()) wrong(what + ": only message ports have a record type");
      check_same_as(p, what);
    }
    if ((draft_.flags & BF_BLOCK_ASYNCHRONOUS) != 0 && (next[0][0] > 0 || next[0][1] > 0)) {
      wrong("asynchronous is for blocks with message ports alone");
    }
  }

  void check_same_as(const PortDraft& p, const std::string& what) {
    if (p.same_as < 0) return;
    if (p.kind != BF_STREAM || p.direction != BF_OUT) return wrong(what + ": same_as is for stream outputs");
    for (const PortDraft& in : draft_.ports) {
      if (in.kind != BF_STREAM || in.direction != BF_IN || in.index != p.same_as) continue;
      if (p.element == BF_ANY && in.element != BF_ANY) return;
      if (p.element != BF_ANY && in.element != BF_ANY && p.element != in.element) {
        wrong(what + " is same_as '" + in.name + "', but carries " + element_name(p.element) + ", not " +
              element_name(in.element));
      }
      return;
    }
    wrong(what + ": same_as names a stream input that is not described");
  }

  void check_parameter(std::size_t i) {
    ParameterDraft& p = draft_.parameters[i];
    const std::string what = "parameter '" + p.name + "'";
    if (!detail::is_dotted(p.name, 1, 4)) wrong(what + ": name is not made of words of lower-case letters, digits and _");
    const std::vector<std::string> names = names_of(p);
    for (std::size_t j = 0; j < i; ++j) {
      for (const std::string& other : names_of(draft_.parameters[j])) {
        for (const std::string& name : names) {
          if (name == other) wrong("parameter name '" + name + "' stands twice");
          if (name.rfind(other + ".", 0) == 0 || other.rfind(name + ".", 0) == 0) {
            wrong("parameter '" + name + "' and '" + other + "': one is a group in the other's name");
          }
        }
      }
    }
    const bool ranged = p.type == BF_INTEGER || p.type == BF_NUMBER || p.type == BF_NUMBERS || p.type == BF_INTEGERS;
    const bool limited = !std::isinf(p.minimum) || !std::isinf(p.maximum);
    if (limited && !ranged) wrong(what + ": only numbers and integers have a range");
    if (!(p.minimum <= p.maximum)) wrong(what + ": range is empty");
    if (!p.unit.empty() && p.type != BF_NUMBER && p.type != BF_NUMBERS) wrong(what + ": only numbers have a unit");
    if (!p.choices.empty() && p.type != BF_CHOICE) wrong(what + ": only texts have choices");
    if (p.type == BF_CHOICE && p.choices.empty()) wrong(what + ": choices are missing");
    check_default(p, what);
  }

  void check_default(ParameterDraft& p, const std::string& what) {
    const StoredValue& v = p.fallback;
    if (p.type == BF_MATRIX && v.numbers.size() != std::size_t{v.rows} * v.columns)
      wrong(what + ": default has not rows x columns values");
    if (p.type == BF_CHOICE && v.rows != 0) {
      bool found = false;
      for (const std::string& choice : p.choices) found = found || choice == v.strings[0];
      if (!found) wrong(what + ": default '" + v.strings[0] + "' is none of the choices");
    }
    if (p.type == BF_INTEGER && v.rows != 0) in_range(p, what, static_cast<double>(v.integer));
    if (p.type == BF_NUMBER || p.type == BF_NUMBERS) {
      for (const double x : v.numbers) in_range(p, what, x);
    }
    for (const std::int64_t x : v.integers) in_range(p, what, static_cast<double>(x));
  }

  void in_range(const ParameterDraft& p, const std::string& what, double x) {
    const bool inside =
        (p.exclusive_minimum ? x > p.minimum : x >= p.minimum) && (p.exclusive_maximum ? x < p.maximum : x <= p.maximum);
    if (!inside) wrong(what + ": default is out of its range");
  }

  static std::vector<std::string> names_of(const ParameterDraft& p) {
    std::vector<std::string> names{p.name};
    std::size_t begin = 0;
    while (begin < p.aliases.size()) {
      const std::size_t end = std::min(p.aliases.find(' ', begin), p.aliases.size());
      names.push_back(p.aliases.substr(begin, end - begin));
      begin = end + 1;
    }
    return names;
  }

  static const char* or_null(const std::string& text) { return text.empty() ? nullptr : text.c_str(); }

  void build() {
    ports_.reserve(draft_.ports.size());
    for (const PortDraft& p : draft_.ports) {
      ports_.push_back({sizeof(bf_port_descriptor), p.kind, p.direction, p.optional ? std::uint32_t{BF_PORT_OPTIONAL} : 0u,
                        p.element, p.name.c_str(), or_null(p.record_type), p.doc.c_str()});
    }
    words_.reserve(2 * draft_.parameters.size());
    parameters_.reserve(draft_.parameters.size());
    for (const ParameterDraft& p : draft_.parameters) parameters_.push_back(parameter(p));
    for (const auto& p : ports_) port_places_.push_back(&p);
    for (const auto& p : parameters_) parameter_places_.push_back(&p);
    descriptor_.struct_size = sizeof descriptor_;
    descriptor_.flags = draft_.flags;
    descriptor_.port_count = static_cast<std::uint32_t>(ports_.size());
    descriptor_.parameter_count = static_cast<std::uint32_t>(parameters_.size());
    descriptor_.id = draft_.id.c_str();
    descriptor_.summary = draft_.summary.c_str();
    descriptor_.doc = draft_.doc.c_str();
    descriptor_.references = draft_.references.c_str();
    descriptor_.roles = draft_.roles.c_str();
    descriptor_.cost_ns = draft_.cost_ns;
    descriptor_.ports = port_places_.data();
    descriptor_.parameters = parameter_places_.data();
  }

  const char* const* words(const std::vector<std::string>& texts) {
    std::vector<const char*> places;
    for (const std::string& t : texts) places.push_back(t.c_str());
    words_.push_back(std::move(places));
    return words_.back().data();
  }

  bf_parameter_descriptor parameter(const ParameterDraft& p) {
    bf_parameter_descriptor d{};
    d.struct_size = sizeof d;
    d.type = p.type;
    d.flags = (p.required ? std::uint32_t{BF_PARAMETER_REQUIRED} : 0u) | (p.live ? std::uint32_t{BF_PARAMETER_LIVE} : 0u) |
              (p.exclusive_minimum ? std::uint32_t{BF_PARAMETER_EXCLUSIVE_MIN} : 0u) |
              (p.exclusive_maximum ? std::uint32_t{BF_PARAMETER_EXCLUSIVE_MAX} : 0u);
    d.choice_count = static_cast<std::uint32_t>(p.choices.size());
    d.name = p.name.c_str();
    d.unit = p.unit.c_str();
    d.doc = p.doc.c_str();
    d.choices = words(p.choices);
    d.aliases = or_null(p.aliases);
    d.minimum = p.minimum;
    d.maximum = p.maximum;
    d.fallback.struct_size = sizeof d.fallback;
    d.fallback.type = p.type;
    d.fallback.rows = p.fallback.rows;
    d.fallback.columns = p.fallback.columns;
    d.fallback.integer = p.fallback.integer;
    d.fallback.numbers = p.fallback.numbers.data();
    d.fallback.integers = p.fallback.integers.data();
    d.fallback.strings = words(p.fallback.strings);
    return d;
  }

  BlockDraft draft_;
  std::string kind_;
  std::string problems_;
  std::vector<bf_port_descriptor> ports_;
  std::vector<bf_parameter_descriptor> parameters_;
  std::vector<std::vector<const char*>> words_;  ///< moving the inner vectors keeps their places
  std::vector<const bf_port_descriptor*> port_places_;
  std::vector<const bf_parameter_descriptor*> parameter_places_;
  bf_block_descriptor descriptor_{};
};

}  // namespace v0
}  // namespace bodeflow
