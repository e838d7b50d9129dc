#pragma once

#include <vector>

#include "model/joint_model.hpp"

namespace bodeflow::residual {

/// The response from x to y (H1, Hann window, half overlapping segments), at the lines at which x has power; `weight` is one over
/// its standard deviation. For starts: leakage and noise of x bias it. Empty for fewer than 128 samples.
/// Reference: J. S. Bendat, A. G. Piersol, Random Data, 4th ed. 2010, sections 6.1 and 9.2.
MeasuredResponse averaged_response(const Eigen::VectorXd& x, const Eigen::VectorXd& y, double sample_time_s);

/// Frequencies of narrow peaks of a signal, highest over its surroundings first, at most `most`. Only those that stand out of
/// white noise of the local level with a probability below 0.1 %.
std::vector<double> peak_frequencies(const Eigen::VectorXd& x, double sample_time_s, std::size_t most);

/// Rows before which the mean or the mean square of a signal differs most from that behind them, most distinct first, at
/// most `most`: maxima of the CUSUM statistic |S_k| / sqrt(k (n - k)), in the whole and in both parts.
std::vector<Eigen::Index> change_points(const Eigen::VectorXd& x, std::size_t most);

}  // namespace bodeflow::residual
