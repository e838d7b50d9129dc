#pragma once

#include <algorithm>
#include <array>
#include <bodeflow/error.hpp>
#include <cstdint>
#include <numeric>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace bodeflow {

/// Exponents, in halves (so that V/Hz^0.5 has a dimension), of metre, kilogram, second, ampere, kelvin, radian and decibel.
/// The angle is a dimension of its own, so that Hz and rad/s are not mixed up.
using Dimension = std::array<int, 7>;

/// A unit: its dimension, and its size in the coherent unit of that dimension: numerator / denominator x 10^decimal x
/// pi^(pi / 2). `offset` is added to values in degC only.
struct Unit {
  Dimension dimension{};
  std::int64_t numerator = 1;
  std::int64_t denominator = 1;
  int decimal = 0;
  int pi = 0;
  double offset = 0.0;

  bool operator==(const Unit& o) const {
    return dimension == o.dimension && numerator == o.numerator && denominator == o.denominator && decimal == o.decimal &&
           pi == o.pi && !(offset < o.offset) && !(o.offset < offset);
  }
};

/// What a named unit is called and what it is.
struct NamedUnit {
  const char* name;
  Unit unit;
  bool prefixes;  ///< takes SI prefixes
};

namespace detail {

constexpr Unit unit_of(int m, int kg, int s, int a, int k = 0, int rad = 0, int decimal = 0) {
  return {{2 * m, 2 * kg, 2 * s, 2 * a, 2 * k, 2 * rad, 0}, 1, 1, decimal, 0, 0.0};
}
constexpr Unit scaled(Unit unit, std::int64_t numerator, std::int64_t denominator, int pi = 0) {
  unit.numerator = numerator;
  unit.denominator = denominator;
  unit.pi = pi;
  return unit;
}

}  // namespace detail

/// All units that have a name of their own (SI brochure, 9th edition, and what drives, networks and structures use).
inline const std::vector<NamedUnit>& named_units() {
  using detail::scaled;
  using detail::unit_of;
  static const std::vector<NamedUnit> units = [] {
    const Unit one = unit_of(0, 0, 0, 0), newton = unit_of(1, 1, -2, 0), joule = unit_of(2, 1, -2, 0),
               watt = unit_of(2, 1, -3, 0);
    const Unit volt = unit_of(2, 1, -3, -1), ohm = unit_of(2, 1, -3, -2), weber = unit_of(2, 1, -2, -1),
               coulomb = unit_of(0, 0, 1, 1);
    const Unit second = unit_of(0, 0, 1, 0), radian = unit_of(0, 0, 0, 0, 0, 1), rad_s = unit_of(0, 0, -1, 0, 0, 1);
    Unit percent = one, ppm = one, level = one, celsius = unit_of(0, 0, 0, 0, 1), standard_gravity = unit_of(1, 0, -2, 0);
    percent.decimal = -2;
    ppm.decimal = -6;
    level.dimension[6] = 2;
    celsius.offset = 273.15;
    standard_gravity.numerator = 980665;
    standard_gravity.decimal = -5;
    return std::vector<NamedUnit>{
        {"1", one, false},
        {"%", percent, false},
        {"ppm", ppm, false},
        {"Sa", one, true},
        {"sample", one, false},
        {"samples", one, false},
        {"count", one, false},
        {"counts", one, false},
        {"dB", level, false},
        {"m", unit_of(1, 0, 0, 0), true},
        {"g", unit_of(0, 1, 0, 0, 0, 0, -3), true},
        {"t", unit_of(0, 1, 0, 0, 0, 0, 3), false},
        {"s", second, true},
        {"min", scaled(second, 60, 1), false},
        {"h", scaled(second, 3600, 1), false},
        {"A", unit_of(0, 0, 0, 1), true},
        {"K", unit_of(0, 0, 0, 0, 1), true},
        {"degC", celsius, false},
        {"\u00B0C", celsius, false},
        {"rad", radian, true},
        {"deg", scaled(radian, 1, 180, 2), false},
        {"\u00B0", scaled(radian, 1, 180, 2), false},
        {"rev", scaled(radian, 2, 1, 2), false},
        {"turn", scaled(radian, 2, 1, 2), false},
        {"rpm", scaled(rad_s, 1, 30, 2), false},
        {"Hz", unit_of(0, 0, -1, 0), true},
        {"N", newton, true},
        {"Nm", joule, true},
        {"J", joule, true},
        {"Ws", joule, true},
        {"Wh", scaled(joule, 3600, 1), true},
        {"W", watt, true},
        {"VA", watt, true},
        {"var", watt, true},
        {"Pa", unit_of(-1, 1, -2, 0), true},
        {"bar", unit_of(-1, 1, -2, 0, 0, 0, 5), true},
        {"V", volt, true},
        {"ohm", ohm, true},
        {"Ohm", ohm, true},
        {"\u03A9", ohm, true},
        {"\u2126", ohm, true},
        {"S", unit_of(-2, -1, 3, 2), true},
        {"F", unit_of(-2, -1, 4, 2), true},
        {"H", unit_of(2, 1, -2, -2), true},
        {"Wb", weber, true},
        {"Vs", weber, true},
        {"T", unit_of(0, 1, -2, -1), true},
        {"C", coulomb, true},
        {"As", coulomb, true},
        {"Ah", scaled(coulomb, 3600, 1), true},
        {"l", unit_of(3, 0, 0, 0, 0, 0, -3), true},
        {"gn", standard_gravity, false},
    };
  }();
  return units;
}

/// SI prefixes and their powers of ten. Micro has three spellings: u, the micro sign, the Greek letter.
inline const std::vector<std::pair<const char*, int>>& unit_prefixes() {
  static const std::vector<std::pair<const char*, int>> prefixes = {
      {"f", -15}, {"p", -12}, {"n", -9}, {"u", -6}, {"\u00B5", -6}, {"\u03BC", -6}, {"m", -3},
      {"c", -2},  {"k", 3},   {"M", 6},  {"G", 9},  {"T", 12},      {"P", 15},
  };
  return prefixes;
}

/// The unit of that name, with or without a prefix ("kHz", "mm"), or nothing.
inline std::optional<Unit> find_unit(std::string_view name) {
  for (const NamedUnit& u : named_units()) {
    if (name == u.name) return u.unit;
  }
  for (const auto& [prefix, power] : unit_prefixes()) {
    const std::string_view p(prefix);
    if (name.size() <= p.size() || name.substr(0, p.size()) != p) continue;
    const std::string_view rest = name.substr(p.size());
    if (power == -2 && rest != "m") continue;  // centi is in use with metres alone
    for (const NamedUnit& u : named_units()) {
      if (!u.prefixes || rest != u.name) continue;
      Unit unit = u.unit;
      unit.decimal += power;
      return unit;
    }
  }
  return std::nullopt;
}

}  // namespace bodeflow
