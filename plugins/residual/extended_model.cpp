#include "extended_model.hpp"

#include <algorithm>

namespace bodeflow::residual {

records::ModelData model_of(const Fit& fit, std::span<const Experiment> experiments) {
  records::ModelData m;
  const Extension extension = fit.model.extension(fit.values);
  fit.model.base->describe(fit.values, extension, m);
  m.method = "residual.trace";
  for (const Parameter& p : fit.model.parameters()) {
    m.parameter_names.push_back(p.name);
    m.parameter_units.push_back(p.unit);
  }
  m.parameters = fit.values;
  m.covariance = fit.covariance;
  m.conventions = fit.model.base->conventions();
  for (const AddedEffect& added : extension) {
    if (!added.effect->linear())
      m.warnings.push_back("numerator and denominator hold the small-signal part without " + added.effect->name() +
                           "; use the parameters for large signals");
  }
  if (!fit.converged)
    m.warnings.push_back("the fit did not converge: the parameters are not the best ones; check what is declared");
  const Experiment& first = experiments.front();
  m.input_name = first.input_name;
  m.output_name = first.output_name;
  m.input_unit = first.input_unit;
  m.output_unit = first.output_unit;
  Eigen::Index rows = 0;
  std::int64_t samples = 0;
  double largest = 0.0, low = first.frequency_hz[first.lines() - 1], high = 0.0;
  for (const Experiment& e : experiments) {
    rows += 2 * e.lines() - 1;
    samples += e.period * e.periods;
    largest = std::max(largest, e.input.cwiseAbs().maxCoeff());
    m.data_checksum += (m.data_checksum.empty() ? "" : " ") + e.checksum;
    for (Eigen::Index k = 0; k < e.lines(); ++k) {
      if (e.kind[static_cast<std::size_t>(k)] != Kind::excited) continue;
      low = std::min(low, e.frequency_hz[k]);
      high = std::max(high, e.frequency_hz[k]);
    }
  }
  m.cost = fit.chi2 / 2.0;
  m.cost_degrees_of_freedom = static_cast<double>(rows - fit.values.size());
  m.expected_cost = *m.cost_degrees_of_freedom / 2.0;
  m.aic = fit.chi2 + 2.0 * static_cast<double>(fit.values.size());
  m.sample_rate_hz = first.sample_rate_hz;
  m.samples = samples;
  m.input_amplitude = largest;
  m.band_hz = Eigen::Vector2d(low, high);
  return m;
}

}  // namespace bodeflow::residual
