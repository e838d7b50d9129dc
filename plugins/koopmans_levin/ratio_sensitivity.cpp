#include "ratio_sensitivity.hpp"

#include <cmath>
#include <cstdio>

namespace bodeflow::koopmans_levin {

namespace {

std::string warning(const std::string& name, double factor, double in_std) {
  char text[160];
  std::snprintf(text, sizeof text,
                "a factor %.3g in the noise ratio moves %s by %.1f standard deviations: measure the ratio, or estimate it",
                factor, name.c_str(), in_std);
  return text;
}

}  // namespace

RatioSensitivity ratio_sensitivity(const Eigen::VectorXd& centre, const Eigen::VectorXd& below, const Eigen::VectorXd& above,
                                   const Eigen::MatrixXd& covariance, double factor) {
  const Eigen::VectorXd down = below - centre, up = above - centre;
  const auto names = parameter_names((centre.size() - 1) / 2);
  RatioSensitivity s;
  s.factor = factor;
  s.shift.resize(centre.size());
  s.shift_in_std.resize(centre.size());
  for (Eigen::Index i = 0; i < centre.size(); ++i) {
    s.shift[i] = std::abs(up[i]) > std::abs(down[i]) ? up[i] : down[i];
    s.shift_in_std[i] = std::abs(s.shift[i]) / std::sqrt(covariance(i, i));
    if (s.shift_in_std[i] > 1.0) s.warnings.push_back(warning(names[static_cast<std::size_t>(i)], factor, s.shift_in_std[i]));
  }
  return s;
}

Expected<RatioSensitivity> ratio_sensitivity(const Factors& factors, const Solution& solution, const Eigen::MatrixXd& covariance,
                                             double factor) {
  if (!(factor > 1.0)) return refused("the factor of the noise ratio must be above 1");
  const auto below = solve(factors, solution.ratio / factor, solution.noise_matrix);
  if (!below) return tl::make_unexpected(below.error());
  const auto above = solve(factors, solution.ratio * factor, solution.noise_matrix);
  if (!above) return tl::make_unexpected(above.error());
  return ratio_sensitivity(parameters(solution), parameters(*below), parameters(*above), covariance, factor);
}

}  // namespace bodeflow::koopmans_levin
