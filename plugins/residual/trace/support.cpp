#include "trace/support.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <bodeflow/numerics/chi_squared.hpp>
#include <cmath>

#include "records/signals.hpp"

namespace bodeflow::residual {
namespace {

using records::short_number;

constexpr Eigen::Index kBlocks = 40;
// So many times the largest flow or deflection of the records.
constexpr double kSeen = 2.0;
// An estimate may be beyond a bound by this part of it.
constexpr double kAtBound = 0.1;

/// Covariance of the coordinates from the scores of blocks of rows: whatever correlation the residual has within a block.
Eigen::MatrixXd covariance_by_blocks(const Fit& fit) {
  const Eigen::MatrixXd normal = pseudo_inverse_normal(fit.jacobian);
  Eigen::MatrixXd scores(fit.jacobian.cols(), kBlocks);
  for (Eigen::Index b = 0; b < kBlocks; ++b) {
    const Eigen::Index first = b * fit.residual.size() / kBlocks, next = (b + 1) * fit.residual.size() / kBlocks;
    scores.col(b) = fit.jacobian.middleRows(first, next - first).transpose() * fit.residual.segment(first, next - first);
  }
  const Eigen::MatrixXd half = normal * scores;
  return half * half.transpose();
}

double wald(const Eigen::VectorXd& values, const Eigen::MatrixXd& covariance) {
  return values.dot(Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>(covariance).solve(values));
}

/// Why it can't be told from nothing.
std::string not_from_nothing(const Fit& fit, std::size_t addition, const std::vector<Eigen::Index>& amplitudes, double p) {
  const Addition& a = fit.model.additions[addition];
  const Eigen::Index begin = fit.model.begin_of(addition);
  const Eigen::VectorXd values = fit.values(), slopes = fit.layout.slopes(values), std = fit.std();
  std::vector<Eigen::Index> places, coordinates;
  std::string words;
  for (const Eigen::Index i : amplitudes) {
    const FitParameter& parameter = a.parameters[static_cast<std::size_t>(i)];
    if (parameter.each_record) return "";
    places.push_back(begin + i);
    coordinates.push_back(fit.layout.index(static_cast<std::size_t>(begin + i), 0));
    words += (words.empty() ? "" : " and ") + parameter.name + " = " + short_number(values[begin + i], 3);
  }
  if (places.empty()) return "";
  const Eigen::VectorXd size = values(places), slope = slopes(places);
  const Eigen::MatrixXd by_fit = fit.covariance(coordinates, coordinates),
                        by_blocks = covariance_by_blocks(fit)(coordinates, coordinates);
  double least = std::numeric_limits<double>::infinity();
  for (const Eigen::MatrixXd& c : {by_fit, by_blocks})
    least = std::min(least, wald(size, slope.asDiagonal() * c * slope.asDiagonal()));
  if (!(numerics::chi_squared_tail(least, static_cast<double>(places.size())) < p))
    return words + " can't be told from 0: " + short_number(std::sqrt(std::max(least, 0.0)), 2) + " deviations";
  return "";
}

/// Which parameter speaks of what the records do not show.
std::string not_seen(const Addition& a, const Eigen::VectorXd& values, const std::vector<Eigen::Index>& amplitudes) {
  for (std::size_t i = 0; i < a.parameters.size(); ++i) {
    const FitParameter& p = a.parameters[i];
    const double value = values[static_cast<Eigen::Index>(i)], bound = value < p.low ? p.low : p.high;
    const double size = std::max(std::isfinite(bound) ? std::abs(bound) : 0.0, p.logarithmic ? 0.0 : std::abs(p.scale));
    if (const std::string where = beyond(p, value, kAtBound * size); !where.empty()) return p.name + " would be " + where;
    const bool amplitude = std::find(amplitudes.begin(), amplitudes.end(), static_cast<Eigen::Index>(i)) != amplitudes.end();
    if (amplitude || a.place == Addition::kNoPlace || p.unit.empty()) continue;
    const Place& place = a.situation.place;
    for (const auto& [unit, most] : {std::pair{place.stored_unit, place.stored}, std::pair{place.flow_unit, place.flow}})
      if (p.unit == unit && most > 0.0 && value > kSeen * most)
        return p.name + " would be " + short_number(value, 3) + " " + unit + ", and the records move by no more than " +
               short_number(most, 3) + " " + unit + " to a side";
  }
  return "";
}

}  // namespace

std::string hardly_supported(const Fit& fit, std::size_t addition, const std::vector<Eigen::Index>& amplitudes, double p) {
  const Addition& a = fit.model.additions[addition];
  const Eigen::VectorXd own = fit.values().segment(fit.model.begin_of(addition), static_cast<Eigen::Index>(a.parameters.size()));
  if (const std::string unseen = not_seen(a, own, amplitudes); !unseen.empty()) return unseen;
  if (fit.jacobian.rows() == 0) return "";
  return not_from_nothing(fit, addition, amplitudes, p);
}

}  // namespace bodeflow::residual
