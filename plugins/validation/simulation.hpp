#pragma once

#include <Eigen/Core>
#include <bodeflow/numerics/linear_system.hpp>

#include "records/model.hpp"

namespace bodeflow::validation {

/// A model as it stands at the samples of data.
struct SampledModel {
  numerics::StateSpace system;  ///< discrete-time
  Eigen::Index delay = 0;       ///< samples by which the input comes late
  double largest_pole = 0.0;    ///< largest magnitude of a value of z
};

/// What the input of a continuous-time model does between the samples.
enum class Hold { zero_order, first_order };

/// The model at so many samples per second: a continuous-time one with its delay and its input held over each sample, or linear
/// between samples, a discrete-time one as it is.
/// Errors: more zeros than poles; a discrete-time model of another sample time, or with a delay that is no whole number of
/// samples.
Expected<SampledModel> sampled_model(const records::ModelData& model, double sample_rate_hz, Hold hold = Hold::zero_order);

/// A simulated output beside the measured one.
struct Simulation {
  Eigen::Index first = 0;         ///< the sample that the simulation begins with: those before reach back to unknown inputs
  Eigen::VectorXd output;         ///< from `first` on
  Eigen::VectorXd initial_state;  ///< estimated
  double offset = 0.0;            ///< estimated, of the output
};

/// The output that the model gives to the measured input, from an initial state and, where asked for, with a constant offset that
/// are both estimated from the measured output.
///
/// Method: y[n] = forced[n] + C A^(n - first) x0 + offset, linear in x0 and the offset: least squares over all samples. The first
/// `delay` samples are left out: their inputs came before the data. Cost: O(samples states^2). Errors: fewer samples than three
/// times the unknowns; a simulation beyond the range of a double (an unstable model).
Expected<Simulation> simulate(const SampledModel& model, const Eigen::VectorXd& input, const Eigen::VectorXd& output,
                              bool estimate_offset);

}  // namespace bodeflow::validation
