#include "lines.hpp"

#include <algorithm>
#include <bodeflow/numerics/fft.hpp>
#include <cmath>
#include <numbers>
#include <string>

namespace bodeflow::koopmans_levin {

namespace {

constexpr Eigen::Index kMostSamples = Eigen::Index{1} << 30;  // line numbers are int

Expected<void> check_finite(const Eigen::Ref<const Eigen::VectorXd>& x, const std::string& name) {
  for (Eigen::Index t = 0; t < x.size(); ++t) {
    if (!std::isfinite(x[t])) return refused(name + ": sample " + std::to_string(t) + " is not a finite number");
  }
  return {};
}

}  // namespace

double Lines::omega(Eigen::Index line) const { return 2.0 * std::numbers::pi * k[line] / static_cast<double>(samples); }

bool Lines::is_real(Eigen::Index line) const { return k[line] == 0 || 2 * Eigen::Index{k[line]} == samples; }

Eigen::Index Lines::equations() const {
  Eigen::Index count = 0;
  for (Eigen::Index i = 0; i < size(); ++i) count += is_real(i) ? 1 : 2;
  return count;
}

Expected<void> check_records(const Eigen::Ref<const Eigen::VectorXd>& input, const Eigen::Ref<const Eigen::VectorXd>& output) {
  if (input.size() != output.size()) {
    return refused("input and output differ in length: " + std::to_string(input.size()) + " and " +
                   std::to_string(output.size()) + " samples");
  }
  if (input.size() == 0) return refused("the records are empty");
  if (input.size() > kMostSamples) {
    return refused(std::to_string(input.size()) + " samples are more than the " + std::to_string(kMostSamples) + " allowed");
  }
  if (auto fine = check_finite(input, "input"); !fine) return fine;
  return check_finite(output, "output");
}

Expected<Lines> lines_of(const Eigen::Ref<const Eigen::VectorXd>& input, const Eigen::Ref<const Eigen::VectorXd>& output,
                         std::optional<Band> band) {
  if (auto fine = check_records(input, output); !fine) return tl::make_unexpected(fine.error());
  const Eigen::Index n = input.size();
  const Band w = band.value_or(Band{0, n - 1});
  if (w.first < 0 || w.first > w.last || w.last > n - 1) {
    return refused("the band of lines " + std::to_string(w.first) + " .. " + std::to_string(w.last) + " is not within 0 .. " +
                   std::to_string(n - 1));
  }
  const Eigen::VectorXcd u = numerics::half_dft(input), y = numerics::half_dft(output);
  const auto in_band = [&](Eigen::Index k) { return k >= w.first && k <= w.last; };
  Lines lines;
  lines.samples = n;
  std::vector<int> numbers;
  std::vector<double> weights;
  for (Eigen::Index k = 0; k < u.size(); ++k) {
    const bool has_mirror = k != 0 && 2 * k != n;
    const int count = (in_band(k) ? 1 : 0) + (has_mirror && in_band(n - k) ? 1 : 0);
    if (count == 0) continue;
    numbers.push_back(static_cast<int>(k));
    weights.push_back(count);
  }
  const auto size = static_cast<Eigen::Index>(numbers.size());
  lines.k = Eigen::Map<const Eigen::VectorXi>(numbers.data(), size);
  lines.weight = Eigen::Map<const Eigen::VectorXd>(weights.data(), size);
  lines.input.resize(size);
  lines.output.resize(size);
  const double scale = 1.0 / std::sqrt(static_cast<double>(n));
  for (Eigen::Index i = 0; i < size; ++i) {
    lines.input[i] = scale * u[lines.k[i]];
    lines.output[i] = scale * y[lines.k[i]];
  }
  return lines;
}

Expected<Band> band_of(double low_rad, double high_rad, Eigen::Index samples) {
  constexpr double kPi = std::numbers::pi;
  if (!(low_rad >= 0.0 && low_rad <= high_rad && high_rad <= kPi * (1.0 + 1e-12))) {
    return refused("the band [" + std::to_string(low_rad) + ", " + std::to_string(high_rad) +
                   "] rad/sample is not within 0 .. pi");
  }
  const double lines_per_rad = static_cast<double>(samples) / (2.0 * kPi);
  const double low = low_rad * lines_per_rad, high = high_rad * lines_per_rad;
  const double first = std::round(low), last = std::round(high);
  constexpr double kRounding = 1e-9;
  if (std::ceil(low - kRounding) > std::floor(high + kRounding)) {
    return refused("no line lies in the band [" + std::to_string(low_rad) + ", " + std::to_string(high_rad) +
                   "] rad/sample: lines are " + std::to_string(1.0 / lines_per_rad) + " apart");
  }
  const auto line = [samples](double k) { return std::min(static_cast<Eigen::Index>(k), samples / 2); };
  return Band{line(first), line(last)};
}

}  // namespace bodeflow::koopmans_levin
