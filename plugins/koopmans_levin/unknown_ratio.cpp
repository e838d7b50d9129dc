#include "unknown_ratio.hpp"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "influence.hpp"

namespace bodeflow::koopmans_levin {

namespace {

constexpr int kGridHalf = 18;  // points each side of the middle, over a factor 100
constexpr double kGridRange = 100.0;
constexpr double kFloorRange = 1e4;
constexpr double kDerivativeStep = 1e-3;  // of ln(ratio): curvature and rounding both stay below 1e-6 of the slope
const double kWidest = std::log(2.0);

double middle_of_ratios(const Lines& lines) {
  const double yy = lines.weight.dot(lines.output.cwiseAbs2()), uu = lines.weight.dot(lines.input.cwiseAbs2());
  return std::log(yy / uu);
}

Eigen::Index usual_lags(const Lines& lines, Eigen::Index order) {
  if (lines.is_full_range()) return order;
  const double width = lines.omega(lines.size() - 1) - lines.omega(0);
  return std::max<Eigen::Index>(16, std::lround(1.5 * 2.0 * std::numbers::pi / width));
}

// r_e(m) - r_m(m), m = 0 .. M, and r_e(0) behind it.
Eigen::VectorXd mismatch(const Lines& lines, const Model& model, Eigen::Index lags) {
  const Eigen::VectorXd power = equation_errors(lines, model).cwiseAbs2();
  const Eigen::VectorXd difference = lines.weight.cwiseProduct(power - equation_variances(lines, model));
  Eigen::VectorXd d = Eigen::VectorXd::Zero(lags + 2);
  for (Eigen::Index k = 0; k < lines.size(); ++k) {
    const std::complex<double> z = std::polar(1.0, lines.omega(k));
    std::complex<double> power_of_z = difference[k];
    for (Eigen::Index m = 0; m <= lags; ++m, power_of_z *= z) d[m] += power_of_z.real();
  }
  d[lags + 1] = lines.weight.dot(power);
  return d / lines.total_weight();
}

double criterion(const Lines& lines, const Model& model, Eigen::Index lags) {
  const Eigen::VectorXd d = mismatch(lines, model, lags);
  return d.head(lags + 1).squaredNorm() / (d[lags + 1] * d[lags + 1]);
}

struct Minimum {
  double log_ratio = 0.0;
  bool at_end = false;
};

Expected<Minimum> search(const Lines& lines, const Factors& factors, Eigen::Index lags) {
  const double middle = middle_of_ratios(lines), step = std::log(kGridRange) / kGridHalf;
  std::vector<double> values;
  for (int i = -kGridHalf; i <= kGridHalf; ++i) {
    const auto s = solve(factors, std::exp(middle + i * step));
    if (!s) return tl::make_unexpected(s.error());
    values.push_back(criterion(lines, *s, lags));
  }
  const auto best = std::min_element(values.begin(), values.end());
  const double at = middle + static_cast<double>(best - values.begin() - kGridHalf) * step;
  if (best == values.begin() || best == values.end() - 1) return Minimum{at, true};
  const auto j = [&](double log_ratio) {
    const auto s = solve(factors, std::exp(log_ratio));
    return s ? criterion(lines, *s, lags) : HUGE_VAL;
  };
  std::uintmax_t iterations = 200;
  const auto minimum = boost::math::tools::brent_find_minima(j, at - step, at + step, 40, iterations);
  return Minimum{minimum.first, false};
}

// [a_n .. 1 | -b_n .. -b_0 | lambda] of a solution, the vector that Influence's changes refer to.
Eigen::VectorXd with_noise(const Solution& s) {
  Eigen::VectorXd p(s.x.size() + 1);
  p << s.x, s.noise;
  return p;
}

// How a solution and a quantity of it go with ln(ratio), by central differences.
template <class Quantity>
Expected<std::pair<Eigen::VectorXd, Eigen::VectorXd>> along_ratios(const Factors& factors, double ratio, Quantity&& quantity) {
  const auto below = solve(factors, ratio * std::exp(-kDerivativeStep)),
             above = solve(factors, ratio * std::exp(kDerivativeStep));
  if (!below) return tl::make_unexpected(below.error());
  if (!above) return tl::make_unexpected(above.error());
  const Eigen::VectorXd quantities = quantity(*above) - quantity(*below);
  return std::make_pair(Eigen::VectorXd((with_noise(*above) - with_noise(*below)) / (2.0 * kDerivativeStep)),
                        Eigen::VectorXd(quantities / (2.0 * kDerivativeStep)));
}

// d mismatch / d [x; lambda] at the ratio of the solution.
Eigen::MatrixXd mismatch_slope(const Lines& lines, const Influence& influence, const Solution& s, Eigen::Index lags) {
  const Eigen::Index q = s.x.size(), powers = q / 2;
  Eigen::MatrixXd slope = Eigen::MatrixXd::Zero(lags + 1, q + 1);
  Eigen::VectorXd one(q + 1);
  influence.for_each([&](Eigen::Index k, const Influence::Line& line) {
    one.head(q) = 2.0 * (std::conj(line.error) * line.row).real();
    one.head(powers) -= 2.0 * s.noise * s.ratio * (std::conj(line.A) * line.powers).real();
    one.segment(powers, powers) += 2.0 * s.noise * (std::conj(line.B) * line.powers).real();
    one[q] = -line.variance / s.noise;
    const double weight = lines.weight[k] / lines.total_weight();
    for (Eigen::Index m = 0; m <= lags; ++m) {
      slope.row(m) += weight * std::cos(static_cast<double>(m) * lines.omega(k)) * one.transpose();
    }
  });
  return slope;
}

// Fills deviation and covariance from the change of ln(ratio) that each line gives.
template <class RatioChange>
void add_covariance(const Influence& influence, const Eigen::VectorXd& locus, RatioChange&& ratio_change, RatioEstimate& e) {
  const Eigen::Index size = locus.size() - 1;
  e.covariance.setZero(size, size);
  double variance = 0.0;
  influence.for_each([&](Eigen::Index k, const Influence::Line& line) {
    const double change = ratio_change(k, line);
    variance += change * change;
    e.covariance.selfadjointView<Eigen::Lower>().rankUpdate(in_parameter_order(line.change + locus * change));
  });
  e.log_ratio_std = std::sqrt(variance);
  e.covariance = Eigen::MatrixXd(e.covariance.selfadjointView<Eigen::Lower>());
}

void judge(RatioEstimate& e) {
  e.determined = e.log_ratio_std <= kWidest;  // false for NaN as well
  if (!e.determined) e.reason = "the noise ratio is not determined: its standard deviation is more than a factor 2";
}

}  // namespace

Expected<RatioEstimate> ratio_by_covariance_matching(const Lines& lines, const Factors& factors,
                                                     std::optional<Eigen::Index> lags) {
  RatioEstimate e;
  e.lags = lags.value_or(usual_lags(lines, factors.order));
  if (e.lags < 1) return refused("covariance matching needs at least 1 lag");
  const auto minimum = search(lines, factors, e.lags);
  if (!minimum) return tl::make_unexpected(minimum.error());
  e.ratio = std::exp(minimum->log_ratio);
  auto solution = solve(factors, e.ratio);
  if (!solution) return tl::make_unexpected(solution.error());
  e.solution = *solution;
  e.criterion = criterion(lines, e.solution, e.lags);
  if (minimum->at_end) {
    e.reason = "the noise ratio is not determined: the criterion falls to the end of the ratios tried";
    return e;
  }
  const auto influence = Influence::of(lines, factors, e.solution);
  if (!influence) return tl::make_unexpected(influence.error());
  const auto slopes = along_ratios(factors, e.ratio, [&](const Solution& s) { return mismatch(lines, s, e.lags); });
  if (!slopes) return tl::make_unexpected(slopes.error());
  const auto& [locus, going] = *slopes;
  const Eigen::VectorXd g = going.head(e.lags + 1);
  const Eigen::VectorXd through = mismatch_slope(lines, *influence, e.solution, e.lags).transpose() * g;
  const double curvature = g.squaredNorm();
  add_covariance(
      *influence, locus,
      [&](Eigen::Index k, const Influence::Line& line) {
        double direct = 0.0;
        for (Eigen::Index m = 0; m <= e.lags; ++m) direct += g[m] * std::cos(static_cast<double>(m) * lines.omega(k));
        const double excess = lines.weight[k] / lines.total_weight() * (std::norm(line.error) - line.variance);
        return -(direct * excess + through.dot(line.change)) / curvature;
      },
      e);
  judge(e);
  return e;
}

Expected<RatioEstimate> ratio_from_output_noise(const Lines& lines, const Factors& factors, double output_noise,
                                                double output_noise_std) {
  if (!(output_noise > 0.0) || !std::isfinite(output_noise))
    return refused("the output noise variance must be above 0 and finite");
  const double middle = middle_of_ratios(lines), range = std::log(kFloorRange);
  // ln of the noise a ratio gives over the one measured: rises with the ratio, as points on a falling curve do with their
  // direction.
  const auto excess = [&](double log_ratio) {
    const auto s = solve(factors, std::exp(log_ratio));
    return s ? std::log(s->ratio * s->noise_unbiased / output_noise) : std::nan("");
  };
  RatioEstimate e;
  const double low = excess(middle - range), high = excess(middle + range);
  if (!(low < 0.0 && high > 0.0)) {
    e.reason = !(low < 0.0) ? "the noise ratio is not determined: the output noise given is smaller than any ratio makes it"
                            : "the noise ratio is not determined: the output noise given is greater than the record allows";
    return e;
  }
  std::uintmax_t iterations = 200;
  const auto bracket = boost::math::tools::toms748_solve(excess, middle - range, middle + range, low, high,
                                                         boost::math::tools::eps_tolerance<double>(48), iterations);
  e.ratio = std::exp(0.5 * (bracket.first + bracket.second));
  auto solution = solve(factors, e.ratio);
  if (!solution) return tl::make_unexpected(solution.error());
  e.solution = *solution;
  const auto influence = Influence::of(lines, factors, e.solution);
  if (!influence) return tl::make_unexpected(influence.error());
  const auto slopes =
      along_ratios(factors, e.ratio, [](const Solution& s) { return Eigen::VectorXd::Constant(1, std::log(s.ratio * s.noise)); });
  if (!slopes) return tl::make_unexpected(slopes.error());
  const auto& [locus, slope] = *slopes;
  const double rise = slope[0];
  add_covariance(
      *influence, locus,
      [&](Eigen::Index, const Influence::Line& line) { return -line.change[line.change.size() - 1] / e.solution.noise / rise; },
      e);
  const double from_floor = output_noise_std / output_noise / rise;
  const Eigen::VectorXd along = in_parameter_order(locus);
  e.covariance += from_floor * from_floor * along * along.transpose();
  e.log_ratio_std = std::hypot(e.log_ratio_std, from_floor);
  judge(e);
  return e;
}

double noise_floor(const Eigen::VectorXcd& spectrum) { return spectrum.squaredNorm() / static_cast<double>(spectrum.size()); }

}  // namespace bodeflow::koopmans_levin
