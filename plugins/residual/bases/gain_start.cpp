#include "gain_start.hpp"

#include <cmath>

namespace bodeflow::residual {

std::vector<FitParameter> gain_parameters(int inputs) {
  std::vector<FitParameter> all;
  for (int j = 1; j <= inputs; ++j)
    all.push_back(
        real(inputs == 1 ? "gain" : "gain_" + std::to_string(j), "1", 1.0).says("of the record over that of the model"));
  return all;
}

std::vector<double> gains_near(std::span<const MeasuredResponse> measured, int inputs,
                               const std::function<std::complex<double>(int input, double frequency_hz)>& model) {
  const auto count = static_cast<std::size_t>(inputs);
  std::vector<double> above(count, 0.0), below(count, 0.0), gains(count, 1.0);
  for (std::size_t m = 0; m < measured.size(); ++m) {
    const std::size_t j = m % count;
    for (std::size_t k = 0; k < measured[m].frequency_hz.size(); ++k) {
      const std::complex<double> g = model(static_cast<int>(j), measured[m].frequency_hz[k]);
      const double w = measured[m].weight.empty() ? 1.0 : measured[m].weight[k] * measured[m].weight[k];
      if (!std::isfinite(std::abs(g)) || !std::isfinite(w)) continue;
      above[j] += w * std::real(std::conj(g) * measured[m].response[k]);
      below[j] += w * std::norm(g);
    }
  }
  for (std::size_t j = 0; j < count; ++j)
    if (below[j] > 0.0 && std::isfinite(above[j] / below[j])) gains[j] = above[j] / below[j];
  return gains;
}

}  // namespace bodeflow::residual
