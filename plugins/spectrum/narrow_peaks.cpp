#include "narrow_peaks.hpp"

#include <cmath>
#include <optional>

namespace bodeflow::spectrum {
namespace {

constexpr double kThreeDecibel = 0.70710678118654752;
constexpr double kStandardDeviations = 4.0;

/// Rows from `peak` in direction `step` to where |G| falls through the level; nothing where it rises above the peak or ends
/// before.
std::optional<double> distance(const Eigen::VectorXd& size, Eigen::Index peak, Eigen::Index step, double most) {
  const double level = kThreeDecibel * size[peak];
  for (Eigen::Index k = peak + step; k >= 0 && k < size.size(); k += step) {
    const auto steps = static_cast<double>((k - peak) * step);
    if (size[k] > size[peak] || steps > most + 1.0) return std::nullopt;
    if (size[k] > level) continue;
    const double before = size[k - step];
    return steps - (level - size[k]) / (before - size[k]);
  }
  return std::nullopt;
}

}  // namespace

std::vector<Peak> narrow_peaks(const Eigen::Ref<const Eigen::VectorXcd>& response,
                               const Eigen::Ref<const Eigen::VectorXd>& variance, double width_lines) {
  const Eigen::VectorXd size = response.cwiseAbs();
  std::vector<Peak> peaks;
  for (Eigen::Index k = 1; k + 1 < size.size(); ++k) {
    if (!(size[k] > size[k - 1] && size[k] >= size[k + 1])) continue;
    const double deviation = std::sqrt(variance[k] / 2.0);  // of the magnitude: half of the complex variance
    if ((1.0 - kThreeDecibel) * size[k] < kStandardDeviations * deviation) continue;
    const auto left = distance(size, k, -1, width_lines), right = distance(size, k, 1, width_lines);
    if (left && right && *left + *right < width_lines) peaks.push_back({k, *left + *right});
  }
  return peaks;
}

}  // namespace bodeflow::spectrum
