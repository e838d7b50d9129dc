#include "whiteness.hpp"

#include <bodeflow/numerics/chi_squared.hpp>
#include <string>
#include <vector>

namespace bodeflow::koopmans_levin {

namespace {
constexpr Eigen::Index kLeastLines = 5;  // the mean of fewer exponential variables is far from normal
}

Expected<Whiteness> whiteness(const Lines& lines, const Model& model, Eigen::Index bands) {
  std::vector<Eigen::Index> used;
  for (Eigen::Index i = 0; i < lines.size(); ++i) {
    if (!lines.is_real(i)) used.push_back(i);
  }
  const auto count = static_cast<Eigen::Index>(used.size());
  if (bands < 2 || count < kLeastLines * bands) {
    return refused("the whiteness test needs at least 2 bands of at least " + std::to_string(kLeastLines) + " lines; found " +
                   std::to_string(bands) + " bands of " + std::to_string(count) + " lines in all");
  }
  const Eigen::VectorXcd errors = equation_errors(lines, model);
  const Eigen::VectorXd variances = equation_variances(lines, model);
  Eigen::VectorXd share(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Index line = used[static_cast<std::size_t>(i)];
    share[i] = std::norm(errors[line]) / variances[line];
  }
  share /= share.mean();
  Whiteness w;
  w.band_mean.resize(bands);
  w.band_omega.resize(bands);
  for (Eigen::Index b = 0; b < bands; ++b) {
    const Eigen::Index first = b * count / bands, length = (b + 1) * count / bands - first;
    w.band_mean[b] = share.segment(first, length).mean();
    w.band_omega[b] = 0.5 * (lines.omega(used[static_cast<std::size_t>(first)]) +
                             lines.omega(used[static_cast<std::size_t>(first + length - 1)]));
    w.statistic += static_cast<double>(length) * (w.band_mean[b] - 1.0) * (w.band_mean[b] - 1.0);
  }
  w.degrees_of_freedom = static_cast<double>(bands - 1);
  w.probability = numerics::chi_squared_tail(w.statistic, w.degrees_of_freedom);
  return w;
}

}  // namespace bodeflow::koopmans_levin
