#include "identification.hpp"

#include <bodeflow/numerics/frequency_response.hpp>
#include <cmath>
#include <numbers>

namespace bodeflow::sanathanan_koerner {
namespace {

constexpr double kLostDigits = 1e-5;  // of the response, between state space and fit

/// Conjugate pairs together, those above the axis first; as they are where a conjugate is missing.
Eigen::VectorXcd paired(const Eigen::VectorXcd& poles) {
  const auto set = pole_set(poles);
  return set ? all_poles(*set) : poles;
}

/// Nothing where the state space gives the response that was fitted. A pole that has gone to infinity takes the digits with it.
Expected<void> check_realisation(const Data& data, const Identification& id) {
  const auto lines = numerics::hessenberg_response(id.system, data.omega_rad_s / (2.0 * std::numbers::pi));
  double squares = 0.0;
  for (Eigen::Index k = 0; k < data.lines(); ++k)
    squares += (lines[static_cast<std::size_t>(k)].col(0).transpose() - id.response.row(k)).squaredNorm();
  if (std::sqrt(squares) <= kLostDigits * id.response.norm()) return {};
  return unexpected("order " + std::to_string(id.order) +
                    ": a pole has gone to infinity and the state space does not hold the model; lower the order");
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

Expected<Reduction> fewer_states(const Data& data, const Settings& settings, Eigen::Index inputs, const Identification& id) {
  if (!settings.states.by_residues) return reduced_states(data, reshaped(id.system, inputs), id.response, settings.states);
  if (settings.sample_time_s > 0.0) return unexpected("states: gilbert is for models in s; take auto");
  const auto poles = pole_set(id.poles);
  if (!poles) return unexpected("states: " + poles.error().text);
  const auto model = fit_residues(data, *poles);
  if (!model) return unexpected("states: " + model.error().text);
  return gilbert_states(data, *model, id.response, inputs);
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
  if (auto good = check_realisation(data, id); !good) return unexpected(good.error().text);
  id.reflected = found->reflected;
  id.prewarp_rad_s = found->prewarp_rad_s;
  id.course = std::move(found->course);
  id.refinement = std::move(found->refinement);
  if (settings.states.reduce) {
    auto fewer = fewer_states(data, settings, inputs, id);
    if (!fewer) return unexpected(fewer.error().text);
    id.poles = paired(fewer->poles);
    id.response = fewer->response;
    id.no_covariance = "its states have been reduced; `states: all` has one";
    id.reduction = std::move(*fewer);
  }
  id.cost = weighted_residual(data, id.response).squaredNorm();
  for (Eigen::Index i = 0; i < data.channels(); ++i) id.equations += (data.weights_of(i).array() > 0.0).count();
  id.parameters = id.order + data.channels() * (id.order + 1);
  if (!id.reduction) add_uncertainty(data, settings, id);
  return id;
}

}  // namespace bodeflow::sanathanan_koerner
