#include "identification.hpp"

#include <cmath>

namespace bodeflow::sanathanan_koerner {
namespace {

/// Conjugate pairs together, those above the axis first; as they are where a conjugate is missing.
Eigen::VectorXcd paired(const Eigen::VectorXcd& poles) {
  const auto set = pole_set(poles);
  return set ? all_poles(*set) : poles;
}

void add_uncertainty(const Data& data, const Settings& settings, Identification& id) {
  if (settings.sample_time_s > 0.0) {
    id.no_covariance = "it is computed for models in s";
    return;
  }
  const double left = static_cast<double>(id.equations) - 0.5 * static_cast<double>(id.parameters);
  if (!(left > 0.0)) {
    id.no_covariance = "the model has as many parameters as the data have equations";
    return;
  }
  const auto set = pole_set(id.poles);
  if (!set) {
    id.no_covariance = set.error().text;
    return;
  }
  const auto model = fit_residues(data, *set);
  if (!model) {
    id.no_covariance = model.error().text;
    return;
  }
  auto sure = uncertainty(data, *model, settings.known_variance ? 1.0 : id.cost / left);
  if (!sure) {
    id.no_covariance = sure.error().text;
    return;
  }
  if (sure->covariance.size() > 0) id.fractions = parameters_of(*model);
  id.uncertainty = std::move(*sure);
}

}  // namespace

Expected<Identification> identify(const Data& data, const Settings& settings, Eigen::Index inputs,
                                  const std::optional<Data>& repeat) {
  if (auto good = check(data); !good) return unexpected(good.error().text);
  Identification id;
  if (settings.order) {
    id.order = *settings.order;
  } else {
    auto scan = scan_orders(data, settings, inputs, repeat);
    if (!scan) return unexpected(scan.error().text);
    id.order = scan->orders[scan->proposed].order;
    id.scan = std::move(*scan);
  }
  auto found = fitted(data, settings, id.order, inputs);
  if (!found) return unexpected(found.error().text);
  id.system = std::move(found->system);
  id.poles = paired(found->poles);
  id.response = std::move(found->response);
  id.reflected = found->reflected;
  id.prewarp_rad_s = found->prewarp_rad_s;
  id.course = std::move(found->course);
  id.refinement = std::move(found->refinement);
  id.cost = weighted_residual(data, id.response).squaredNorm();
  for (Eigen::Index i = 0; i < data.channels(); ++i) id.equations += (data.weights_of(i).array() > 0.0).count();
  id.parameters = id.order + data.channels() * (id.order + 1);
  add_uncertainty(data, settings, id);
  return id;
}

}  // namespace bodeflow::sanathanan_koerner
