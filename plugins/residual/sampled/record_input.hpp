#pragma once

#include <complex>
#include <vector>

#include "model/joint_model.hpp"

namespace bodeflow::residual {

/// The response of a hold of the input whose samples are at the instants.
std::complex<double> hold_response(Hold hold, double frequency_hz, double sample_time_s);

/// The inputs of a plant over a record, made once and used for every simulation.
///
/// Zero-order and first-order hold as declared; a band-limited input as 4 values a sample from the record's spectrum,
/// joined by straight lines and corrected for what those lower high frequencies: right within 0.1 % up to 0.8 of half the
/// sample rate. Maps of the input act on the values between the samples, too. Derivatives: smooth_derivative.
class RecordInput {
 public:
  /// `channels`: samples x channels. `known`: of the record.
  RecordInput(Eigen::MatrixXd channels, double sample_time_s, std::vector<double> known, const BaseModel& base);

  Eigen::Index samples() const { return channels_.rows(); }
  double sample_time_s() const { return sample_time_s_; }
  const std::vector<double>& known() const { return known_; }
  /// As measured, at the samples.
  Eigen::VectorXd channel(Eigen::Index c) const { return channels_.col(c); }
  /// From the samples of a channel to what drives the plant: declared hold and delay; for a filter nothing.
  std::complex<double> path(double frequency_hz) const;
  int values_per_sample() const { return values_per_sample_; }
  /// How the values are joined.
  Hold joined() const { return joined_; }
  /// samples x inputs: what the plant takes, at the samples.
  const Eigen::MatrixXd& at_samples() const { return at_samples_; }
  /// samples * values_per_sample x inputs.
  const Eigen::MatrixXd& values() const { return ready_; }
  /// The same with the model's maps of the input applied.
  Eigen::MatrixXd mapped_values(const JointModel& model, const Eigen::VectorXd& parameters) const;

 private:
  Eigen::MatrixXd plant_inputs(const Eigen::MatrixXd& channels) const;
  Eigen::MatrixXd corrected(Eigen::MatrixXd fine) const;

  Eigen::MatrixXd channels_;
  double sample_time_s_ = 0.0;
  std::vector<double> known_;
  std::vector<PlantInput> inputs_;
  double filter_hz_ = 0.0;
  Timing timing_;
  int values_per_sample_ = 1;
  Hold joined_ = Hold::zero_order;
  Eigen::MatrixXd at_samples_, fine_, ready_;
};

}  // namespace bodeflow::residual
