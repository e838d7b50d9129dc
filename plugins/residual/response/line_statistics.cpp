#include "line_statistics.hpp"

#include <algorithm>
#include <bodeflow/numerics/chi_squared.hpp>
#include <cmath>

namespace bodeflow::residual {
namespace {

constexpr Eigen::Index kBlocks = 40;
// Beyond as many degrees of freedom a variance counts as known.
constexpr double kKnown = 1e9;

double normal_tail(double z) { return 0.5 * std::erfc(z / std::sqrt(2.0)); }

}  // namespace

double lines_tail(const Eigen::VectorXd& residual, double nu, double fitted, double correlated) {
  double sum = 0.0;
  for (Eigen::Index k = 0; k + 1 < residual.size(); k += 2) {
    const double square = residual.segment<2>(k).squaredNorm();
    sum += nu < kKnown ? 2.0 * nu * std::log1p(square / (2.0 * nu)) : square;
  }
  const double shared = 2.0 * correlated + 1.0, freedom = static_cast<double>(residual.size()) - fitted;
  if (!(freedom > 0.0)) return 1.0;
  return numerics::chi_squared_tail(sum / shared, freedom / shared);
}

double likeness_tail(const Eigen::VectorXd& residual, Eigen::Index inputs) {
  const Eigen::Index rows = residual.size() / inputs;
  double sum = 0.0, squares = 0.0;
  for (Eigen::Index j = 0; j < inputs; ++j) {
    for (Eigen::Index k = 0; k + 3 < rows; k += 2) {
      const double product = residual.segment<2>(j * rows + k).dot(residual.segment<2>(j * rows + k + 2));
      sum += product;
      squares += product * product;
    }
  }
  return squares > 0.0 ? normal_tail(sum / std::sqrt(squares)) : 1.0;
}

double likeness_length(const Eigen::VectorXd& residual, Eigen::Index inputs) {
  const Eigen::Index rows = residual.size() / inputs, lines = rows / 2;
  const double power = residual.squaredNorm();
  if (!(power > 0.0)) return 1.0;
  double length = 1.0;
  for (Eigen::Index lag = 1; lag < lines; ++lag) {
    double sum = 0.0;
    for (Eigen::Index j = 0; j < inputs; ++j)
      sum += residual.segment(j * rows, rows - 2 * lag).dot(residual.segment(j * rows + 2 * lag, rows - 2 * lag));
    if (!(sum > 0.0)) break;
    length += 2.0 * sum / power;
  }
  return std::clamp(length, 1.0, std::max(static_cast<double>(lines) / 4.0, 1.0));
}

double block_deviate(const Eigen::VectorXd& before, const Eigen::VectorXd& after, Eigen::Index inputs) {
  const Eigen::Index rows = before.size() / inputs, lines = rows / 2;
  const Eigen::Index each = std::clamp<Eigen::Index>(kBlocks / inputs, 1, std::max<Eigen::Index>(lines, 1)),
                     count = each * inputs;
  Eigen::VectorXd fall(count);
  for (Eigen::Index j = 0; j < inputs; ++j) {
    for (Eigen::Index b = 0; b < each; ++b) {
      const Eigen::Index from = j * rows + 2 * (b * lines / each), to = j * rows + 2 * ((b + 1) * lines / each);
      fall[j * each + b] = before.segment(from, to - from).squaredNorm() - after.segment(from, to - from).squaredNorm();
    }
  }
  if (count < 2) return 0.0;
  const auto n = static_cast<double>(count);
  const double spread = std::sqrt((fall.array() - fall.mean()).square().sum() / (n - 1.0));
  return spread > 0.0 ? fall.mean() * std::sqrt(n) / spread : 0.0;
}

}  // namespace bodeflow::residual
