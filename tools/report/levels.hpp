#pragma once

#include "report/chart.hpp"
#include "report/response.hpp"

namespace bodeflow::tools::report {

/// Magnitude and standard deviations (total, noise, stochastic nonlinear part), one chart an output / input.
std::vector<Chart> uncertainty_charts(const Response& response);

/// Levels at the outputs: excited lines, neighbouring odd and even lines, noise; one chart an output. Empty where none was
/// measured.
std::vector<Chart> level_charts(const Response& response);

}  // namespace bodeflow::tools::report
