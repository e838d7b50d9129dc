#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "records/model.hpp"

namespace bodeflow::validation {

/// Several models' parameters side by side; matrices have a model in each row, NaN where a model has no such parameter.
struct ParameterTable {
  std::vector<std::string> names, units;
  Eigen::MatrixXd values;
  Eigen::MatrixXd deviations;
  /// (value - value of the first model) over the standard deviation of that difference, as for estimates from independent data.
  Eigen::MatrixXd difference;
  /// That all common parameters of a model and the first one differ so much by chance: chi-squared with their joint covariance;
  /// NaN where covariances are absent.
  Eigen::VectorXd probability;
};

/// Parameters with the same name and unit are the same where both models come from the same method, or are physical; else
/// the name says whose it is. names: of the models.
ParameterTable parameter_table(const std::vector<std::string>& names, const std::vector<records::ModelData>& models);

/// The poles in rad/s with imaginary part at least 0, by magnitude; those of a discrete-time model as ln(z) / sample time.
Expected<Eigen::VectorXcd> poles_rad_s(const records::ModelData& model);

/// Frequencies over which all models tell something: their bands together, else a decade around their poles, below half of each
/// sample rate; logarithmic. Empty where nothing tells of any frequency.
Eigen::VectorXd common_grid(const std::vector<records::ModelData>& models, Eigen::Index count);

}  // namespace bodeflow::validation
