#include "sweep.hpp"

#include <bodeflow/numerics/random.hpp>
#include <cmath>

#include "portable_exp.hpp"

namespace bodeflow::generators {

Sweep::Sweep(Law law, double first_hz, double last_hz, std::uint64_t samples, Rate rate)
    : linear_(law == Law::linear || first_hz == last_hz), falling_(last_hz < first_hz), first_(Phase::step(first_hz, rate)) {
  const auto size = static_cast<double>(samples);
  if (linear_) {
    half_slope_ = Phase::step(std::abs(last_hz - first_hz), rate).divided(2 * samples);
    return;
  }
  const double ratio = numerics::portable_log(last_hz / first_hz);
  slope_ = ratio / size;
  scale_ = first_hz / rate.hz() * size / ratio;
}

Phase Sweep::at(std::uint64_t n) const {
  Phase phase = first_.times(n);
  const Phase bend = half_slope_.times(n).times(n);
  return falling_ ? phase -= bend : phase += bend;
}

double Sweep::logarithmic(std::uint64_t n) const {
  const double cycles = scale_ * (portable_exp(slope_ * static_cast<double>(n)) - 1);
  return cycles - std::nearbyint(cycles);
}

}  // namespace bodeflow::generators
