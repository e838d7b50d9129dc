#pragma once

#include <bodeflow/error.hpp>
#include <vector>

#include "records.hpp"

namespace bodeflow::spectrum {

/// One frequency response from several experiments on the same plant, lines in rising order.
///
/// Lines at one frequency (within 1e-9 of it) are combined, entry by entry, by inverse variances v_e:
///   G = sum_e w_e G_e,  w_e = (1/v_e) / sum 1/v,   var G = (1 / sum 1/v) (1 + 2 sum_e w_e (1 - w_e) / nu_e),
///   nu = 1 / sum_e (w_e^2 / nu_e).
/// The bracket makes good that the weights are estimates too (Meier). An entry with variance 0 counts as exact: the mean of such
/// ones. Lines of one experiment alone are taken as they are, so bands are joined.
///
/// Consistency: each experiment against the weighted mean G_o of the others, |G_e - G_o|^2 / (v_e + v_o) ~ F(2, 2 nu), nu after
/// Satterthwaite. Where the farthest one (of two the later one) has a probability below 1 %, corrected for the choice, it
/// disagrees; more such entries than chance and the correlation of neighbouring lines explain (mean + 4 sqrt(10 mean) + 2), or
/// one below 0.001 in all entries together, is a warning that names experiment and lines.
///
/// Attributes: periods, realisations and dropped samples are added, warnings collected (those of the experiments, then its own),
/// `form` is "merged" where they differ; `degrees_of_freedom` is the smallest of all lines, the confidence radii have those of
/// their own line. Wrong where the experiments share noise or data (records of one growing average), and where the operating
/// point differs and the plant is not linear.
///
/// References: W. G. Cochran, Biometrics 10 (1954) 101, doi:10.2307/3001666; P. Meier, Variance of a weighted mean,
/// Biometrics 9 (1953) 59, doi:10.2307/3001633; F. E. Satterthwaite, doi:10.2307/3002019.
///
/// Errors: no experiment; other names or number of inputs or outputs, or other units, than the first; a variance that only some
/// have; overlapping lines without variance.
Expected<ResponseData> merge(const std::vector<ResponseData>& experiments);

}  // namespace bodeflow::spectrum
