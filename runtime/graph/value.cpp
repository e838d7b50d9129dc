#include "graph/value.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "graph/scalar.hpp"

namespace bodeflow::graph {
namespace {

/// Reads one parameter; every function returns false once it has reported a problem.
class Reader {
 public:
  Reader(const ParameterDescription& description, const std::string& where, Report& report, const std::string& own_unit)
      : description_(description), where_(where), report_(report), own_unit_(own_unit) {
    value_.type = description.type;
    value_.given = true;
    value_.rows = 1;
  }

  bool read(Node& node) {
    switch (description_.type) {
      case BF_BOOL:
        return boolean(node);
      case BF_INTEGER:
        return integer(node);
      case BF_NUMBER:
        return scalar(node) && number(node, node.text);
      case BF_STRING:
        return text(node);
      case BF_CHOICE:
        return choice(node);
      case BF_FILE:
        return file(node);
      case BF_NUMBERS:
        return list(node, [&](Node& item) { return scalar(item) && number(item, item.text); });
      case BF_INTEGERS:
        return list(node, [&](Node& item) { return scalar(item) && integer_entry(item); });
      case BF_STRINGS:
        return list(node, [&](Node& item) { return text(item); });
      case BF_COMPLEX_LIST:
        return list(node, [&](Node& item) { return complex(item); });
      case BF_MATRIX:
        return matrix(node);
      default:
        return problem(node, fmt::format("parameters of type {} are unknown to this version", description_.type));
    }
  }

  ParameterValue take() { return std::move(value_); }

 private:
  bool problem(const Node& node, const std::string& reason) {
    if (!node.broken) report_.add(node.spot, fmt::format("{}: {}", where_, reason));
    return false;
  }

  bool scalar(const Node& node) {
    return node.is_scalar() && !node.broken
               ? true
               : problem(node, fmt::format("found {}, allowed: {}", what(node), allowed_form(description_)));
  }

  template <class T>
  bool in_range(const Node& node, T number) {
    const auto x = static_cast<double>(number);
    const bool low = description_.exclusive_minimum ? x <= description_.minimum : x < description_.minimum;
    const bool high = description_.exclusive_maximum ? x >= description_.maximum : x > description_.maximum;
    if (!low && !high) return true;
    return problem(node, fmt::format("found {}, allowed: {}", quote(node.text), range_text(description_)));
  }

  const std::string& unit_for(std::string_view written) const {
    const bool own = description_.unit.empty() && !own_unit_.empty() && complex_of(written, own_unit_);
    return own ? own_unit_ : description_.unit;
  }

  bool number(const Node& node, std::string_view written) {
    const auto x = number_of(written, unit_for(written));
    if (!x) return problem(node, x.error());
    value_.numbers.push_back(*x);
    return in_range(node, *x);
  }

  bool boolean(const Node& node) {
    if (!scalar(node)) return false;
    const auto value = boolean_of(node.text);
    if (!value) return problem(node, value.error());
    value_.integer = *value ? 1 : 0;
    return true;
  }

  bool integer(const Node& node) {
    if (!scalar(node)) return false;
    const auto value = integer_of(node.text);
    if (!value) return problem(node, value.error());
    value_.integer = *value;
    return in_range(node, *value);
  }

  bool integer_entry(const Node& node) {
    const auto value = integer_of(node.text);
    if (!value) return problem(node, value.error());
    value_.integers.push_back(*value);
    return in_range(node, *value);
  }

  bool text(const Node& node) {
    if (!scalar(node)) return false;
    value_.strings.push_back(node.text);
    return true;
  }

  bool choice(const Node& node) {
    if (node.broken) return false;
    auto found = read_choice(node, where_, description_.choices, report_);
    if (!found) return false;
    value_.strings.push_back(std::move(*found));
    return true;
  }

  bool file(Node& node) {
    if (!scalar(node)) return false;
    if (node.text.empty()) return problem(node, "found '', allowed: the name of a file");
    const std::filesystem::path path(node.text);
    const std::string folder = node.origin == nullptr ? "" : node.origin->folder;
    node.text = (path.is_absolute() ? path : std::filesystem::path(folder) / path).lexically_normal().string();
    node.exact = false;
    value_.strings.push_back(node.text);
    return true;
  }

  /// A list, or one value for a list of one. A text `a:b` is a list too, as the command line has it.
  template <class Entry>
  bool list(Node& node, Entry entry) {
    if (node.is_scalar() && !node.broken && is_numeric() && node.text.find(':') != std::string::npos) split(node);
    if (node.is_scalar()) return entry(node);
    if (!node.is_list()) return scalar(node);
    bool good = true;
    for (auto& item : node.items) good = entry(item) && good;
    value_.rows = static_cast<std::uint32_t>(node.items.size());
    return good;
  }

  bool is_numeric() const { return description_.type == BF_NUMBERS || description_.type == BF_INTEGERS; }

  static void split(Node& node) {
    Node made;
    made.kind = Node::Kind::list;
    made.flow = true;
    made.spot = node.spot;
    made.origin = node.origin;
    for (std::size_t at = 0; at <= node.text.size();) {
      const auto end = std::min(node.text.find(':', at), node.text.size());
      Node item = node;
      item.exact = false;
      item.text = node.text.substr(at, end - at);
      made.items.push_back(std::move(item));
      at = end + 1;
    }
    node = Node(made);
  }

  bool complex(Node& node) {
    if (node.is_list()) {
      if (node.items.size() != 2 || !node.items[0].is_scalar() || !node.items[1].is_scalar())
        return problem(node, "found a list, allowed: [real, imaginary]");
      return number(node.items[0], node.items[0].text) && number(node.items[1], node.items[1].text);
    }
    if (!scalar(node)) return false;
    const auto value = complex_of(node.text, unit_for(node.text));
    if (!value) return problem(node, value.error());
    value_.numbers.push_back(value->real());
    value_.numbers.push_back(value->imag());
    return true;
  }

  bool matrix(Node& node) {
    if (node.is_scalar()) return scalar(node) && number(node, node.text);
    if (!node.is_list()) return scalar(node);
    value_.rows = static_cast<std::uint32_t>(node.items.size());
    value_.columns = node.items.empty() ? 0 : static_cast<std::uint32_t>(node.items[0].items.size());
    bool good = true;
    for (const auto& row : node.items) {
      if (!row.is_list())
        return problem(row, fmt::format("found {}, allowed: a row such as [1, 2] (a matrix is a list of rows)", what(row)));
      if (row.items.size() != value_.columns)
        return problem(
            row, fmt::format("found a row of {} numbers, allowed: {} as in the first row", row.items.size(), value_.columns));
      for (const auto& item : row.items) good = scalar(item) && number(item, item.text) && good;
    }
    return good;
  }

  const ParameterDescription& description_;
  const std::string& where_;
  Report& report_;
  const std::string& own_unit_;
  ParameterValue value_;
};

std::string number_text(double x) { return fmt::format("{}", x); }

}  // namespace

std::optional<ParameterValue> read_parameter(Node& node, const ParameterDescription& description, const std::string& where,
                                             Report& report, const std::string& own_unit) {
  Reader reader(description, where, report, own_unit);
  if (!reader.read(node)) return {};
  return reader.take();
}

std::string allowed_form(const ParameterDescription& d) {
  const std::string unit = d.unit.empty() || d.unit == "1" ? "" : " [" + d.unit + "]";
  switch (d.type) {
    case BF_BOOL:
      return "true, false";
    case BF_INTEGER:
      return "a whole number";
    case BF_NUMBER:
      return "a number" + unit;
    case BF_STRING:
      return "a text";
    case BF_CHOICE:
      return listed(d.choices);
    case BF_FILE:
      return "the name of a file";
    case BF_NUMBERS:
      return "a list of numbers" + unit;
    case BF_INTEGERS:
      return "a list of whole numbers";
    case BF_STRINGS:
      return "a list of texts";
    case BF_COMPLEX_LIST:
      return "a list of complex numbers such as -2+3j or [-2, 3]" + unit;
    case BF_MATRIX:
      return "a list of rows such as [[1, 2], [3, 4]]" + unit;
    default:
      return "";
  }
}

std::string range_text(const ParameterDescription& d) {
  const std::string unit = d.unit.empty() || d.unit == "1" ? "" : " " + d.unit;
  std::string low, high;
  if (std::isfinite(d.minimum)) low = (d.exclusive_minimum ? "above " : "at least ") + number_text(d.minimum);
  if (std::isfinite(d.maximum)) high = (d.exclusive_maximum ? "below " : "at most ") + number_text(d.maximum);
  if (low.empty() && high.empty()) return "";
  return low + (low.empty() || high.empty() ? "" : " and ") + high + unit;
}

}  // namespace bodeflow::graph
