#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>

#include "model/joint_model.hpp"

namespace bodeflow::residual {

/// What drives a simulation, and from where it starts.
struct Drive {
  /// Rows: samples x values_per_sample, in time; columns: inputs of the plant. The maps of Acts::input are applied already.
  Eigen::MatrixXd input;
  int values_per_sample = 1;     ///< more than one: the input between the samples
  Hold hold = Hold::zero_order;  ///< of the values of `input`; band_limited counts as first_order, see `refined`
  double sample_time_s = 0.0;
  double delay_s = 0.0;  ///< all of it, declared and added
  double start_s = 0.0;  ///< of the first sample, since the record began: for laws that depend on the time
  /// The input repeats: simulated until it is steady, then for `periods` of it; else once, from `initial` at the first sample.
  bool periodic = false;
  Eigen::Index periods = 1;  ///< more than one for effects that depend on the time since the record began
  Eigen::VectorXd initial;   ///< state; empty: the linear steady state where periodic, else zeros
  /// What immittances take at each place besides, one row a value of `input`, straight between them; empty: nothing.
  Eigen::MatrixXd extra_reaction;
  bool signals = true;  ///< flows and stored quantities are wanted
};

/// What a simulation gives, at the samples: row n is what is sampled with input sample n.
struct Simulated {
  Eigen::VectorXd output;
  Eigen::MatrixXd flow, stored;  ///< samples x places
  Eigen::VectorXd state;         ///< at the end
};

/// The plant with its laws, stepped through the input. Values that are not finite: outside of the domain. Series, parallel, tone
/// effects, immittances and maps of the output are none of its business.
///
/// Method: between two steps the linear part is moved exactly (matrix exponential, input held or straight), reactions of laws are
/// polynomials of time: see Stepper. Smooth laws are solved with order 4; around jumps and corners, and for laws with a memory,
/// single steps of order 2 weighted by theta = 0.6 take over. A sample that is taken between steps (delay) is computed from these
/// polynomials. `time_s` of laws is 0 before the record begins.
/// A periodic drive is run from the linear steady state until a period ends where it began, within 1e-6 of the states; a plant
/// that integrates may drift, which is taken off the output as a straight line.
/// Errors: sizes that do not fit, a model without state space.
Expected<Simulated> simulate(const JointModel& model, const Eigen::VectorXd& values, std::span<const double> known,
                             const Drive& drive);

/// The same for many drives, prepared once; for one thread.
class Simulation {
 public:
  /// Refers to its arguments, which have to outlive it.
  Simulation(const JointModel& model, const Eigen::VectorXd& values, std::span<const double> known);
  ~Simulation();
  Expected<Simulated> run(const Drive& drive);

 private:
  struct Ready;
  const JointModel* model_;
  std::unique_ptr<Ready> ready_;
};

/// A periodic input, one row a sample, as `values_per_sample` values for each: straight lines between them have the spectrum of
/// the input up to the Nyquist frequency (its own line left out).
Eigen::MatrixXd refined(const Eigen::MatrixXd& input, int values_per_sample);

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
