#include "report/polynomial_text.hpp"

#include <cmath>

#include "report/numbers.hpp"

namespace bodeflow::tools::report {

std::string polynomial_text(const std::vector<double>& coefficients, const std::string& variable) {
  std::string text;
  for (std::size_t n = 0; n < coefficients.size(); ++n) {
    const double c = coefficients[n];
    if (c == 0.0) continue;
    const int power = static_cast<int>(coefficients.size() - 1 - n);
    if (text.empty())
      text += c < 0.0 ? "−" : "";
    else
      text += c < 0.0 ? " − " : " + ";
    const bool one = std::abs(c) == 1.0 && power > 0;
    if (!one) text += shown(std::abs(c), 6);
    if (power == 0) continue;
    if (!one) text += " ";
    text += variable;
    if (power > 1) text += power_of_ten(power).substr(2);
  }
  return text.empty() ? "0" : text;
}

}  // namespace bodeflow::tools::report
