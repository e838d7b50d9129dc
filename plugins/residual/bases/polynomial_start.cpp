#include "polynomial_start.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

namespace bodeflow::residual {
namespace {

using Complex = std::complex<double>;
constexpr int kMost = 4;          // coefficients
constexpr int kReweightings = 8;  // settles to a start within a few per cent long before
constexpr double kSingular = 1e-13;

using Row = std::array<double, kMost + 1>;  // left sides, right side

/// The solution of n normal equations by Cholesky's factorisation; nothing where they are singular.
std::optional<std::vector<double>> solve_normal(std::array<Row, kMost> a, int n) {
  std::array<double, kMost> scale{};
  for (int i = 0; i < n; ++i) {
    if (!(a[i][i] > 0.0)) return std::nullopt;
    scale[i] = 1.0 / std::sqrt(a[i][i]);
  }
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) a[i][j] *= scale[i] * scale[j];
    a[i][kMost] *= scale[i];
  }
  for (int j = 0; j < n; ++j) {
    for (int k = 0; k < j; ++k) a[j][j] -= a[j][k] * a[j][k];
    if (!(a[j][j] > kSingular)) return std::nullopt;
    a[j][j] = std::sqrt(a[j][j]);
    for (int i = j + 1; i < n; ++i) {
      for (int k = 0; k < j; ++k) a[i][j] -= a[i][k] * a[j][k];
      a[i][j] /= a[j][j];
    }
  }
  std::vector<double> x(static_cast<std::size_t>(n));
  const auto at = [&x](int i) -> double& { return x[static_cast<std::size_t>(i)]; };
  for (int i = 0; i < n; ++i) {
    at(i) = a[i][kMost];
    for (int k = 0; k < i; ++k) at(i) -= a[i][k] * at(k);
    at(i) /= a[i][i];
  }
  for (int i = n - 1; i >= 0; --i) {
    for (int k = i + 1; k < n; ++k) at(i) -= a[k][i] * at(k);
    at(i) /= a[i][i];
  }
  for (int i = 0; i < n; ++i) at(i) *= scale[i];
  return x;
}

Complex value_at(const std::vector<double>& d, Complex s) {
  Complex sum = 0.0;
  for (std::size_t i = d.size(); i-- > 0;) sum = sum * s + d[i];
  return sum;
}

}  // namespace

MeasuredResponse joined_lines(std::span<const MeasuredResponse> measured) {
  MeasuredResponse all;
  for (const MeasuredResponse& m : measured) {
    for (std::size_t i = 0; i < m.frequency_hz.size(); ++i) {
      const double weight = m.weight.empty() ? 1.0 / std::abs(m.response[i]) : m.weight[i];
      if (!(m.frequency_hz[i] > 0.0) || !(std::abs(m.response[i]) > 0.0) || !(weight > 0.0)) continue;
      all.frequency_hz.push_back(m.frequency_hz[i]);
      all.response.push_back(m.response[i]);
      all.weight.push_back(weight);
    }
  }
  std::vector<std::size_t> order(all.frequency_hz.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&all](std::size_t a, std::size_t b) { return all.frequency_hz[a] < all.frequency_hz[b]; });
  MeasuredResponse sorted;
  for (const std::size_t i : order) {
    sorted.frequency_hz.push_back(all.frequency_hz[i]);
    sorted.response.push_back(all.response[i]);
    sorted.weight.push_back(all.weight[i]);
  }
  return sorted;
}

std::optional<std::vector<double>> denominator_near(std::span<const MeasuredResponse> measured,
                                                    const std::function<Complex(Complex)>& numerator, int degree) {
  const MeasuredResponse lines = joined_lines(measured);
  const int n = degree + 1;
  const std::size_t count = lines.frequency_hz.size();
  if (2 * count < static_cast<std::size_t>(n)) return std::nullopt;
  double log_sum = 0.0;
  for (const double f : lines.frequency_hz) log_sum += std::log(f);
  const double unit = 2.0 * std::numbers::pi * std::exp(log_sum / static_cast<double>(count));  // s counts in it
  std::vector<double> d;
  for (int round = 0; round < kReweightings; ++round) {
    std::array<Row, kMost> normal{};
    for (std::size_t i = 0; i < count; ++i) {
      const Complex s(0.0, 2.0 * std::numbers::pi * lines.frequency_hz[i]), g = lines.response[i], top = numerator(s);
      const double w = lines.weight[i] / std::abs(d.empty() ? top / g : value_at(d, s / unit));
      std::array<Complex, kMost + 1> row{};
      Complex power = g * w;
      for (int c = 0; c < n; ++c, power *= s / unit) row[static_cast<std::size_t>(c)] = power;
      row[kMost] = top * w;
      for (int a = 0; a < n; ++a) {
        for (std::size_t b = 0; b <= kMost; ++b)
          normal[static_cast<std::size_t>(a)][b] += (std::conj(row[static_cast<std::size_t>(a)]) * row[b]).real();
      }
    }
    auto next = solve_normal(normal, n);
    if (!next) return std::nullopt;
    d = std::move(*next);
  }
  double scale = 1.0;
  for (double& c : d) c /= scale, scale *= unit;
  return d;
}

}  // namespace bodeflow::residual
