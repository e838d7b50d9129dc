#include "polish.hpp"

#include <Eigen/Eigenvalues>
#include <bodeflow/numerics/balanced_truncation.hpp>
#include <complex>

#include "quality.hpp"
#include "sanathanan_koerner/fit.hpp"

namespace bodeflow::subspace {
namespace {

using Complex = std::complex<double>;

/// The product of z - p at the lines. On the unit circle its size is between the products of 1 - |p| and 1 + |p|; it is scaled
/// factor by factor, because SK takes the weights' shape alone.
Eigen::VectorXcd denominator_of(const Eigen::VectorXcd& poles, const Eigen::VectorXcd& z) {
  Eigen::VectorXcd d = Eigen::VectorXcd::Ones(z.size());
  for (const Complex& p : poles) {
    d = d.cwiseProduct((z.array() - p).matrix());
    d /= d.cwiseAbs().maxCoeff();
  }
  return d;
}

}  // namespace

Expected<std::optional<Model>> polished(const Lines& lines, const Plane& plane, const Model& model, int iterations) {
  using namespace sanathanan_koerner;
  const Data data{lines.omega_rad_s, lines.response, lines.weight};
  FitSettings settings;
  settings.order = model.order();
  settings.stop.iterations = iterations;
  const auto found = fit(data, plane, settings, denominator_of(model.circle_poles, plane.circle(lines.omega_rad_s)));
  if (!found) return unexpected(found.error().text);
  auto system = state_space(found->model, lines.inputs());
  if (!system) return unexpected(system.error().text);
  if (system->states() > model.order()) {
    auto reduced = numerics::balanced_truncation(*system, model.order());
    if (!reduced) return std::optional<Model>();
    *system = std::move(reduced->system);
  }
  Model better;
  better.system = std::move(*system);
  better.response = response_of(better.system, lines.omega_rad_s);
  if (!(quality_of(lines, better.response).weighted < quality_of(lines, model.response).weighted)) return std::optional<Model>();
  better.poles = better.system.A.eigenvalues();
  better.circle_poles =
      plane.discrete()
          ? better.poles
          : better.poles.unaryExpr([&](Complex s) { return (plane.prewarp_rad_s + s) / (plane.prewarp_rad_s - s); }).eval();
  better.unstable = (better.circle_poles.cwiseAbs().array() > 1.0).count();
  better.moved = found->reflected;
  return std::optional<Model>(std::move(better));
}

}  // namespace bodeflow::subspace
