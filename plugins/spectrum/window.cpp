#include "window.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace bodeflow::spectrum {
namespace {

constexpr double kTwoPi = 6.283185307179586476925;

const std::vector<std::pair<std::string, std::vector<double>>>& table() {
  static const std::vector<std::pair<std::string, std::vector<double>>> windows = {
      {"hann", {0.5, 0.5}},
      {"hamming", {0.54, 0.46}},
      {"blackman", {0.42, 0.5, 0.08}},
      {"blackman_harris", {0.35875, 0.48829, 0.14128, 0.01168}},
      {"flat_top", {0.21557895, 0.41663158, 0.277263158, 0.083578947, 0.006947368}},
      {"rectangular", {1.0}},
  };
  return windows;
}

}  // namespace

const std::vector<std::string>& window_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const auto& entry : table()) list.push_back(entry.first);
    return list;
  }();
  return names;
}

std::int64_t correlated_lines(const std::string& window) {
  const auto found = std::find_if(table().begin(), table().end(), [&](const auto& entry) { return entry.first == window; });
  return 2 * static_cast<std::int64_t>(found->second.size() - 1);
}

Eigen::VectorXd window(const std::string& name, Eigen::Index length) {
  const auto found = std::find_if(table().begin(), table().end(), [&](const auto& entry) { return entry.first == name; });
  Eigen::VectorXd w = Eigen::VectorXd::Zero(length);
  for (std::size_t m = 0; m < found->second.size(); ++m) {
    const double a = m % 2 == 0 ? found->second[m] : -found->second[m];
    const double step = kTwoPi * static_cast<double>(m) / static_cast<double>(length);
    for (Eigen::Index n = 0; n < length; ++n) w[n] += a * std::cos(step * static_cast<double>(n));
  }
  return w;
}

double noise_bandwidth_lines(const Eigen::VectorXd& w) {
  const double sum = w.sum();
  return static_cast<double>(w.size()) * w.squaredNorm() / (sum * sum);
}

double effective_averages(const Eigen::VectorXd& w, Eigen::Index hop, std::int64_t count) {
  const auto total = static_cast<double>(count);
  double correlated = 0.0;
  for (std::int64_t m = 1; m < count && m * hop < w.size(); ++m) {
    const Eigen::Index common = w.size() - m * hop;
    const double rho = w.head(common).dot(w.tail(common)) / w.squaredNorm();
    correlated += (1.0 - static_cast<double>(m) / total) * rho * rho;
  }
  return total / (1.0 + 2.0 * correlated);
}

}  // namespace bodeflow::spectrum
