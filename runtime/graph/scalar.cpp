#include "graph/scalar.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bodeflow/units.hpp>
#include <charconv>
#include <cmath>

namespace bodeflow::graph {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// 010 is eight for YAML 1.1 and ten for a person.
bool is_octal(std::string_view text) {
  if (!text.empty() && (text.front() == '+' || text.front() == '-')) text.remove_prefix(1);
  return text.size() > 1 && text[0] == '0' && is_digit(text[1]);
}

std::string octal(std::string_view text) {
  return fmt::format("found {}, which YAML reads as octal; write it without the leading zero", quote(text));
}

/// Where the imaginary part of a complex number begins: at its sign, not that of an exponent; 0: there is no real part.
std::size_t imaginary_part(std::string_view text) {
  for (std::size_t i = text.size(); i-- > 1;) {
    if (text[i] != '+' && text[i] != '-') continue;
    if (text[i - 1] != 'e' && text[i - 1] != 'E') return i;
  }
  return 0;
}

/// Ends with j or i as a number's factor, not as the end of a unit.
bool is_imaginary(std::string_view text) {
  if (text.empty() || (text.back() != 'j' && text.back() != 'i')) return false;
  return text.size() == 1 || is_digit(text[text.size() - 2]) ||
         std::string_view("+-. ").find(text[text.size() - 2]) != std::string_view::npos;
}

}  // namespace

tl::expected<double, std::string> number_of(std::string_view text, const std::string& unit) {
  text = trimmed(text);
  if (is_octal(text)) return tl::unexpected(octal(text));
  const auto value = bodeflow::convert(text, unit);
  if (!value) return tl::unexpected(value.error().text);
  if (!std::isfinite(*value)) return tl::unexpected(fmt::format("found {}, allowed: a finite number", quote(text)));
  return *value;
}

tl::expected<std::int64_t, std::string> integer_of(std::string_view text) {
  text = trimmed(text);
  if (is_octal(text)) return tl::unexpected(octal(text));
  const std::string_view digits = !text.empty() && text.front() == '+' ? text.substr(1) : text;
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc::result_out_of_range)
    return tl::unexpected(fmt::format("found {}, which does not fit into 64 bits", quote(text)));
  if (error != std::errc() || end != digits.data() + digits.size() || (digits.size() < text.size() && digits.front() == '-'))
    return tl::unexpected(fmt::format("found {}, allowed: a whole number", quote(text)));
  return value;
}

tl::expected<std::complex<double>, std::string> complex_of(std::string_view text, const std::string& unit) {
  text = trimmed(text);
  if (!is_imaginary(text)) {
    const auto real = number_of(text, unit);
    if (!real) return tl::unexpected(real.error());
    return std::complex<double>(*real, 0.0);
  }
  const std::string_view sum = text.substr(0, text.size() - 1);
  const std::size_t split = imaginary_part(sum);
  const auto part = [&](std::string_view words) {
    std::string compact;
    for (const char c : words)
      if (c != ' ') compact += c;
    if (compact.empty() || compact == "+" || compact == "-") compact += "1";
    return number_of(compact, unit);
  };
  const auto imaginary = part(sum.substr(split));
  const auto real = split == 0 ? tl::expected<double, std::string>(0.0) : part(sum.substr(0, split));
  if (!real || !imaginary)
    return tl::unexpected(fmt::format("found {}, allowed: a complex number such as -2+3j or [-2, 3]", quote(text)));
  return std::complex<double>(*real, *imaginary);
}

tl::expected<bool, std::string> boolean_of(std::string_view text) {
  if (text == "true") return true;
  if (text == "false") return false;
  return tl::unexpected(fmt::format("found {}, allowed: true, false", quote(text)));
}

namespace {

template <class T, class Parse>
std::optional<T> read(const Node& node, const std::string& where, const char* allowed, Report& report, Parse parse) {
  if (node.broken) return {};
  if (!node.is_scalar()) {
    report.add(node.spot, fmt::format("{}: found {}, allowed: {}", where, what(node), allowed));
    return {};
  }
  tl::expected<T, std::string> value = parse(node.text);
  if (value) return std::move(*value);
  report.add(node.spot, fmt::format("{}: {}", where, value.error()));
  return {};
}

}  // namespace

std::optional<double> read_number(const Node& node, const std::string& where, const std::string& unit, Report& report) {
  return read<double>(node, where, "a number", report, [&](const std::string& text) { return number_of(text, unit); });
}

std::optional<std::int64_t> read_integer(const Node& node, const std::string& where, std::int64_t least, std::int64_t most,
                                         Report& report) {
  return read<std::int64_t>(node, where, "a whole number", report,
                            [&](const std::string& text) -> tl::expected<std::int64_t, std::string> {
                              auto value = integer_of(text);
                              if (value && (*value < least || *value > most))
                                return tl::unexpected(fmt::format("found {}, allowed: {} to {}", *value, least, most));
                              return value;
                            });
}

std::optional<std::string> read_text(const Node& node, const std::string& where, Report& report) {
  return read<std::string>(node, where, "a text", report,
                           [](const std::string& text) { return tl::expected<std::string, std::string>(text); });
}

std::optional<std::string> read_choice(const Node& node, const std::string& where, const std::vector<std::string>& choices,
                                       Report& report) {
  const std::string allowed = listed(choices);
  return read<std::string>(
      node, where, allowed.c_str(), report, [&](const std::string& text) -> tl::expected<std::string, std::string> {
        if (std::find(choices.begin(), choices.end(), text) != choices.end()) return text;
        return tl::unexpected(fmt::format("found {}, allowed: {}{}", quote(text), allowed, did_you_mean(text, choices)));
      });
}

}  // namespace bodeflow::graph
