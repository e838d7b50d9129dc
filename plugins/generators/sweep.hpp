#pragma once

#include <bodeflow/rate.hpp>
#include <cstdint>

#include "phase.hpp"

namespace bodeflow::generators {

/// The phase of a sine whose frequency goes from f1 to f2 [Hz] within N samples.
///
/// Linear: f1 t + (f2 - f1) t^2 / (2 T) cycles, T = N / rate, in 128-bit fractions of a cycle: off by less than 2^-60 cycles for
/// any N up to 2^32. Logarithmic: f1 T / ln r (r^(t/T) - 1) cycles, r = f2 / f1 (Farina 2000), in doubles: off by about 1e-15 of
/// the cycles since the start.
class Sweep {
 public:
  enum class Law { linear, logarithmic };

  Sweep() = default;
  /// 0 <= f1, f2 <= rate / 2, above zero for the logarithmic law; 1 <= samples <= 2^32.
  Sweep(Law law, double first_hz, double last_hz, std::uint64_t samples, Rate rate);

  /// In cycles, in [-0.5, 0.5], at sample n < N.
  double cycles(std::uint64_t n) const { return linear_ ? at(n).cycles() : logarithmic(n); }

 private:
  Phase at(std::uint64_t n) const;
  double logarithmic(std::uint64_t n) const;

  bool linear_ = true;
  bool falling_ = false;
  Phase first_;       // a sample
  Phase half_slope_;  // a sample squared
  double slope_ = 0;  // ln r / N
  double scale_ = 0;  // f1 N / (rate ln r)
};

}  // namespace bodeflow::generators
