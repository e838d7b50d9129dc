#include "magnitude_factors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bodeflow::validation {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kEqual = 1e-10;     // 1 - rho below which the standard says 10
constexpr double kEdge = 1.1;        // a band is covered where the lines come that near to its ends
constexpr Eigen::Index kFewest = 8;  // lines for a factor of the standard

}  // namespace

Eigen::VectorXd decibels(const Eigen::VectorXcd& g) {
  return 20.0 * g.cwiseAbs().cwiseMax(std::numeric_limits<double>::min()).array().log10().matrix();
}

double correlation_coefficient(const Eigen::VectorXd& x, const Eigen::VectorXd& y) {
  const double size = x.norm() * y.norm();
  return size > 0.0 ? x.dot(y) / size : kNaN;
}

double relative_factor(const Eigen::VectorXd& before, const Eigen::VectorXd& after) {
  if (before.size() < 2) return kNaN;
  const Eigen::VectorXd x = before.array() - before.mean(), y = after.array() - after.mean();
  if (!(x.norm() > 0.0) || !(y.norm() > 0.0)) return kNaN;
  // 1 - rho without cancellation: half the squared distance of the normalised curves.
  const double apart = 0.5 * (x / x.norm() - y / y.norm()).squaredNorm();
  return apart < kEqual ? 10.0 : -std::log10(apart);
}

StandardFactors standard_factors(const Eigen::VectorXd& f, const Eigen::VectorXcd& before, const Eigen::VectorXcd& after) {
  StandardFactors s{{{{"low", 1e3, 1e5, 0, kNaN}, {"medium", 1e5, 6e5, 0, kNaN}, {"high", 6e5, 1e6, 0, kNaN}}}, ""};
  const Eigen::VectorXd x = decibels(before), y = decibels(after);
  for (auto& band : s.bands) {
    const auto* first = std::lower_bound(f.data(), f.data() + f.size(), band.low_hz);
    const auto* last = std::upper_bound(f.data(), f.data() + f.size(), band.high_hz);
    band.lines = std::max<Eigen::Index>(0, last - first);
    if (band.lines < kFewest || *first > kEdge * band.low_hz || *(last - 1) * kEdge < band.high_hz) continue;
    band.factor = relative_factor(x.segment(first - f.data(), band.lines), y.segment(first - f.data(), band.lines));
  }
  const double low = s.bands[0].factor, medium = s.bands[1].factor, high = s.bands[2].factor;
  if (low < 0.6) {
    s.deformation = "severe";
  } else if (std::isnan(low) || std::isnan(medium)) {
    return s;
  } else if (low < 1.0 || medium < 0.6) {
    s.deformation = "obvious";
  } else if (low < 2.0 || medium < 1.0) {
    s.deformation = "slight";
  } else if (high >= 0.6) {
    s.deformation = "normal";
  }
  return s;
}

}  // namespace bodeflow::validation
