#pragma once

#include <bodeflow/block.hpp>
#include <bodeflow/numerics/iir_design.hpp>
#include <string>
#include <utility>

namespace bodeflow::filters {

/// The value, or `fail` with the reason, `what` in front of it.
template <class T>
T value_or_fail(numerics::Expected<T> expected, const std::string& what) {
  if (!expected) fail(what + ": " + expected.error().text);
  return std::move(*expected);
}

/// The parameters of a family of recursive filters: family, order, ripple, attenuation, method.
void describe_family(Describe& d);

/// Their values; pass and edges are left to the caller.
numerics::IirDesign read_family(const Parameters& p);

/// "elliptic filter of order 4".
std::string family_text(const numerics::IirDesign& design);

/// A frequency in Hz as an angle w h.
double angle(double frequency_hz, double rate_hz);

}  // namespace bodeflow::filters
