#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "effect.hpp"
#include "expected.hpp"
#include "experiment.hpp"
#include "records/model.hpp"

namespace bodeflow::residual {

/// What a plant is declared to be, with parameters to be fitted. It predicts the periodic steady state of an experiment, alone or
/// with effects added to it.
class BaseModel {
 public:
  virtual ~BaseModel() = default;

  virtual std::string name() const = 0;
  virtual std::vector<Parameter> parameters() const = 0;
  /// What is declared beside the parameters (hold, delay, which input), in words.
  virtual std::vector<std::string> conventions() const = 0;

  /// Parameters near the data, from which a fit sets out: of all experiments together, and of each. Errors: data that this model
  /// can't describe at all.
  virtual Expected<std::vector<Eigen::VectorXd>> starts(std::span<const Experiment> experiments) const = 0;
  /// The steps and levels that effects start from.
  virtual Scales scales(std::span<const Experiment> experiments, const Eigen::VectorXd& values) const = 0;
  /// The spectrum of the output at the lines of the experiment. Values that are not finite: parameters outside of the domain.
  virtual Eigen::VectorXcd steady_state(const Experiment& experiment, const Eigen::VectorXd& values,
                                        const Extension& extension) const = 0;
  /// Order, numerator, denominator, poles and delay of the linear part.
  virtual void describe(const Eigen::VectorXd& values, const Extension& extension, records::ModelData& model) const = 0;
};

}  // namespace bodeflow::residual
