#include "phases/condition.hpp"

#include <fmt/format.h>

#include <bodeflow/record.hpp>

namespace bodeflow::phases {
namespace {

template <class T>
bool compare(const std::string& operation, const T& a, const T& b) {
  if (operation == "==") return a == b;
  if (operation == "!=") return a != b;
  if (operation == "<") return a < b;
  if (operation == "<=") return a <= b;
  if (operation == ">") return a > b;
  return a >= b;
}

bool is_order(const std::string& operation) { return operation != "==" && operation != "!="; }

}  // namespace

tl::expected<bool, Problem> holds(const graph::Condition& condition, const SharedRecord& record) {
  const auto problem = [&](const std::string& text) { return tl::unexpected(Problem{condition.place, text}); };
  const std::string name = fmt::format("'${}.{}.{}.{}'", condition.phase, condition.block, condition.port, condition.attribute);
  if (!record) return problem(fmt::format("condition {}: block '{}' sent no record", name, condition.block));
  const auto checked = RecordView::check({record.bytes(), record.size()});
  if (!checked) return problem(fmt::format("condition {}: {}", name, checked.error().text));
  const RecordView view = *checked;

  const auto boolean = view.boolean(condition.attribute);
  const auto number = view.number(condition.attribute);
  const auto text = view.text(condition.attribute);
  if (!boolean && !number && !text)
    return problem(fmt::format("condition {}: record '{}' has no such attribute of one value", name, view.type()));

  if (condition.comparison.empty()) {
    if (boolean) return *boolean;
    if (number) return *number != 0.0;
    return problem(fmt::format("condition {} is a text; compare it with == or !=", name));
  }
  if (boolean) {
    const bool* value = std::get_if<bool>(&condition.value);
    if (value == nullptr || is_order(condition.comparison))
      return problem(fmt::format("condition {} is true or false; compare it with == or != true or false", name));
    return compare(condition.comparison, *boolean, *value);
  }
  if (number) {
    const double* value = std::get_if<double>(&condition.value);
    if (value == nullptr) return problem(fmt::format("condition {} is a number; compare it with a number", name));
    return compare(condition.comparison, *number, *value);
  }
  const std::string* value = std::get_if<std::string>(&condition.value);
  if (value == nullptr || is_order(condition.comparison))
    return problem(fmt::format("condition {} is a text; compare it with == or != a text", name));
  return compare(condition.comparison, std::string(*text), *value);
}

}  // namespace bodeflow::phases
