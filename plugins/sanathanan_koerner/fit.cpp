#include "fit.hpp"

#include <cmath>

#include "iteration.hpp"
#include "partial_fractions.hpp"
#include "race.hpp"
#include "vector_fitting.hpp"

namespace bodeflow::sanathanan_koerner {

Expected<Fit> fit(const Data& data, const Plane& plane, const FitSettings& settings, const Eigen::VectorXcd& start) {
  if (auto good = check(data); !good) return unexpected(good.error().text);
  if (auto good = check_order(data, settings.order); !good) return unexpected(good.error().text);
  const ScaledData scaled = scaled_data(data);
  Iteration iteration(scaled, plane, settings, start);
  while (iteration.advance()) {
  }
  return std::move(iteration).result();
}

Eigen::VectorXd prewarp_candidates(const Eigen::VectorXd& omega, Eigen::Index count) {
  const double last = omega[omega.size() - 1];
  double first = omega[0];
  if (first == 0.0) first = omega.size() > 1 ? omega[1] : 1.0;
  if (!(last > 0.0)) return Eigen::VectorXd::Ones(1);
  Eigen::VectorXd a(count);
  for (Eigen::Index i = 0; i < count; ++i)
    a[i] = std::sqrt(first * last) *
           std::pow(10.0, static_cast<double>(i) / static_cast<double>(std::max<Eigen::Index>(count - 1, 1)));
  return a;
}

Eigen::VectorXcd denominator_of(const Eigen::VectorXcd& poles, const Plane& plane, const Eigen::VectorXd& omega) {
  Eigen::VectorXcd d = Eigen::VectorXcd::Ones(omega.size());
  const Eigen::VectorXcd z = plane.circle(omega);
  for (const std::complex<double> p : poles) {
    const std::complex<double> a = plane.prewarp_rad_s, root = plane.discrete() ? p : (a + p) / (a - p);
    d.array() *= z.array() - root;
    d /= d.cwiseAbs().maxCoeff();
  }
  return d;
}

Expected<Fit> fit_with_scan(const Data& data, const FitSettings& settings) {
  if (auto good = check(data); !good) return unexpected(good.error().text);
  if (auto good = check_order(data, settings.order); !good) return unexpected(good.error().text);
  const ScaledData scaled = scaled_data(data);
  const Eigen::VectorXd candidates = prewarp_candidates(data.omega_rad_s);
  std::vector<Iteration> starts;
  for (const double a : candidates) starts.emplace_back(scaled, Plane{a, 0.0}, settings);
  const Plane middle{candidates[candidates.size() / 2], 0.0};
  for (const PoleSet& poles : starting_poles(data, settings.order, Spacing::automatic))
    starts.emplace_back(scaled, middle, settings, denominator_of(all_poles(poles), middle, data.omega_rad_s));
  Iteration* const best = race(starts);
  return std::move(best != nullptr ? *best : starts.front()).result();
}

}  // namespace bodeflow::sanathanan_koerner
