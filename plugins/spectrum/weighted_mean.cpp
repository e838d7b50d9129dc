#include "weighted_mean.hpp"

#include <cmath>
#include <limits>

namespace bodeflow::spectrum {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Uncertain mean_of_exact(const std::vector<Uncertain>& numbers) {
  Uncertain mean{{}, 0.0, kInfinity};
  double count = 0.0;
  for (const Uncertain& u : numbers) {
    if (u.variance != 0.0) continue;
    mean.value += u.value;
    count += 1.0;
  }
  mean.value /= count;
  return mean;
}

}  // namespace

Uncertain weighted_mean(const std::vector<Uncertain>& numbers) {
  if (numbers.size() == 1) return numbers.front();
  double least = kInfinity;
  for (const Uncertain& u : numbers) least = std::min(least, u.variance);
  if (least == 0.0) return mean_of_exact(numbers);
  double total = 0.0;  // of least / v, which cannot overflow
  for (const Uncertain& u : numbers) total += least / u.variance;
  Uncertain mean;
  double widening = 1.0, freedom = 0.0;
  for (const Uncertain& u : numbers) {
    const double weight = least / u.variance / total;
    mean.value += weight * u.value;
    widening += 2.0 * weight * (1.0 - weight) / u.degrees_of_freedom;
    freedom += weight * weight / u.degrees_of_freedom;
  }
  mean.variance = least / total * widening;
  mean.degrees_of_freedom = 1.0 / freedom;
  return mean;
}

double agreement(const Uncertain& a, const Uncertain& b) {
  const double distance = std::norm(a.value - b.value), variance = a.variance + b.variance;
  if (distance == 0.0) return 1.0;
  if (variance == 0.0) return 0.0;
  const double x = distance / variance;
  const double share = a.variance / variance, rest = b.variance / variance;
  const double nu = 1.0 / (share * share / a.degrees_of_freedom + rest * rest / b.degrees_of_freedom);
  return std::isinf(nu) ? std::exp(-x) : std::exp(-nu * std::log1p(x / nu));
}

}  // namespace bodeflow::spectrum
