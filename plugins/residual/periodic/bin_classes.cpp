#include "periodic/bin_classes.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <bodeflow/numerics/chi_squared.hpp>
#include <cmath>
#include <optional>

#include "statistics.hpp"

namespace bodeflow::residual {
namespace {

// Part of the floor's variance that a mean over bins of which the floor is made still has beside it: medians of n exponential
// values have the variance 2.08 / n in logarithms and the covariance 1 / n with means over any of these values.
constexpr double kOwnFloor = 0.08 / 2.08;

// Points and weights of Gauss and Hermite for a standard normal deviate.
constexpr std::pair<double, double> kNormal[] = {{0.0, 8.0 / 15.0},
                                                 {1.355626179974266, 0.222075922005613},
                                                 {-1.355626179974266, 0.222075922005613},
                                                 {2.856970013872806, 0.011257411327721},
                                                 {-2.856970013872806, 0.011257411327721}};

double multiple(double mean_square) { return std::sqrt(std::max(mean_square, 0.0)); }

std::vector<Eigen::Index> bins_of(const PeriodicRecord& r, Kind kind) {
  std::vector<Eigen::Index> bins;
  for (Eigen::Index l = 0; l < r.bins(); ++l)
    if (r.kind[static_cast<std::size_t>(l)] == kind) bins.push_back(l);
  return bins;
}

Eigen::VectorXd frequencies(const PeriodicRecord& r, const std::vector<Eigen::Index>& bins) {
  Eigen::VectorXd f(static_cast<Eigen::Index>(bins.size()));
  for (std::size_t n = 0; n < bins.size(); ++n) f[static_cast<Eigen::Index>(n)] = r.frequency_hz[bins[n]];
  return f;
}

/// Sum of squares of a class, the part that uncertain parameters may have made taken out, and its degrees of freedom.
struct Sum {
  double squares = 0.0, freedom = 0.0;
};

class Tester {
 public:
  Tester(const PeriodicRecord& record, const Eigen::VectorXd& residual, const Eigen::MatrixXd& jacobian,
         const Eigen::MatrixXd& covariance, bool fitted)
      : r_(record), residual_(residual), jacobian_(jacobian), covariance_(covariance), fitted_(fitted) {}

  std::optional<ClassTest> lines(const char* name, Kind kind) const {
    const std::vector<Eigen::Index> bins = bins_of(r_, kind);
    if (bins.empty()) return {};
    const Sum s = sum(bins);
    if (s.freedom < 0.5) return {};
    const double ratio = s.squares / s.freedom;
    return ClassTest{name, multiple(ratio), f_tail(ratio, s.freedom, 2.0 / r_.floor.relative_variance(frequencies(r_, bins)))};
  }

  /// Of bins from which the floor is made.
  std::optional<ClassTest> between(const char* name, Kind kind) const {
    const std::vector<Eigen::Index> bins = bins_of(r_, kind);
    if (bins.empty()) return {};
    const Sum s = sum(bins);
    if (s.freedom < 0.5) return {};
    const double ratio = s.squares / s.freedom;
    const double freedom = 2.0 / (2.0 / s.freedom + kOwnFloor * r_.floor.relative_variance(frequencies(r_, bins)));
    return ClassTest{name, multiple(ratio), numerics::chi_squared_tail(ratio * freedom, freedom)};
  }

  /// Chance of such a highest bin. Given the floor's error, bins above x come as in a Poisson process, their number S in the
  /// mean; the error is one for bins near each other, so S scatters as a mean over as many independent parts as the band has.
  std::optional<ClassTest> peak() const {
    double highest = 0.0, count = 0.0;
    Eigen::Index where = 0;
    for (Eigen::Index l = 0; l < r_.bins(); ++l) {
      const Kind kind = r_.kind[static_cast<std::size_t>(l)];
      if (kind != Kind::between && kind != Kind::skirt) continue;
      const BinRows rows = rows_of(l);
      const double power = residual_.segment(rows.begin, rows.count).squaredNorm() / 2.0;
      ++count;
      if (power <= highest) continue;
      highest = power;
      where = l;
    }
    if (count == 0.0) return {};
    std::vector<Eigen::Index> bins = bins_of(r_, Kind::between);
    const std::vector<Eigen::Index> skirts = bins_of(r_, Kind::skirt);
    bins.insert(bins.end(), skirts.begin(), skirts.end());
    const double near = r_.floor.relative_variance(Eigen::VectorXd::Constant(1, r_.frequency_hz[where]));
    const double parts = std::max(near / r_.floor.relative_variance(frequencies(r_, bins)), 1.0);
    double mean = 0.0, square = 0.0;  // of a bin's chance, over the floor's error
    for (const auto& [at, weight] : kNormal) {
      const double chance = std::exp(-highest * std::exp(at * std::sqrt(near)));
      mean += weight * chance;
      square += weight * chance * chance;
    }
    if (!(mean > 0.0)) return ClassTest{"peak", multiple(highest), 0.0};
    const double spread = std::sqrt(std::log1p((square / (mean * mean) - 1.0) / parts));
    double p = 0.0;
    for (const auto& [at, weight] : kNormal)
      p -= weight * std::expm1(-count * mean * std::exp(at * spread - 0.5 * spread * spread));
    return ClassTest{"peak", multiple(highest), std::clamp(p, 0.0, 1.0)};
  }

 private:
  Sum sum(const std::vector<Eigen::Index>& bins) const {
    Eigen::Index rows = 0;
    for (const Eigen::Index l : bins) rows += rows_of(l).count;
    Eigen::VectorXd r(rows);
    Eigen::MatrixXd j(rows, jacobian_.cols());
    Eigen::Index at = 0;
    for (const Eigen::Index l : bins) {
      const BinRows from = rows_of(l);
      r.segment(at, from.count) = residual_.segment(from.begin, from.count);
      j.middleRows(at, from.count) = jacobian_.middleRows(from.begin, from.count);
      at += from.count;
    }
    Sum s{r.squaredNorm(), static_cast<double>(rows)};
    const Eigen::MatrixXd gram = j.transpose() * j;
    if (fitted_) {
      s.freedom -= (gram * covariance_).trace();
    } else {
      const Eigen::VectorXd b = j.transpose() * r;
      const Eigen::MatrixXd middle = Eigen::MatrixXd::Identity(b.size(), b.size()) + covariance_ * gram;
      s.squares -= b.dot(middle.partialPivLu().solve(covariance_ * b));
    }
    return s;
  }

  const PeriodicRecord& r_;
  const Eigen::VectorXd& residual_;
  const Eigen::MatrixXd& jacobian_;
  const Eigen::MatrixXd& covariance_;
  bool fitted_;
};

}  // namespace

std::vector<ClassTest> test_bins(const PeriodicRecord& record, const Eigen::VectorXd& residual, const Eigen::MatrixXd& jacobian,
                                 const Eigen::MatrixXd& covariance, bool fitted) {
  const Tester tester(record, residual, jacobian, covariance, fitted);
  std::vector<ClassTest> tests;
  const auto keep = [&tests](std::optional<ClassTest> test) {
    if (test) tests.push_back(std::move(*test));
  };
  keep(tester.lines("excited", Kind::excited));
  keep(tester.lines("odd", Kind::odd));
  keep(tester.lines("even", Kind::even));
  keep(tester.lines("dc", Kind::dc));
  keep(tester.between("skirts", Kind::skirt));
  keep(tester.between("between", Kind::between));
  keep(tester.peak());
  return tests;
}

}  // namespace bodeflow::residual
