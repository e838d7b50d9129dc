#include "static_nonlinearity.hpp"

#include <cstddef>

namespace bodeflow::filters {

double polynomial(std::span<const double> coefficients, double x) {
  double y = 0.0;
  for (std::size_t i = coefficients.size(); i > 0; --i) y = y * x + coefficients[i - 1];
  return y;
}

double limited(double x, double least, double greatest) { return x < least ? least : x > greatest ? greatest : x; }

}  // namespace bodeflow::filters
