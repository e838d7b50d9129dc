#pragma once

#include <Eigen/Core>
#include <limits>
#include <string>
#include <vector>

namespace bodeflow::residual {

/// A signal over whose values a residual is looked at, as long as the residual over time.
struct SeenOver {
  std::string name;  ///< "input", "output", "slope of the output", "flow at motor_bearing" ...
  std::string unit;
  Eigen::VectorXd values;
};

/// The mean of a residual where a signal has such values, bin by bin.
struct MeanMap {
  Eigen::VectorXd at;    ///< mean of the signal in the bin
  Eigen::VectorXd mean;  ///< of the residual, in the unit of the output
  Eigen::VectorXd std;   ///< standard error of that
};

/// Root mean square of a residual from period to period, or from block to block.
struct ResidualCourse {
  std::string axis;                                         ///< "period" or "time"; "": there is none
  Eigen::VectorXd at;                                       ///< number of the period from 1 on, or the middle of the block [s]
  Eigen::VectorXd rms;                                      ///< in the unit of the output
  double noise = std::numeric_limits<double>::quiet_NaN();  ///< what the noise alone leaves; nan: unknown
};

/// The correlation of a residual with itself.
struct Autocorrelation {
  Eigen::VectorXd lag_s;
  Eigen::VectorXd value;
  double band = 0.0;  ///< white noise stays within -band .. band with a probability of 95 % at each lag
};

/// What a report draws of a residual beside its spectrum or course.
struct ResidualViews {
  std::vector<MeanMap> maps;  ///< one a signal
  ResidualCourse course;
  Autocorrelation autocorrelation;
};

/// What one class of a record holds, in the unit of the output.
struct ClassSize {
  std::string name;    ///< as of its test
  double rms = 0.0;    ///< of the residual: all bins of the class together, the highest bin for a peak
  double noise = 0.0;  ///< the same of the noise alone
};

}  // namespace bodeflow::residual
