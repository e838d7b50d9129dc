#pragma once

#include <Eigen/Core>

namespace bodeflow::validation {

/// Mean and spread of numbers over independent runs.
struct Spread {
  double mean = 0.0;
  double std = 0.0;  ///< of one run, with n - 1
};

/// The spread of at least two values.
Spread spread(const Eigen::VectorXd& values);

/// The share of runs whose 95 % interval value +- 1.96 deviation holds the truth. For a right covariance and n runs it lies
/// within 0.95 +- 0.43 / sqrt(n) in 95 of 100 studies. Both vectors have one entry a run.
double coverage(const Eigen::VectorXd& values, const Eigen::VectorXd& deviation, double truth);

}  // namespace bodeflow::validation
