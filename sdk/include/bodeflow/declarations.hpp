#pragma once

#include <bodeflow/describe.hpp>
#include <bodeflow/parameter_text.hpp>
#include <bodeflow/words.hpp>
#include <cstdio>

namespace bodeflow {
namespace detail {

inline std::string short_number(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.12g", x);
  return text;
}

/// "at least 1", "above 0 and at most 10".
inline std::string range_of(const ParameterDraft& p) {
  std::string text;
  if (!std::isinf(p.minimum)) text = (p.exclusive_minimum ? "above " : "at least ") + short_number(p.minimum);
  if (!std::isinf(p.maximum))
    text += (text.empty() ? "" : " and ") + std::string(p.exclusive_maximum ? "below " : "at most ") + short_number(p.maximum);
  return text;
}

/// Throws Failure where a value is out of the range or none of the choices.
inline void check_value(const ParameterDraft& p, const StoredValue& value) {
  const auto in_range = [&](double x) {
    if (!std::isfinite(x)) fail("found " + short_number(x) + ", allowed: a finite number");
    const bool low = p.exclusive_minimum ? x > p.minimum : x >= p.minimum;
    const bool high = p.exclusive_maximum ? x < p.maximum : x <= p.maximum;
    if (!low || !high) fail("found " + short_number(x) + ", allowed: " + range_of(p));
  };
  if (p.type == BF_INTEGER) in_range(static_cast<double>(value.integer));
  for (const double x : value.numbers) in_range(x);
  for (const std::int64_t x : value.integers) in_range(static_cast<double>(x));
  if (p.type != BF_CHOICE) return;
  if (std::find(p.choices.begin(), p.choices.end(), value.strings[0]) != p.choices.end()) return;
  fail("found '" + value.strings[0] + "', allowed: " + listed(p.choices) + meant(value.strings[0], p.choices));
}

inline bool is_called(const ParameterDraft& p, std::string_view name) {
  return p.name == name || (" " + p.aliases + " ").find(" " + std::string(name) + " ") != std::string::npos;
}

}  // namespace detail

inline namespace v0 {

/// The values of all described parameters, those of `declarations` ("name=value") in the place of the defaults. Throws Failure
/// with what was found and what is allowed; `owner` stands before it.
inline std::vector<StoredValue> declared_values(const std::vector<ParameterDraft>& parameters,
                                                const std::vector<std::string>& declarations, const std::string& owner) {
  std::vector<StoredValue> values;
  std::vector<std::string> names;
  for (const ParameterDraft& p : parameters) {
    values.push_back(p.fallback);
    values.back().type = p.type;
    names.push_back(p.name);
  }
  for (const std::string& declaration : declarations) {
    const std::size_t equals = declaration.find('=');
    if (equals == std::string::npos) fail(owner + ": '" + declaration + "' has not the form name=value");
    const std::string name(detail::trimmed(std::string_view(declaration).substr(0, equals)));
    std::size_t i = 0;
    while (i < parameters.size() && !detail::is_called(parameters[i], name)) ++i;
    if (name.empty() || i == parameters.size()) {
      fail(owner + " declares no '" + name + "'" + detail::meant(name, names) + "; it declares: " + detail::listed(names));
    }
    const std::string where = owner + ": " + parameters[i].name + ": ";
    if (values[i].given) fail(where + "stands twice");
    auto value = parse_value(parameters[i].type, parameters[i].unit.c_str(), std::string_view(declaration).substr(equals + 1));
    if (!value) fail(where + value.error().text);
    try {
      detail::check_value(parameters[i], *value);
    } catch (const Failure& failure) {
      fail(where + failure.what());
    }
    values[i] = std::move(*value);
  }
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (parameters[i].required && !values[i].given)
      fail(owner + " needs '" + parameters[i].name + "'; declare " + parameters[i].name + "=...");
  }
  return values;
}

}  // namespace v0
}  // namespace bodeflow
