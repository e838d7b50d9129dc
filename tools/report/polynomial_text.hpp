#pragma once

#include <string>
#include <vector>

namespace bodeflow::tools::report {

/// "1.5 z² − 0.2 z + 3" for coefficients in descending powers; "0" for none.
std::string polynomial_text(const std::vector<double>& coefficients, const std::string& variable);

}  // namespace bodeflow::tools::report
