#include "blocks/amplitude.hpp"

#include <algorithm>
#include <cmath>

#include "periodic/periodic_record.hpp"

namespace bodeflow::residual {
namespace {

/// Nothing but the fact that there is one input.
class OneInput final : public BaseModel {
 public:
  std::vector<FitParameter> parameters() const override { return {}; }
  std::vector<std::vector<double>> starts(std::span<const MeasuredResponse>) const override { return {}; }
};

}  // namespace

Expected<AmplitudeChoice> choose_amplitude(const records::Recording& pilot, double pilot_amplitude, const AmplitudeWish& wish) {
  if (!(wish.largest_input > 0.0) || !(wish.largest_output > 0.0)) return refused("a limit is not above 0");
  const auto record = periodic_record(pilot, {}, OneInput());
  if (!record) return tl::unexpected(record.error());
  const PeriodicRecord& e = *record;
  AmplitudeChoice c;
  const double bins = static_cast<double>(e.period * e.periods);
  c.noise_std = std::sqrt(e.floor.at(e.frequency_hz).mean() * bins);
  double power = 0.0;
  for (Eigen::Index k = 1; k < e.lines(); ++k) {
    const Eigen::Index bin = k * e.periods;
    power += 2.0 * (std::norm(e.output[bin]) - e.variance[bin]);
  }
  c.output_rms = std::sqrt(std::max(power, 0.0));
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
