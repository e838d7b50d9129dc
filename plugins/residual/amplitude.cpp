#include "amplitude.hpp"

#include <cmath>

#include "experiment.hpp"

namespace bodeflow::residual {

Expected<AmplitudeChoice> choose_amplitude(const records::Recording& pilot, double pilot_amplitude, const AmplitudeWish& wish) {
  if (!(wish.largest_input > 0.0) || !(wish.largest_output > 0.0)) return refused("a limit is not above 0");
  const auto experiment = experiment_of(pilot, "pilot");
  if (!experiment) return tl::unexpected(experiment.error());
  const Experiment& e = *experiment;
  AmplitudeChoice c;
  const double bins = static_cast<double>(e.period * e.periods);
  c.noise_std = std::sqrt(e.floor.at(e.frequency_hz).mean() * bins);
  c.output_rms =
      std::sqrt(std::max(2.0 * (e.output.tail(e.lines() - 1).squaredNorm() - e.variance.tail(e.lines() - 1).sum()), 0.0));
  c.input_peak = pilot.input.col(0).cwiseAbs().maxCoeff();
  c.output_peak = pilot.output.col(0).cwiseAbs().maxCoeff();
  if (!(c.output_rms > 0.0) || !(c.input_peak > 0.0))
    return refused("the pilot's output holds nothing but noise; take a larger amplitude for the pilot");
  c.signal_to_noise_db = 20.0 * std::log10(c.output_rms / c.noise_std);
  c.factor = std::pow(10.0, (wish.signal_to_noise_db - c.signal_to_noise_db) / 20.0);
  c.limited_by = "signal_to_noise";
  const auto limit = [&c](double factor, const char* name) {
    if (factor >= c.factor) return;
    c.factor = factor;
    c.limited_by = name;
  };
  limit(wish.margin * wish.largest_input / c.input_peak, "largest_input");
  limit(wish.margin * wish.largest_output / c.output_peak, "largest_output");
  c.amplitude = c.factor * pilot_amplitude;
  return c;
}

}  // namespace bodeflow::residual
