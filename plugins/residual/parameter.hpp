#pragma once

#include <cmath>
#include <string>

namespace bodeflow::residual {

/// A physical parameter of a base model or an effect, with the values that physics allows.
struct Parameter {
  std::string name;
  std::string unit;
  double low = 0.0;  ///< a fit that ends below is no finding
  double high = 0.0;
  /// Fitted as its logarithm: it is positive by nature. Otherwise the fit may pass through 0, and the bounds judge the result.
  bool logarithmic = true;
  double scale = 1.0;  ///< of the fitted number where it is not a logarithm
};

/// What the fit moves, from the value and back.
inline double coordinate(const Parameter& p, double value) { return p.logarithmic ? std::log(value) : value / p.scale; }
inline double value(const Parameter& p, double coordinate) { return p.logarithmic ? std::exp(coordinate) : coordinate * p.scale; }
/// d value / d coordinate.
inline double slope(const Parameter& p, double value) { return p.logarithmic ? value : p.scale; }

/// The bound that a value is beyond, as "below 0 V"; "" inside.
std::string beyond(const Parameter& p, double value);

}  // namespace bodeflow::residual
