#pragma once

#include <bodeflow/effect.hpp>
#include <cmath>
#include <complex>
#include <cstdio>
#include <string>

/// What sentences and starts of the linear effects share.
namespace bodeflow::residual::lines {

/// "12.5", with so many significant digits.
inline std::string number(double value, int digits = 4) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return text;
}

/// "12.5 mV (+-0.2)"; without the bracket where the deviation is not known.
inline std::string with_std(double value, double std, const std::string& unit, int digits = 4) {
  std::string text = number(value, digits);
  if (!unit.empty() && unit != "1") text += " " + unit;
  if (std::isfinite(std)) text += " (+-" + number(std, 2) + ")";
  return text;
}

/// "120 us (+-3)": a time in a unit that suits it.
inline std::string time_words(double value_s, double std_s) {
  const double size = std::fabs(value_s);
  if (size < 1e-3) return with_std(1e6 * value_s, 1e6 * std_s, "us");
  if (size < 1.0) return with_std(1e3 * value_s, 1e3 * std_s, "ms");
  return with_std(value_s, std_s, "s");
}

/// The unit of a / b: "ohm", "N/m", "1".
inline std::string ratio_unit(const std::string& a, const std::string& b) {
  if (a == b) return "1";
  if (a == "V" && b == "A") return "ohm";
  if (a == "A" && b == "V") return "S";
  if (b.empty() || b == "1") return a;
  return (a.empty() ? "1" : a) + "/" + b;
}

inline constexpr double kTwoPi = 6.283185307179586;

/// s on the frequency axis.
inline std::complex<double> axis(double frequency_hz) { return {0.0, kTwoPi * frequency_hz}; }

/// [rad/s] of the highest excited line, and the geometric mean of the lines; 1 where there are none above 0.
inline double highest_omega(const Situation& s) {
  double highest = 0.0;
  for (const double f : s.line_hz) highest = std::fmax(highest, f);
  return highest > 0.0 ? kTwoPi * highest : 1.0;
}
inline double middle_omega(const Situation& s) {
  double sum = 0.0;
  int count = 0;
  for (const double f : s.line_hz) {
    if (!(f > 0.0)) continue;
    sum += std::log(f);
    ++count;
  }
  return count > 0 ? kTwoPi * std::exp(sum / count) : 1.0;
}

/// The coefficient of the base model at the place, or what the largest signals there say of it: effort over flow for a resistance
/// or damping, over what is stored for a stiffness, the reactance at the upper end for a coil; 1 where nothing is known.
inline double coefficient_of(const Situation& s) {
  const Place& p = s.place;
  if (p.coefficient > 0.0) return p.coefficient;
  if (!(p.effort > 0.0) || !(p.flow > 0.0)) return 1.0;
  if (p.kind == "coil") return highest_omega(s) * p.flow / p.effort;
  const bool over_stored = (p.kind == "spring" || p.kind == "core") && p.stored > 0.0;
  return p.effort / (over_stored ? p.stored : p.flow);
}

/// The time x that brings the base response times (1 - s x) nearest to what was measured, by weighted least squares over the
/// lines; 0 where there are none.
inline double phase_slope_s(const Situation& s) {
  double above = 0.0, below = 0.0;
  for (std::size_t k = 0; k < s.missing.size(); ++k) {
    const std::complex<double> slope = -axis(s.line_hz[k]) * s.response[k];
    const double weight = s.missing_std[k] > 0.0 ? 1.0 / (s.missing_std[k] * s.missing_std[k]) : 0.0;
    above += weight * std::real(std::conj(slope) * s.missing[k]);
    below += weight * std::norm(slope);
  }
  return below > 0.0 ? above / below : 0.0;
}

}  // namespace bodeflow::residual::lines
