#pragma once

#include <cmath>

namespace bodeflow::generators {

/// exp(x) for |x| <= 700, within 4 units in the last place, from portable operations only.
/// Method: x = n ln 2 + r with |r| <= ln 2 / 2; Taylor series of exp(r), whose first term left out is below 2e-18.
inline double portable_exp(double x) {
  // ln 2 in two parts: the first has few enough bits that its product with n is exact.
  constexpr double kLn2High = 6.93147180369123816490e-01;
  constexpr double kLn2Low = 1.90821492927058770002e-10;
  const double n = std::nearbyint(x * 1.44269504088896340736);
  const double r = (x - n * kLn2High) - n * kLn2Low;
  double sum = 1;
  for (int k = 14; k >= 1; --k) sum = 1 + r * sum / k;
  return std::ldexp(sum, static_cast<int>(n));
}

}  // namespace bodeflow::generators
