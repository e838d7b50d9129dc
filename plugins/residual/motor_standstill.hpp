#pragma once

#include "base_model.hpp"
#include "motor_simulation.hpp"

namespace bodeflow::residual {

/// Which voltage a recording has as its input.
enum class MotorInput {
  command,      ///< the commanded value, held by the drive and applied after the computation delay
  period_mean,  ///< the mean terminal voltage of each sample period, known without delay
  terminal      ///< the terminal voltage, sampled without aliasing: what it does between the samples follows from its spectrum
};

/// An induction motor at standstill, one phase, equation (17), with parameters gamma, alpha, Lm_beta, sigma; see TCircuit.
/// With an input that is held, the response is that of the zero-order hold and the declared computation delay, exact at the
/// samples. Positive Rs is part of the model: gamma > alpha Lm_beta.
class MotorStandstill final : public BaseModel {
 public:
  MotorStandstill(MotorInput input, double computation_delay_s);

  std::string name() const override { return "motor_standstill"; }
  std::vector<Parameter> parameters() const override;
  std::vector<std::string> conventions() const override;
  Expected<std::vector<Eigen::VectorXd>> starts(std::span<const Experiment> experiments) const override;
  Scales scales(std::span<const Experiment> experiments, const Eigen::VectorXd& values) const override;
  Eigen::VectorXcd steady_state(const Experiment& experiment, const Eigen::VectorXd& values,
                                const Extension& extension) const override;
  void describe(const Eigen::VectorXd& values, const Extension& extension, records::ModelData& model) const override;

  /// The response at that frequency of a recording sampled so, with a further delay.
  std::complex<double> response(const Eigen::Vector4d& values, double frequency_hz, double sample_time_s, double delay_s) const;

 private:
  Expected<Eigen::VectorXd> start(std::span<const Experiment> experiments) const;
  bool held() const { return input_ != MotorInput::terminal; }
  double declared_delay_s() const { return input_ == MotorInput::command ? computation_delay_s_ : 0.0; }
  Eigen::VectorXd simulate_experiment(const Experiment& experiment, const Eigen::VectorXd& values,
                                      const Extension& extension) const;

  MotorInput input_;
  double computation_delay_s_;
};

}  // namespace bodeflow::residual
