#pragma once

#include <Eigen/Core>
#include <bodeflow/record_builder.hpp>
#include <complex>
#include <functional>
#include <string>
#include <vector>

namespace bodeflow::filters {

/// What a filter does to a stream, as a record tells it.
struct FilterCurve {
  std::string label;
  /// H at a frequency in Hz, up to half the highest rate of the block.
  std::function<std::complex<double>(double)> response;
  /// Of the highest rate.
  Eigen::VectorXd impulse;
  /// Frequencies [Hz] and half widths of what is narrow: shown with more points.
  std::vector<std::pair<double, double>> resonances;
};

/// The record `filter`: attributes `sample_rate` [Hz] (of the impulse response), `names`, one a filter, and `kind`; arrays
/// `frequency` [Hz], `response` (frequencies x filters, complex), `time` [s], `impulse` (samples x filters).
/// `points`: frequencies over four decades.
RecordBuilder filter_record(const std::string& kind, double sample_rate_hz, const std::vector<FilterCurve>& curves,
                            int points = 300);

/// That record of one filter with a finite impulse response.
RecordBuilder fir_record(const std::string& kind, double sample_rate_hz, const Eigen::VectorXd& taps);

/// The response until what follows stays below 1e-4 of its largest value, at least 8 samples.
Eigen::VectorXd settled(const Eigen::VectorXd& impulse);

/// The most samples of an impulse response in a record.
inline constexpr Eigen::Index kMostImpulse = 4096;

}  // namespace bodeflow::filters
