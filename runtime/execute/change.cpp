#include "execute/change.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>

#include "graph/problem.hpp"

namespace bodeflow::execute {
namespace {

using Error = tl::unexpected<std::string>;

std::vector<std::string> live_names(const BlockDescription& type) {
  std::vector<std::string> names;
  for (const auto& parameter : type.parameters)
    if (parameter.live) names.push_back(parameter.name);
  return names;
}

const char* type_name(std::uint32_t type) {
  switch (type) {
    case BF_BOOL:
      return "a bool";
    case BF_INTEGER:
      return "an integer";
    case BF_NUMBER:
      return "a number";
    case BF_STRING:
    case BF_CHOICE:
    case BF_FILE:
      return "a text";
    case BF_NUMBERS:
      return "a list of numbers";
    case BF_INTEGERS:
      return "a list of integers";
    case BF_STRINGS:
      return "a list of texts";
    case BF_COMPLEX_LIST:
      return "a list of complex numbers";
    case BF_MATRIX:
      return "a matrix";
    default:
      return "a value of an unknown type";
  }
}

std::string text_of(const AttributeView& value) {
  const auto one = [&](std::size_t i) -> std::string {
    switch (value.kind()) {
      case AttributeKind::boolean:
        return value.boolean(i) ? "true" : "false";
      case AttributeKind::integer:
        return fmt::format("{}", value.integer(i));
      case AttributeKind::number:
        return fmt::format("{}", value.number(i));
      default:
        return fmt::format("'{}'", value.text(i));
    }
  };
  if (!value.is_list()) return one(0);
  constexpr std::size_t kShown = 4;
  std::string text = "[";
  for (std::size_t i = 0; i < value.size() && i < kShown; ++i) text += (i > 0 ? ", " : "") + one(i);
  return text + (value.size() > kShown ? ", ...]" : "]");
}

/// The value as the described type, or nothing when the record holds another one.
std::optional<ParameterValue> from_attribute(const ParameterDescription& described, const RecordView& record) {
  ParameterValue value;
  value.rows = 1;
  const auto list = [&](auto&& values, auto& into) -> std::optional<ParameterValue> {
    if (!values) return std::nullopt;
    into.assign(values->begin(), values->end());
    value.rows = static_cast<std::uint32_t>(values->size());
    return value;
  };
  switch (described.type) {
    case BF_BOOL:
      if (const auto found = record.boolean("value")) return value.integer = *found ? 1 : 0, value;
      break;
    case BF_INTEGER:
      if (const auto found = record.integer("value")) return value.integer = *found, value;
      break;
    case BF_NUMBER:
      if (const auto found = record.number("value")) return value.numbers = {*found}, value;
      break;
    case BF_STRING:
    case BF_CHOICE:
    case BF_FILE:
      if (const auto found = record.text("value")) return value.strings = {std::string(*found)}, value;
      break;
    case BF_NUMBERS:
      return list(record.numbers("value"), value.numbers);
    case BF_INTEGERS:
      return list(record.integers("value"), value.integers);
    case BF_STRINGS:
      return list(record.texts("value"), value.strings);
    default:
      break;
  }
  return std::nullopt;
}

std::optional<ParameterValue> from_array(const ParameterDescription& described, const ArrayView& array) {
  ParameterValue value;
  const auto rank = array.shape.size();
  value.rows = rank > 0 ? static_cast<std::uint32_t>(array.shape[0]) : 1;
  const auto* doubles = static_cast<const double*>(array.data);
  if (described.type == BF_NUMBERS && array.element == BF_F64 && rank == 1) {
    value.numbers.assign(doubles, doubles + array.size);
  } else if (described.type == BF_MATRIX && array.element == BF_F64 && rank == 2) {
    value.columns = static_cast<std::uint32_t>(array.shape[1]);
    value.numbers.assign(doubles, doubles + array.size);
  } else if (described.type == BF_COMPLEX_LIST && array.element == BF_C64 && rank == 1) {
    value.numbers.assign(doubles, doubles + 2 * array.size);
  } else if (described.type == BF_INTEGERS && array.element == BF_I64 && rank == 1) {
    const auto integers = array.as<std::int64_t>();
    value.integers.assign(integers.begin(), integers.end());
  } else {
    return std::nullopt;
  }
  return value;
}

std::string allowed_range(const ParameterDescription& p) {
  return fmt::format("{}{} to {}{}", p.exclusive_minimum ? "above " : "", p.minimum, p.exclusive_maximum ? "below " : "",
                     p.maximum);
}

/// "" or what is wrong with the value.
std::string out_of_range(const ParameterDescription& p, const ParameterValue& value) {
  const auto outside = [&](double x) {
    return !((p.exclusive_minimum ? x > p.minimum : x >= p.minimum) && (p.exclusive_maximum ? x < p.maximum : x <= p.maximum));
  };
  const auto wrong = [&](double x) { return fmt::format("parameter '{}': found {}, allowed {}", p.name, x, allowed_range(p)); };
  if (p.type == BF_INTEGER && outside(static_cast<double>(value.integer))) return wrong(static_cast<double>(value.integer));
  if (p.type == BF_NUMBER || p.type == BF_NUMBERS || p.type == BF_MATRIX)
    for (const double x : value.numbers)
      if (outside(x)) return wrong(x);
  for (const std::int64_t x : value.integers)
    if (outside(static_cast<double>(x))) return wrong(static_cast<double>(x));
  if (p.type == BF_CHOICE && std::find(p.choices.begin(), p.choices.end(), value.strings[0]) == p.choices.end())
    return fmt::format("parameter '{}': found '{}', allowed {}{}", p.name, value.strings[0], fmt::join(p.choices, ", "),
                       did_you_mean(value.strings[0], p.choices));
  return "";
}

tl::expected<int, std::string> live_parameter(const BlockDescription& type, const RecordView& record) {
  const auto name = record.text("parameter");
  if (!name) return Error("a parameter_change record needs the text attribute 'parameter'");
  const std::vector<std::string> live = live_names(type);
  const int index = type.parameter(std::string(*name));
  if (index < 0)
    return Error(fmt::format("parameter_change: unknown parameter '{}'{}; live parameters: {}", *name,
                             did_you_mean(std::string(*name), live), fmt::join(live, ", ")));
  if (!type.parameters[static_cast<std::size_t>(index)].live)
    return Error(fmt::format("parameter_change: parameter '{}' can't change while running; live parameters: {}", *name,
                             live.empty() ? "none" : fmt::format("{}", fmt::join(live, ", "))));
  return index;
}

}  // namespace

tl::expected<ParameterChange, std::string> parameter_change(const BlockDescription& type, const RecordView& record) {
  if (record.type() != "parameter_change")
    return Error(fmt::format("found a record of type '{}' for its parameters, allowed 'parameter_change'", record.type()));
  const auto index = live_parameter(type, record);
  if (!index) return Error(index.error());
  const ParameterDescription& described = type.parameters[static_cast<std::size_t>(*index)];

  const auto attribute = record.attribute("value");
  const auto array = record.array("value");
  if (!attribute && !array) return Error(fmt::format("parameter_change of '{}': the record has no 'value'", described.name));
  auto value = attribute ? from_attribute(described, record) : from_array(described, *array);
  if (!value)
    return Error(fmt::format("parameter_change: parameter '{}': found {}, allowed {}", described.name,
                             attribute ? text_of(*attribute) : fmt::format("an array of {}", element_name(array->element)),
                             type_name(described.type)));
  value->type = described.type;
  value->given = true;
  if (std::string wrong = out_of_range(described, *value); !wrong.empty()) return Error("parameter_change: " + wrong);
  return ParameterChange{*index, std::move(*value)};
}

}  // namespace bodeflow::execute
