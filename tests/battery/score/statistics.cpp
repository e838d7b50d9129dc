#include "score/statistics.hpp"

#include <algorithm>
#include <cmath>

namespace battery {

double uniform_probability(std::vector<double> values) {
  if (values.empty()) return std::nan("");
  std::sort(values.begin(), values.end());
  const double n = static_cast<double>(values.size());
  double distance = 0.0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    const double below = static_cast<double>(k) / n, above = static_cast<double>(k + 1) / n;
    distance = std::max({distance, above - values[k], values[k] - below});
  }
  const double x = distance * (std::sqrt(n) + 0.12 + 0.11 / std::sqrt(n));
  if (x < 0.3) return 1.0;  // the series needs ever more terms there, and the value is above 0.99999
  double sum = 0.0;
  for (int k = 1; k <= 100; ++k) sum += (k % 2 ? 2.0 : -2.0) * std::exp(-2.0 * k * k * x * x);
  return std::clamp(sum, 0.0, 1.0);
}

double median(std::vector<double> values) {
  if (values.empty()) return std::nan("");
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

double upper_rate(int count, int all) {
  if (all == 0 || count >= all) return 1.0;
  const auto at_most = [&](double rate) {  // probability of `count` or fewer
    double sum = 0.0;
    for (int k = 0; k <= count; ++k) {
      sum += std::exp(std::lgamma(all + 1.0) - std::lgamma(k + 1.0) - std::lgamma(all - k + 1.0) + k * std::log(rate) +
                      (all - k) * std::log1p(-rate));
    }
    return sum;
  };
  double low = 1e-12, high = 1.0 - 1e-12;
  for (int n = 0; n < 100; ++n) {
    const double middle = 0.5 * (low + high);
    (at_most(middle) > 0.05 ? low : high) = middle;
  }
  return low;
}

}  // namespace battery
