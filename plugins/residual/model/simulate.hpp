#pragma once

#include <Eigen/Core>
#include <span>

#include "model/joint_model.hpp"

namespace bodeflow::residual {

/// What drives a simulation, and from where it starts.
struct Drive {
  /// Rows: samples x values_per_sample, in time; columns: inputs of the plant. The maps of Acts::input are applied already.
  Eigen::MatrixXd input;
  int values_per_sample = 1;  ///< more than one: the input between the samples, each held
  Hold hold = Hold::zero_order;
  double sample_time_s = 0.0;
  double delay_s = 0.0;  ///< all of it, declared and added
  /// The input repeats: simulated until it is steady, then for `periods` of it; else once, from `initial` at the first sample.
  bool periodic = false;
  Eigen::Index periods = 1;  ///< more than one for effects that depend on the time since the record began
  Eigen::VectorXd initial;   ///< state; empty: the linear steady state where periodic, else zeros
  /// What immittances take at each place besides, one row a value of `input`; empty: nothing.
  Eigen::MatrixXd extra_reaction;
};

/// What a simulation gives, at the samples: row n is what is sampled with input sample n.
struct Simulated {
  Eigen::VectorXd output;
  Eigen::MatrixXd flow, stored;  ///< samples x places
  Eigen::VectorXd state;         ///< at the end
};

/// The plant with its laws, stepped through the input. Values that are not finite: outside of the domain.
///
/// Method: between two steps of h the linear part is moved exactly (matrix exponential, input held or straight), reactions are
/// taken straight from step to step, r(t) = r0 + (r1 - r0) t / h, and r1 solved from the law at the end of the step: the
/// trapezoidal rule for the laws alone, of second order and without a limit of stability; laws that jump are weighted (1 -
/// theta), theta = 0.6, which damps what the trapezoidal rule leaves ringing. The step in which a sample is taken late (delay) is
/// split there. Laws of several places are solved in turn until they agree.
Expected<Simulated> simulate(const JointModel& model, const Eigen::VectorXd& values, std::span<const double> known,
                             const Drive& drive);

/// (1 + places) x (inputs + places) at s: what LinearPlant or BaseModel::response says, without effects.
Eigen::MatrixXcd plant_response(const BaseModel& base, const Eigen::VectorXd& values, std::span<const double> known,
                                std::complex<double> s);

/// 1 x inputs: the response of the linear joint model at s, immittances, series, parallel and delays included (no hold).
Eigen::RowVectorXcd joint_response(const JointModel& model, const Eigen::VectorXd& values, std::span<const double> known,
                                   std::complex<double> s);

/// The same between samples: what a hold of the input and sampling of the output make of it at f, aliases included where the
/// model has a state space (modified z-transform, Jury 1964).
Eigen::RowVectorXcd sampled_response(const JointModel& model, const Eigen::VectorXd& values, std::span<const double> known,
                                     double frequency_hz, double sample_time_s);

/// The slowest time constant of the plant [s]; infinite for one that integrates.
double settling_s(const JointModel& model, const Eigen::VectorXd& values, std::span<const double> known);

}  // namespace bodeflow::residual
