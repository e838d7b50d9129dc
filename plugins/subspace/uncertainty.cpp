#include "uncertainty.hpp"

#include "sanathanan_koerner/vector_fitting.hpp"

namespace bodeflow::subspace {

Expected<ModelUncertainty> uncertainty_of(const Lines& lines, const Model& model, bool known_variance) {
  if (model.system.sample_time > 0.0) return unexpected("it is computed for models in s");
  const sanathanan_koerner::Data data{lines.omega_rad_s, lines.response, lines.weight};
  const auto n = static_cast<double>(model.order()), entries = static_cast<double>(data.channels());
  const double left = static_cast<double>(data.lines()) * entries - 0.5 * (n + entries * (n + 1.0));
  if (!(left > 0.0)) return unexpected("partial fractions of its poles have as many parameters as the data have equations");
  const auto poles = sanathanan_koerner::pole_set(model.poles);
  if (!poles) return unexpected(poles.error().text);
  const auto fractions = sanathanan_koerner::fit_residues(data, *poles);
  if (!fractions) return unexpected(fractions.error().text);
  const double cost = weighted_residual(data, model.response).squaredNorm();
  auto found = sanathanan_koerner::uncertainty(data, *fractions, known_variance ? 1.0 : cost / left);
  if (!found) return unexpected(found.error().text);
  ModelUncertainty u{all_poles(*poles), std::move(*found), {}};
  if (u.of.covariance.size() > 0) u.parameters = sanathanan_koerner::parameters_of(*fractions);
  return u;
}

}  // namespace bodeflow::subspace
