#pragma once

#include <Eigen/Core>
#include <bodeflow/error.hpp>
#include <bodeflow/numerics/linear_system.hpp>
#include <optional>
#include <string>
#include <vector>

#include "data.hpp"
#include "iteration_watch.hpp"
#include "method.hpp"
#include "order_scan.hpp"
#include "uncertainty.hpp"

namespace bodeflow::sanathanan_koerner {

/// A model with all that tells how far to trust it.
struct Identification {
  Eigen::Index order = 0;
  numerics::StateSpace system;  ///< one input, an output for each channel
  Eigen::VectorXcd poles;       ///< in s or z; those above the axis followed by their conjugates, then the real ones
  Eigen::MatrixXcd response;    ///< of the model at the lines
  Eigen::Index reflected = 0;   ///< unstable poles of the last step that were reflected
  std::optional<double> prewarp_rad_s;
  Course course;
  std::optional<Course> refinement;
  std::optional<Reduction> reduction;  ///< then `poles` and `response` are those of the reduced model

  double cost = 0.0;                            ///< sum of |weight (g - model)|^2
  Eigen::Index equations = 0;                   ///< complex, of lines with a weight
  Eigen::Index parameters = 0;                  ///< real
  std::optional<FractionParameters> fractions;  ///< values and names that the covariance is of; continuous time
  std::optional<Uncertainty> uncertainty;
  std::string no_covariance;      ///< why there is none
  std::optional<OrderScan> scan;  ///< where the order was sought

  double error() const { return reduction ? reduction->relative_error : (refinement ? *refinement : course).least(); }
  /// The model as a matrix of `inputs` columns: the reduced one, or all states.
  numerics::StateSpace matrix(Eigen::Index inputs) const { return reduction ? reduction->system : reshaped(system, inputs); }
};

/// The model of the data by the method of the settings: order, iteration, refinement, covariance.
/// inputs: the channels are that many columns, of as many outputs each.
/// Errors: those of the methods; vector fitting of a model in z.
Expected<Identification> identify(const Data& data, const Settings& settings, Eigen::Index inputs = 1,
                                  const std::optional<Data>& repeat = {});

}  // namespace bodeflow::sanathanan_koerner
