#include "judgement.hpp"

#include <bodeflow/numerics/fft.hpp>
#include <cmath>
#include <limits>

#include "records/signals.hpp"
#include "unstable_prediction.hpp"

namespace bodeflow::validation {
namespace {

using records::short_number;

// A larger share of the energy than this decides the fit.
constexpr double kNotableShare = 0.05;
// Nonlinear plants answer otherwise to amplitudes that differ by more.
constexpr double kAbove = 1.1, kBelow = 0.5;

double root_mean_square(const Eigen::VectorXd& x) { return x.norm() / std::sqrt(static_cast<double>(x.size())); }

double fit_of(const Eigen::VectorXd& measured, const Eigen::VectorXd& given) {
  return 100.0 * (1.0 - (measured - given).norm() / (measured.array() - measured.mean()).matrix().norm());
}

std::string percent(double share) { return short_number(100.0 * share, 2) + " %"; }

void warn_of_band(const records::ModelData& m, Judgement& j) {
  const std::string band = short_number((*m.band_hz)[0], 4) + " to " + short_number((*m.band_hz)[1], 4) + " Hz";
  const double share = std::max(j.input_outside, j.output_outside);
  if (!(share > kNotableShare)) return;
  j.warnings.push_back(percent(j.input_outside) + " of the input's and " + percent(j.output_outside) +
                       " of the output's energy lie outside the band of " + band +
                       " in which it was fitted: the fit tells of extrapolation; filter the data to the band, or identify in a "
                       "wider one");
}

void warn_of_amplitude(const records::ModelData& m, double amplitude, Judgement& j) {
  const double fitted = *m.input_amplitude;
  if (!(fitted > 0.0) || !(amplitude > 0.0)) return;
  const double ratio = amplitude / fitted;
  if (ratio <= kAbove && ratio >= kBelow) return;
  const std::string unit = m.input_unit.empty() ? "" : " " + m.input_unit;
  j.warnings.push_back(
      "the input reaches " + short_number(amplitude, 4) + unit + ", " + short_number(ratio, 3) + " times the " +
      short_number(fitted, 4) + unit +
      " of the data it was fitted to: a plant that is not linear answers otherwise; validate at the same amplitude");
}

void look_at_coverage(const records::ModelData& m, const Measured& data, Judgement& j) {
  j.input_outside = j.output_outside = std::numeric_limits<double>::quiet_NaN();
  if (m.band_hz) {
    j.input_outside = energy_outside(data.input, data.sample_rate_hz, (*m.band_hz)[0], (*m.band_hz)[1]);
    j.output_outside = energy_outside(data.output, data.sample_rate_hz, (*m.band_hz)[0], (*m.band_hz)[1]);
    warn_of_band(m, j);
  }
  if (m.input_amplitude) warn_of_amplitude(m, data.input.cwiseAbs().maxCoeff(), j);
}

void warn_of_hold(const records::ModelData& m, const Measured& data, Judgement& j) {
  const double share = energy_outside(data.input, data.sample_rate_hz, 0.0, data.sample_rate_hz / 4.0);
  if (m.sample_time_s > 0.0 || !(share > kNotableShare)) return;
  j.warnings.push_back(percent(share) +
                       " of the input's energy lie above a quarter of the sample rate, where an input that is linear between "
                       "samples falls short of a band-limited one by 19 to 59 %; sample faster, or excite lower frequencies");
}

/// Simulation's residual, noise model, prediction. Returns the one-step prediction error.
Eigen::VectorXd predict_ahead(const SampledModel& model, const Eigen::VectorXd& u, const Eigen::VectorXd& y,
                              const JudgementSettings& s, Eigen::Index parameters, Judgement& j) {
  const Eigen::VectorXd residual = y - j.simulation.output;
  j.residual_std = root_mean_square(residual);
  // Rounding is no noise.
  const bool exact = j.residual_std < 1e-12 * root_mean_square(y);
  Eigen::VectorXd innovation;
  if (j.unstable) {
    UnstablePrediction p = predict_unstable(model.system, u, y, s.steps, s.offset);
    j.noise.std = p.innovation_std;
    j.prediction = std::move(p.output);
    j.expected_prediction_std = p.expected_error_std;
    innovation = std::move(p.innovation);
  } else {
    j.noise = exact ? Autoregression{} : fit_autoregression(residual, s.noise_order);
    j.prediction = j.simulation.output + predict(j.noise, residual, s.steps);
    j.expected_prediction_std = prediction_deviation(j.noise, s.steps);
    innovation = residual - predict(j.noise, residual, 1);
  }
  j.fit = fit_of(y, j.simulation.output);
  j.prediction_fit = fit_of(y, j.prediction);
  j.prediction_std = root_mean_square(y - j.prediction);
  const auto n = static_cast<double>(y.size());
  const auto unknowns =
      static_cast<double>(parameters + j.noise.coefficients.size() + j.simulation.initial_state.size() + (s.offset ? 1 : 0));
  j.one_step_variance = innovation.squaredNorm() / n;
  j.fpe = n > unknowns ? j.one_step_variance * (n + unknowns) / (n - unknowns) : std::numeric_limits<double>::quiet_NaN();
  j.aic = n * std::log(j.one_step_variance) + 2.0 * unknowns;
  return innovation;
}

}  // namespace

double energy_outside(const Eigen::VectorXd& x, double sample_rate_hz, double low_hz, double high_hz) {
  const Eigen::VectorXcd spectrum = numerics::half_dft(x.array() - x.mean());
  const double line_hz = sample_rate_hz / static_cast<double>(x.size());
  double all = 0.0, outside = 0.0;
  for (Eigen::Index k = 1; k < spectrum.size(); ++k) {
    const double f = line_hz * static_cast<double>(k), energy = std::norm(spectrum[k]);
    all += energy;
    if (f < low_hz - 0.5 * line_hz || f > high_hz + 0.5 * line_hz) outside += energy;
  }
  return all > 0.0 ? outside / all : 0.0;
}

Expected<Judgement> judge(const records::ModelData& model, const Measured& data, const JudgementSettings& settings) {
  const auto sampled = sampled_model(model, data.sample_rate_hz, settings.hold);
  if (!sampled) return unexpected(sampled.error().text);
  auto simulation = simulate(*sampled, data.input, data.output, settings.offset);
  if (!simulation) return unexpected(simulation.error().text);
  Judgement j;
  j.unstable = sampled->largest_pole > 1.0 + 1e-9;
  j.simulation = std::move(*simulation);
  const Eigen::Index samples = data.output.size() - j.simulation.first;
  const Eigen::VectorXd y = data.output.tail(samples), u = data.input.tail(samples);
  if (samples <= 4 * settings.lags)
    return unexpected("the data have " + records::counted(samples, "sample") + " beyond its delay; needed: more than " +
                      std::to_string(4 * settings.lags) + " for correlations over " + std::to_string(settings.lags) + " lags");
  if ((y.array() == y[0]).all()) return unexpected("the output is constant: there is nothing to fit");
  // The input that the outputs answer to comes `delay` samples before.
  const Eigen::VectorXd innovation = predict_ahead(*sampled, data.input.head(samples), y, settings, model.parameters.size(), j);
  const Eigen::VectorXd residual = y - j.simulation.output;
  j.residual = test_residual(residual, u, settings.lags, 0, settings.confidence);
  j.innovation = test_residual(innovation, u, settings.lags, j.noise.coefficients.size(), settings.confidence);
  look_at_coverage(model, data, j);
  if (settings.hold == Hold::first_order) warn_of_hold(model, data, j);
  if (j.unstable)
    j.warnings.push_back(
        "it is unstable: its simulation follows the measured input for a short time only; judge it by its prediction, or in "
        "closed loop");
  return j;
}

}  // namespace bodeflow::validation
