#pragma once

#include <Eigen/Core>
#include <complex>
#include <functional>

namespace bodeflow::residual {

/// How a record goes on beyond its ends, for filters without phase.
enum class Beyond {
  mirrored,  ///< the samples in reverse order: continuous
  turned     ///< turned about the last sample, after a straight line through both ends is taken off: continuous with its slope
};

/// The record through a filter with the response H(f), computed by its spectrum: no phase beyond that of H, no start-up.
///
/// Beyond::turned wants the filter's answer to the straight line a + b t from the caller: it is left out. `x`: at least 2
/// samples; `values_per_sample`: values of the result for each sample, band-limited between them (H is 0 from half the sample
/// rate on), samples * values_per_sample in all. Cost: O(N log N).
Eigen::VectorXd filtered(const Eigen::VectorXd& x, double sample_time_s, int values_per_sample, Beyond beyond,
                         const std::function<std::complex<double>(double frequency_hz)>& response);

/// The record between its samples, as a band-limited signal goes there: values_per_sample values a sample, the first at it.
Eigen::VectorXd interpolated(const Eigen::VectorXd& x, int values_per_sample);

/// The derivative of that order (0, 1, 2) of the record behind a low-pass without phase, |H|^2 of a Butterworth filter of
/// order 4, which runs forth and back: H(f) = 1 / (1 + (f / f0)^8), f0 such that |H(corner)| = 1 / sqrt(2).
Eigen::VectorXd smooth_derivative(const Eigen::VectorXd& x, double sample_time_s, double corner_hz, int order);

}  // namespace bodeflow::residual
