#pragma once

#include <string>
#include <vector>

#include "response_checks.hpp"

namespace bodeflow::spectrum {

// Checks of response_warnings that compare periods and realisations as wholes. Each adds at most one text a signal to `out`.

/// Realisations whose excitation is that of the first one or of the one before: at the excited lines the squared difference is
/// below 1 % of the power, beside what noise explains. Nonlinear distortion then repeats as well, and the scatter does not hold
/// it. Fewer than 3 lines are not judged: their random phases may agree by chance.
void same_phases(const Judged& judged, std::vector<std::string>& out);

/// An excitation that does not repeat: of the power of single periods at the lines that carry it (a hundredth of the strongest
/// or more), a tenth or more is scatter between periods, ten times the scatter at the lines that carry none; where fewer than 10
/// lines carry none, half or more is. White noise, however strong, scatters alike at all lines and is left to the check of a weak
/// input. Else, where lines were found by a threshold, how many were left out that carry power.
void unrepeated(const Judged& judged, std::vector<std::string>& out);

/// Signals that drift: the trend of the means of the periods is significant, and what a ramp of that slope adds to one of the
/// lowest three lines is more than half of the confidence radius there. Needs 3 periods; where Moments::trend is left out,
/// nothing is said.
///
/// The trend b of P means is significant where it is 5 times its deviation, with the variance of a mean taken from the scatter
/// around the trend or from the lowest lines, whichever is larger; and where the scatter around the trend alone gives a trend of
/// that size by chance in less than 1 % of all cases. With R^2 the share of the trend in the scatter, nu degrees of freedom left,
/// that chance is I_x(nu/2, 1/2) < x^(nu/2) / (nu/2 B(nu/2, 1/2) sqrt(1 - x)), x = 1 - R^2.
void drift(const Judged& judged, std::vector<std::string>& out);

}  // namespace bodeflow::spectrum
