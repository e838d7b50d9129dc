#include "starts.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "linear_start.hpp"

namespace bodeflow::maximum_likelihood {

namespace {

using Complex = std::complex<double>;

constexpr int kQuick = 5;      // iterations a delay of the grid
constexpr int kThorough = 30;  // iterations a start
constexpr std::size_t kDelays = 3;
constexpr double kAlike = 1e-6;  // relative difference of cost
constexpr int kGridLimit = 2000;

// Real places where a grown pole is put: low, middle and high in the band; stable.
std::vector<double> places(const Lines& lines, Domain domain, double sample_time_s) {
  const double highest = lines.omega_rad_s[lines.size() - 1];
  double lowest = highest;
  for (const double omega : lines.omega_rad_s) lowest = omega > 0.0 ? std::min(lowest, omega) : lowest;
  std::vector<double> found;
  for (const double omega : {lowest, std::sqrt(lowest * highest), highest})
    found.push_back(domain == Domain::s ? -omega / lines.scale : std::exp(-omega * sample_time_s));
  return found;
}

}  // namespace

std::vector<double> promising_delays(const Lines& lines, const Structure& structure) {
  if (!structure.estimate_delay) return {structure.delay_s};
  const double highest = lines.omega_rad_s[lines.size() - 1];
  const double range = structure.delay_high_s - structure.delay_low_s;
  const int steps = std::clamp(static_cast<int>(std::ceil(range * highest * 4.0 / std::numbers::pi)), 2, kGridLimit);
  std::vector<double> delays, costs;
  for (int i = 0; i <= steps; ++i) {
    const double delay = structure.delay_low_s + range * i / steps;
    const auto start = linear_start(lines, structure, delay, linear_methods().front(), kQuick);
    delays.push_back(delay);
    costs.push_back(start ? cost(lines, *start) : std::numeric_limits<double>::infinity());
  }
  std::vector<std::size_t> minima;
  for (std::size_t i = 0; i < costs.size(); ++i) {
    const bool before = i == 0 || costs[i] <= costs[i - 1], after = i + 1 == costs.size() || costs[i] <= costs[i + 1];
    if (before && after && std::isfinite(costs[i])) minima.push_back(i);
  }
  std::stable_sort(minima.begin(), minima.end(), [&](std::size_t a, std::size_t b) { return costs[a] < costs[b]; });
  std::vector<double> best;
  for (std::size_t i = 0; i < std::min(kDelays, minima.size()); ++i) best.push_back(delays[minima[i]]);
  if (best.empty()) best.push_back(structure.delay_low_s);
  return best;
}

std::vector<Start> linear_starts(const Lines& lines, const Structure& structure, const std::vector<double>& delays) {
  std::vector<Start> all;
  for (const double delay : delays) {
    for (const LinearMethod& method : linear_methods()) {
      auto found = linear_start(lines, structure, delay, method, kThorough);
      if (!found) continue;
      const double at = cost(lines, *found);
      std::string name = method.total ? "total least squares" : "Sanathanan-Koerner";
      if (method.relaxation != 1.0) name += ", relaxed";
      if (method.rolled_off) name += ", rolled off";
      all.push_back({std::move(name), std::move(*found), at});
    }
  }
  std::stable_sort(all.begin(), all.end(), [](const Start& a, const Start& b) { return a.cost < b.cost; });
  std::vector<Start> kept;
  for (Start& start : all) {
    if (kept.empty() || start.cost > kept.back().cost * (1.0 + kAlike) || start.estimate.delay_s != kept.back().estimate.delay_s)
      kept.push_back(std::move(start));
  }
  return kept;
}

Expected<Estimate> estimate_with(const Lines& lines, const Structure& structure, const Eigen::VectorXcd& a,
                                 const Eigen::MatrixXcd& b, double delay_s) {
  const Eigen::VectorXcd delay = delay_factor(lines, delay_s);
  Eigen::MatrixXd deviation(b.rows(), b.cols());
  for (Eigen::Index i = 0; i < b.cols(); ++i) {
    const Channel& c = lines.channels[static_cast<std::size_t>(i)];
    for (Eigen::Index k = 0; k < b.rows(); ++k) {
      const Complex db = delay[k] * b(k, i);
      deviation(k, i) = std::sqrt(std::norm(a[k]) * c.output_variance[k] + std::norm(db) * c.input_variance[k] -
                                  2.0 * std::real(std::conj(db) * a[k] * c.covariance[k]));
    }
  }
  if (!deviation.allFinite() || !(deviation.minCoeff() > 0.0)) return refused("a line has no variance at this model");
  auto bases = bases_for(lines, structure, deviation / deviation.maxCoeff());
  if (!bases) return refusal_in(bases);
  Eigen::VectorXd theta(bases->size());
  theta.head(bases->denominator.size()) = bases->denominator.coefficients(a);
  for (std::size_t i = 0; i < bases->numerators.size(); ++i) {
    theta.segment(bases->offset(i), bases->numerators[i].size()) =
        bases->numerators[i].coefficients(b.col(static_cast<Eigen::Index>(i)));
  }
  return Estimate{std::move(*bases), theta, delay_s};
}

std::vector<Start> reflected(const Fit& fit) {
  const Structure& structure = fit.structure;
  if (!structure.fixed.empty()) return {};
  const Estimate& from = fit.minimum.estimate;
  const Eigen::VectorXcd poles = from.bases.denominator.roots(from.theta.head(from.bases.denominator.size()));
  Eigen::VectorXcd a = from.denominator();
  bool any = false;
  for (const Complex p : poles) {
    const bool unstable = structure.domain == Domain::s ? p.real() > 0.0 : std::abs(p) > 1.0;
    if (!unstable) continue;
    any = true;
    const Complex mirror = structure.domain == Domain::s ? -std::conj(p) : 1.0 / std::conj(p);
    a.array() *= (fit.lines.points.array() - mirror) / (fit.lines.points.array() - p);
  }
  if (!any) return {};
  Eigen::MatrixXcd b(fit.lines.size(), static_cast<Eigen::Index>(fit.lines.channels.size()));
  for (Eigen::Index i = 0; i < b.cols(); ++i) b.col(i) = from.numerator(static_cast<std::size_t>(i));
  auto start = estimate_with(fit.lines, structure, a, b, from.delay_s);
  if (!start) return {};
  const double at = cost(fit.lines, *start);
  if (!std::isfinite(at)) return {};
  return {{"poles reflected", std::move(*start), at}};
}

std::vector<Start> grown(const Lines& lines, const Structure& structure, const Fit& lower) {
  const Estimate& from = lower.minimum.estimate;
  const double sample_time_s =
      structure.domain == Domain::z ? std::arg(lines.points[lines.size() - 1]) / lines.omega_rad_s[lines.size() - 1] : 0.0;
  constexpr double kApart = 1.02;  // distance of the zero from the pole: exactly together they would not move
  std::vector<Start> found;
  for (const double place : places(lines, structure.domain, sample_time_s)) {
    const Eigen::VectorXcd a = from.denominator().array() * (lines.points.array() - place);
    Eigen::MatrixXcd b(lines.size(), static_cast<Eigen::Index>(lines.channels.size()));
    for (Eigen::Index i = 0; i < b.cols(); ++i) {
      const Eigen::Index extra =
          structure.numerator_orders[static_cast<std::size_t>(i)] - lower.structure.numerator_orders[static_cast<std::size_t>(i)];
      b.col(i) = from.numerator(static_cast<std::size_t>(i));
      if (extra > 0) {
        b.col(i).array() *= lines.points.array() - place * kApart;
      } else {
        b.col(i) *= std::abs(place);
      }
    }
    auto start = estimate_with(lines, structure, a, b, from.delay_s);
    if (!start) continue;
    const double at = cost(lines, *start);
    if (std::isfinite(at)) found.push_back({"grown from order " + std::to_string(lower.structure.order), std::move(*start), at});
  }
  return found;
}

}  // namespace bodeflow::maximum_likelihood
