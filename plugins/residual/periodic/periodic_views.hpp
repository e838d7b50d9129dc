#pragma once

#include <vector>

#include "periodic/periodic_record.hpp"
#include "trace/residual_views.hpp"

namespace bodeflow::residual {

/// Over what a residual of a periodic record is looked at: the input that drives the model, what the model predicts and its slope
/// (the measured output would hold the same noise as the residual), flows and stored quantities of the first places. Samples of
/// the period. `left`: bins that the model leaves.
std::vector<SeenOver> signals_of(const PeriodicRecord& record, const JointModel& model, const Eigen::VectorXd& values,
                                 const Eigen::VectorXcd& left);

/// The views of a whitened residual.
///
/// Maps: of the mean period, with the standard error that the noise alone gives a mean over such samples: with W the spectrum of
/// the weights its variance is the sum of v |W|^2 over the lines. Course: root mean square of all bins, period by period.
/// Autocorrelation: of the whitened bins taken as the spectrum of a real signal with 2 bins - 1 values, which is white where they
/// are noise; its lags go round the record.
ResidualViews views_of(const PeriodicRecord& record, const Eigen::VectorXd& residual, const std::vector<SeenOver>& over);

/// Root mean square of each class that has bins, beside what the noise alone leaves there.
std::vector<ClassSize> class_sizes(const PeriodicRecord& record, const Eigen::VectorXd& residual);

}  // namespace bodeflow::residual
