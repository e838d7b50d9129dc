#pragma once

#include <bodeflow/unit.hpp>
#include <cctype>

namespace bodeflow {

/// Edits (insert, delete, replace, swap of neighbours) that lead from one word to the other.
inline std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) {
    for (std::size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        d[i][j] = i + j;
        continue;
      }
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0u : 1u)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  }
  return d[a.size()][b.size()];
}

/// The symbol that somebody meant who wrote a unit that does not exist ("sec" -> "s", "khz" -> "kHz"), or "".
inline std::string nearest_unit(std::string_view found) {
  static const std::vector<std::pair<std::string_view, const char*>> words = {
      {"sec", "s"},       {"second", "s"},        {"seconds", "s"},  {"msec", "ms"},     {"usec", "us"},  {"minute", "min"},
      {"minutes", "min"}, {"hour", "h"},          {"hours", "h"},    {"volt", "V"},      {"volts", "V"},  {"amp", "A"},
      {"amps", "A"},      {"ampere", "A"},        {"hertz", "Hz"},   {"ohms", "ohm"},    {"henry", "H"},  {"farad", "F"},
      {"watt", "W"},      {"watts", "W"},         {"newton", "N"},   {"metre", "m"},     {"meter", "m"},  {"meters", "m"},
      {"degree", "deg"},  {"degrees", "deg"},     {"radian", "rad"}, {"radians", "rad"}, {"kelvin", "K"}, {"tesla", "T"},
      {"percent", "%"},   {"revolutions", "rev"}, {"gram", "g"},     {"kilogram", "kg"}};
  const auto lower = [](std::string_view text) {
    std::string out(text);
    for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return out;
  };
  if (found.size() > 16) return {};
  const std::string small = lower(found);
  for (const auto& [word, symbol] : words) {
    if (small == word) return symbol;
  }
  std::string best;
  std::size_t best_distance = found.size() < 2 ? 1 : 2;  // in halves beyond case: one edit at most, none for a single letter
  const auto consider = [&](const std::string& candidate) {
    const std::size_t distance = edit_distance(small, lower(candidate));
    if (distance < best_distance) {
      best_distance = distance;
      best = candidate;
    }
  };
  for (const NamedUnit& u : named_units()) consider(u.name);
  for (const char* prefix : {"k", "m", "u", "n", "M", "p", "G"}) {
    for (const NamedUnit& u : named_units()) {
      if (u.prefixes) consider(std::string(prefix) + u.name);
    }
  }
  return best;
}

namespace detail {

/// Reads "kg m^2/s^2", "Nm/(rad/s)", "1/min": factors side by side or with '*' or a middle dot multiply, '/' divides by the
/// one factor that follows.
class UnitParser {
 public:
  explicit UnitParser(std::string_view text) : text_(text) {}

  Expected<Unit, Error> run() {
    try {
      const Unit unit = product(0);
      if (at_ != text_.size()) fail("unit '" + std::string(text_) + "': unexpected '" + std::string(text_.substr(at_, 1)) + "'");
      return unit;
    } catch (const Failure& failure) {
      return unexpected(failure.what());
    }
  }

 private:
  static constexpr std::string_view kDot = "\u00B7";

  void skip_spaces() {
    while (at_ < text_.size() && text_[at_] == ' ') ++at_;
  }
  bool accept(std::string_view token) {
    if (text_.substr(at_, token.size()) != token) return false;
    at_ += token.size();
    return true;
  }
  bool starts_factor() const {
    return at_ < text_.size() && text_[at_] != ')' && text_[at_] != '/' && text_[at_] != '^' && text_[at_] != '*';
  }

  Unit product(int depth) {
    if (depth > 8) fail("unit '" + std::string(text_.substr(0, 80)) + "': too many brackets");
    skip_spaces();
    Unit unit = factor(depth);
    while (true) {
      skip_spaces();
      if (accept("/")) {
        skip_spaces();
        multiply(unit, power(factor(depth), -2));
      } else if (accept("*") || accept(kDot)) {
        skip_spaces();
        multiply(unit, factor(depth));
      } else if (starts_factor()) {
        multiply(unit, factor(depth));
      } else {
        return unit;
      }
    }
  }

  Unit factor(int depth) {
    Unit unit;
    if (accept("(")) {
      unit = product(depth + 1);
      if (!accept(")")) fail("unit '" + std::string(text_) + "': ')' is missing");
    } else {
      unit = named();
    }
    if (accept("^")) return power(unit, exponent());
    if (accept("\u00B2")) return power(unit, 4);
    if (accept("\u00B3")) return power(unit, 6);
    return unit;
  }

  Unit named() {
    std::size_t end = at_;
    const auto stops = [&](std::size_t i) {
      const char c = text_[i];
      const std::string_view two = text_.substr(i, 2);
      return c == ' ' || c == '/' || c == '*' || c == '^' || c == '(' || c == ')' || two == kDot || two == "\u00B2" ||
             two == "\u00B3";
    };
    while (end < text_.size() && !stops(end)) ++end;
    const std::string_view name = text_.substr(at_, end - at_);
    if (name.empty()) fail("unit '" + std::string(text_) + "' is not complete");
    auto unit = find_unit(name);
    if (!unit && name.size() > 1 && name.back() >= '2' && name.back() <= '4') {  // "m2", "s2"
      unit = find_unit(name.substr(0, name.size() - 1));
      if (unit) unit = power(*unit, 2 * (name.back() - '0'));
    }
    if (!unit) {
      const std::string near = nearest_unit(name);
      fail("unknown unit '" + std::string(name.substr(0, 80)) + "'" + (near.empty() ? "" : " (did you mean '" + near + "'?)"));
    }
    at_ = end;
    return *unit;
  }

  /// Twice the exponent: whole numbers and halves from -9 to 9.
  int exponent() {
    const bool bracket = accept("(");
    const bool negative = accept("-");
    if (at_ >= text_.size() || text_[at_] < '0' || text_[at_] > '9')
      fail("unit '" + std::string(text_) + "': exponent is missing");
    int twice = 2 * (text_[at_++] - '0');
    if (at_ < text_.size() && text_[at_] >= '0' && text_[at_] <= '9')
      fail("unit '" + std::string(text_) + "': exponent is above 9");
    if (accept(".5")) ++twice;
    if (bracket && !accept(")")) fail("unit '" + std::string(text_) + "': ')' is missing");
    return negative ? -twice : twice;
  }

  Unit power(const Unit& unit, int twice) const {
    Unit result;
    for (std::size_t i = 0; i < unit.dimension.size(); ++i) result.dimension[i] = half(unit.dimension[i] * twice);
    result.decimal = half(unit.decimal * twice);
    result.pi = half(unit.pi * twice);
    if (unit.numerator == 1 && unit.denominator == 1) return result;
    if (twice % 2 != 0) fail("unit '" + std::string(text_) + "': no root of that unit");
    Unit base;
    base.numerator = twice < 0 ? unit.denominator : unit.numerator;
    base.denominator = twice < 0 ? unit.numerator : unit.denominator;
    for (int i = 0; i < std::abs(twice) / 2; ++i) multiply(result, base);
    return result;
  }

  int half(int value) const {
    if (value % 2 != 0) fail("unit '" + std::string(text_) + "': no root of that unit");
    return value / 2;
  }

  void multiply(Unit& a, const Unit& b) const {
    for (std::size_t i = 0; i < a.dimension.size(); ++i) {
      a.dimension[i] += b.dimension[i];
      if (std::abs(a.dimension[i]) > 100) fail("unit '" + std::string(text_.substr(0, 80)) + "': exponent is too large");
    }
    const std::int64_t g1 = std::gcd(a.numerator, b.denominator), g2 = std::gcd(b.numerator, a.denominator);
    a.numerator = product_of(a.numerator / g1, b.numerator / g2);
    a.denominator = product_of(a.denominator / g2, b.denominator / g1);
    a.decimal += b.decimal;
    a.pi += b.pi;
    a.offset = 0.0;  // part of a product: a difference of temperatures
  }

  std::int64_t product_of(std::int64_t a, std::int64_t b) const {
    constexpr std::int64_t kExact = std::int64_t{1} << 53;  // beyond it, a factor would not be exact as a double
    if (a > kExact / b) fail("unit '" + std::string(text_.substr(0, 80)) + "': factor is too large");
    return a * b;
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

}  // namespace detail

/// The unit that a text names. Error: unknown (with the nearest that exists), or not well formed.
inline Expected<Unit, Error> parse_unit(std::string_view text) { return detail::UnitParser(text).run(); }

}  // namespace bodeflow
