#pragma once

#include <span>

namespace bodeflow::filters {

/// c[0] + c[1] x + c[2] x^2 + ... by Horner's rule; 0 without coefficients.
double polynomial(std::span<const double> coefficients, double x);

/// x between `least` and `greatest`, else the nearer of them; least <= greatest. Not a number stays so.
double limited(double x, double least, double greatest);

}  // namespace bodeflow::filters
