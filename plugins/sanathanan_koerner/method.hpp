#pragma once

#include <Eigen/Core>
#include <optional>

#include "fit.hpp"
#include "reduction.hpp"
#include "vector_fitting.hpp"

namespace bodeflow::sanathanan_koerner {

enum class Method {
  arnoldi,         ///< orthonormal basis, relaxed
  monomial,        ///< as printed by D. A. Jue
  vector_fitting,  ///< partial fractions, relaxed
};

/// How the columns of a matrix of responses share their denominator.
enum class Columns {
  stacked,    ///< all channels fitted together
  by_column,  ///< the denominator from the column with the most energy, numerators of the others for it
};

/// How a model is wanted.
struct Settings {
  Method method = Method::arnoldi;
  std::optional<Eigen::Index> order;  ///< nothing: by a scan
  Eigen::Index highest_order = 20;
  double sample_time_s = 0.0;           ///< 0: continuous time
  std::optional<double> prewarp_rad_s;  ///< nothing: by a scan
  double weight_exponent = 1.0;
  Spacing initial_poles = Spacing::automatic;
  Columns columns = Columns::stacked;
  bool stable = true;
  bool refine = false;
  States states;                ///< of several inputs and outputs
  bool known_variance = false;  ///< the weights are one over the deviation of the response
  StopRule stop;
};

/// What all methods give.
struct Fitted {
  numerics::StateSpace system;
  Eigen::VectorXcd poles;
  Eigen::MatrixXcd response;
  Eigen::Index reflected = 0;
  std::optional<double> prewarp_rad_s;
  Course course;
  std::optional<Course> refinement;

  double error() const { return (refinement ? *refinement : course).least(); }
};

/// The model of that order by the method of the settings. inputs: as for identify. Errors: those of the method.
Expected<Fitted> fitted(const Data& data, const Settings& settings, Eigen::Index order, Eigen::Index inputs);

}  // namespace bodeflow::sanathanan_koerner
