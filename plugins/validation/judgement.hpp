#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "autoregression.hpp"
#include "records/model.hpp"
#include "residual_tests.hpp"
#include "simulation.hpp"

namespace bodeflow::validation {

/// Measured signals that models are held against.
struct Measured {
  double sample_rate_hz = 0.0;
  Eigen::VectorXd input, output;
};

struct JudgementSettings {
  Eigen::Index steps = 10;        ///< of the prediction
  Eigen::Index lags = 25;         ///< of the correlations
  Eigen::Index noise_order = 20;  ///< highest order of the noise model; 0: white noise
  bool offset = true;             ///< estimate a constant offset of the output
  double confidence = 0.99;       ///< of the bands of the correlations
  Hold hold = Hold::zero_order;   ///< of the input of a continuous-time model
};

/// What measured data say of a model.
struct Judgement {
  Simulation simulation;
  bool unstable = false;                 ///< predicted by its own poles, see unstable_prediction.hpp; no noise model is fitted
  Autoregression noise;                  ///< of the simulation's residual
  Eigen::VectorXd prediction;            ///< `steps` samples ahead, from simulation.first on
  double fit = 0.0;                      ///< of the simulation, per cent: 100 (1 - |y - yhat| / |y - mean y|)
  double prediction_fit = 0.0;           ///< the same of the prediction
  double residual_std = 0.0;             ///< root mean square of the simulation's residual
  double prediction_std = 0.0;           ///< of the prediction's
  double expected_prediction_std = 0.0;  ///< as the noise model says
  double one_step_variance = 0.0;        ///< mean square of the one-step prediction error: V
  double fpe = 0.0;                      ///< V (N + d) / (N - d)
  double aic = 0.0;            ///< N ln V + 2 d; d: parameters of model and noise model, and what was estimated of the start
  ResidualTests residual;      ///< of the simulation
  ResidualTests innovation;    ///< of the one-step prediction
  double input_outside = 0.0;  ///< share of the input's energy outside the model's band; NaN where it states none
  double output_outside = 0.0;
  std::vector<std::string> warnings;  ///< each with what to do
};

/// The model held against data. The noise model is an autoregression fitted to the simulation's residual of these same data: the
/// model's transfer function takes no part in it. Errors: those of sampled_model and simulate, a constant output, fewer
/// samples than lags need.
Expected<Judgement> judge(const records::ModelData& model, const Measured& data, const JudgementSettings& settings);

/// The share of the energy of x, its mean taken off, at frequencies outside [low, high] Hz (within half a line); 0 for a
/// constant.
double energy_outside(const Eigen::VectorXd& x, double sample_rate_hz, double low_hz, double high_hz);

}  // namespace bodeflow::validation
