#include "polish.hpp"

#include <Eigen/Eigenvalues>
#include <bodeflow/numerics/balanced_truncation.hpp>
#include <complex>

#include "quality.hpp"
#include "sanathanan_koerner/fit.hpp"

namespace bodeflow::subspace {
namespace {

using Complex = std::complex<double>;

}  // namespace

Expected<std::optional<Model>> polished(const Lines& lines, const Plane& plane, const Model& model, int iterations) {
  using namespace sanathanan_koerner;
  const Data data{lines.omega_rad_s, lines.response, lines.weight};
  FitSettings settings;
  settings.order = model.order();
  settings.stop.iterations = iterations;
  const auto found = fit(data, plane, settings, denominator_of(model.poles, plane, lines.omega_rad_s));
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
