#include "methods.hpp"

#include <bodeflow/numerics/frequency_response.hpp>
#include <numbers>

#include "sanathanan_koerner/method.hpp"
#include "subspace/identification.hpp"

namespace bench {
namespace {

using bodeflow::sanathanan_koerner::Data;

Method rational(const std::string& name, bodeflow::sanathanan_koerner::Method method, bool refine) {
  return {name, [=](const Data& data, Eigen::Index ports, Eigen::Index order) -> std::optional<Model> {
            bodeflow::sanathanan_koerner::Settings settings;
            settings.method = method;
            settings.refine = refine;
            auto found = bodeflow::sanathanan_koerner::fitted(data, settings, order, ports);
            if (!found) return {};
            return Model{std::move(found->system), std::move(found->poles)};
          }};
}

/// One start, and no more than two steps: what a single call of a peer does.
Method two_steps(const std::string& name) {
  return {name, [](const Data& data, Eigen::Index ports, Eigen::Index order) -> std::optional<Model> {
            bodeflow::sanathanan_koerner::Settings settings;
            settings.prewarp_rad_s = bodeflow::subspace::bandwidth_prewarp(data.omega_rad_s);
            settings.initial_poles = bodeflow::sanathanan_koerner::Spacing::logarithmic;
            settings.stop.iterations = 2;
            auto found = bodeflow::sanathanan_koerner::fitted(data, settings, order, ports);
            if (!found) return {};
            return Model{std::move(found->system), std::move(found->poles)};
          }};
}

Method subspace(const std::string& name, int polish) {
  return {name, [=](const Data& data, Eigen::Index ports, Eigen::Index order) -> std::optional<Model> {
            using namespace bodeflow::subspace;
            const Lines lines{data.omega_rad_s, data.response, ports, Eigen::VectorXd::Ones(data.lines())};
            Settings settings;
            settings.order = order * ports;
            settings.scan_prewarp = true;
            settings.polish = polish;
            auto found = identify(lines, Plane{bandwidth_prewarp(lines.omega_rad_s), 0.0}, settings);
            if (!found) return {};
            return Model{std::move(found->model.system), std::move(found->model.poles)};
          }};
}

}  // namespace

std::vector<Method> methods() {
  using bodeflow::sanathanan_koerner::Method;
  return {rational("sanathanan_koerner", Method::arnoldi, false),
          rational("sanathanan_koerner, refined", Method::arnoldi, true),
          two_steps("sanathanan_koerner, two steps"),
          rational("vector_fitting", Method::vector_fitting, false),
          rational("vector_fitting, refined", Method::vector_fitting, true),
          subspace("subspace", 5),
          subspace("subspace, not polished", 0)};
}

Eigen::MatrixXd errors(const Data& data, const bodeflow::numerics::StateSpace& system) {
  // A state space with one input has the entries as outputs; another one has them as a matrix.
  const auto lines = bodeflow::numerics::frequency_response(system, data.omega_rad_s / (2.0 * std::numbers::pi));
  Eigen::MatrixXd error(data.lines(), data.channels());
  for (Eigen::Index k = 0; k < data.lines(); ++k)
    error.row(k) = (lines[static_cast<std::size_t>(k)].reshaped().transpose() - data.response.row(k)).cwiseAbs();
  return error;
}

}  // namespace bench
