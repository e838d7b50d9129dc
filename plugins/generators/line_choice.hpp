#pragma once

#include <bodeflow/numerics/error.hpp>
#include <bodeflow/numerics/random.hpp>
#include <cstdint>
#include <string_view>
#include <vector>

/// Which lines of a period a multisine excites.
namespace bodeflow::generators {

using LineNumbers = std::vector<std::int64_t>;

/// first, first + step ... up to last. Errors: last below first, a line that is not in 1 .. (period - 1) / 2.
numerics::Expected<LineNumbers> lines_in_range(std::int64_t first, std::int64_t last, std::int64_t step, std::int64_t period);

/// The list itself. Errors: empty, not ascending, a line that is not in 1 .. (period - 1) / 2.
numerics::Expected<LineNumbers> lines_in_list(LineNumbers list, std::int64_t period);

/// Those of the lines that are odd or even; all of them for "all". Errors: none is left.
numerics::Expected<LineNumbers> lines_of_parity(const LineNumbers& lines, std::string_view parity);

/// The lines without detection lines: of each `group` lines in turn one is left out at random; an incomplete last group stays
/// whole. What the output of a plant shows at odd lines that are not excited is odd nonlinear distortion. Errors: a line that is
/// even, a group of less than 2 or of more lines than there are. Reference: R. Pintelon, J. Schoukens, System Identification: A
/// Frequency Domain Approach, 2nd ed., 2012, chapter 4 (odd multisines with a random harmonic grid).
numerics::Expected<LineNumbers> without_detection_lines(const LineNumbers& lines, std::int64_t group, numerics::Random random);

}  // namespace bodeflow::generators
