#pragma once

#include <Eigen/Core>
#include <bodeflow/error.hpp>
#include <bodeflow/numerics/linear_system.hpp>
#include <bodeflow/record.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "signals.hpp"

namespace bodeflow::records {

/// A linear model, with how sure it is and what it came from: of one input and one output by numerator and denominator, of any
/// number of them by a state space. Where it has both, they are the same system.
struct ModelData {
  std::string method;  ///< id of the block that made it
  std::string form;    ///< transfer_function, state_space, or physical
  std::int64_t order = 0;
  double sample_time_s = 0.0;  ///< 0: continuous in time
  double delay_s = 0.0;        ///< of the output, beside numerator and denominator
  std::vector<std::string> parameter_names;
  std::vector<std::string> parameter_units;
  Eigen::VectorXd parameters;
  Eigen::MatrixXd covariance;  ///< of `parameters`; empty where it is not known
  Eigen::VectorXd numerator;   ///< descending powers of s or z; empty: the model has no transfer function
  Eigen::VectorXd denominator;
  std::optional<numerics::StateSpace> state_space;  ///< its sample time is that of the model
  Eigen::VectorXcd poles;                           ///< of s or of z, as numerator and denominator are
  Eigen::VectorXcd zeros;
  std::vector<Eigen::Matrix2d> pole_covariance;  ///< of real and imaginary part, one a pole; or empty
  std::vector<Eigen::Matrix2d> zero_covariance;

  std::string input_name = "input", output_name = "output";
  std::string input_unit, output_unit;
  Signals inputs, outputs;  ///< of all of them where there are several inputs or outputs; the names above are the first then
  std::vector<std::string> conventions;  ///< such as "amplitude-invariant Clarke", "electrical rad/s"
  std::vector<std::string> warnings;     ///< each with what to do

  std::optional<double> cost;  ///< sum over the lines of |residual|^2 / variance, or as the method says
  std::optional<double> expected_cost;
  std::optional<double> cost_degrees_of_freedom;  ///< of 2 cost, where that is chi-squared
  std::optional<double> aic, mdl;
  std::optional<double> noise_ratio, input_noise_variance, output_noise_variance;
  std::optional<double> sample_rate_hz;    ///< of the data
  std::optional<std::int64_t> samples;     ///< of the data, or their lines
  std::optional<double> input_amplitude;   ///< largest |input| of the data
  std::optional<Eigen::Vector2d> band_hz;  ///< first and last frequency that was fitted
  std::string data_checksum;               ///< see checksum.hpp; empty where it is not known
};

/// What a record `model` holds of it, for those who need numerator and denominator. Errors, by name: another type, a form without
/// numerator and denominator, arrays whose shapes do not fit each other, values that are not finite.
Expected<ModelData> read_model(const RecordView& record);

/// What a record `model` holds of it, with a state space, with numerator and denominator, or with both. Errors: as read_model,
/// and a model that has neither.
Expected<ModelData> read_linear_model(const RecordView& record);

/// The model as a state space: its own, or a realisation of numerator and denominator. Errors: those of to_state_space.
Expected<numerics::StateSpace> state_space_of(const ModelData& model);

/// The record `model` (a state space as arrays `A`, `B`, `C`, `D`), to which a method may add attributes and arrays of its own.
/// Beside the arrays named as the members there are, in rad/s, `poles` and `zeros`: of a discrete-time model ln(z) / sample_time,
/// whose values of z stand in `z_poles` and `z_zeros`; covariances are carried over to rad/s.
RecordBuilder write_model(const ModelData& model);

}  // namespace bodeflow::records
