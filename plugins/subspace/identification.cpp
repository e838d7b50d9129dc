#include "identification.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "polish.hpp"

namespace bodeflow::subspace {
namespace {

constexpr Eigen::Index kUsualFunctions = 40;
constexpr Eigen::Index kFunctionsAboveOrder = 20;

Eigen::Index functions_for(const Lines& lines, const Settings& settings) {
  const Eigen::Index order = settings.order.value_or(settings.highest_order);
  return std::min(settings.functions.value_or(std::max(kUsualFunctions, order + kFunctionsAboveOrder)), most_functions(lines));
}

std::vector<Plane> planes_to_try(const Lines& lines, const Plane& plane, bool scan) {
  std::vector<Plane> planes{plane};
  if (!scan || plane.discrete()) return planes;
  const Eigen::VectorXd& w = lines.omega_rad_s;
  const double last = w[w.size() - 1], first = w[0] > 0.0 ? w[0] : w[std::min<Eigen::Index>(1, w.size() - 1)];
  for (const double a : {std::sqrt(first * last), w[w.size() / 2], last}) {
    Plane other = plane;
    other.prewarp_rad_s = a;
    if (a > 0.0) planes.push_back(other);
  }
  return planes;
}

/// The best model of that order over the planes.
Expected<void> best_of(const Lines& lines, const std::vector<Plane>& planes, Eigen::Index order, const Settings& settings,
                       Identification& id) {
  std::string reason;
  bool any = false;
  for (const Plane& plane : planes) {
    auto range = range_of(lines, plane, id.functions, settings.basis);
    if (!range) {
      reason = range.error().text;
      continue;
    }
    auto model = model_of_order(lines, plane, *range, order, settings.stability);
    if (!model) {
      reason = model.error().text;
      continue;
    }
    const Quality quality = quality_of(lines, model->response);
    if (any && !(quality.weighted < id.quality.weighted)) continue;
    any = true;
    id.plane = plane;
    id.model = std::move(*model);
    id.quality = quality;
    id.singular_values = std::move(range->singular_values);
  }
  if (!any) return unexpected(reason);
  return {};
}

}  // namespace

double bandwidth_prewarp(const Eigen::VectorXd& omega_rad_s) { return omega_rad_s[omega_rad_s.size() - 1] / std::numbers::pi; }

Expected<Identification> identify(const Lines& lines, const Plane& plane, const Settings& settings,
                                  const std::optional<Lines>& repeated) {
  if (auto fine = check(lines, plane); !fine) return unexpected(fine.error().text);
  if (repeated) {
    if (auto fine = check(*repeated, plane); !fine) return unexpected("the repeated measurement: " + fine.error().text);
    if (repeated->outputs != lines.outputs || repeated->response.cols() != lines.response.cols())
      return unexpected("the repeated measurement has other inputs or outputs");
  }
  Identification id;
  id.functions = functions_for(lines, settings);
  Eigen::Index order = settings.order.value_or(1);
  if (!settings.order) {
    auto scan = scan_orders(lines, plane, {id.functions, settings.basis, settings.stability, settings.highest_order}, repeated);
    if (!scan) return unexpected(scan.error().text);
    order = scan->chosen;
    id.scan = std::move(*scan);
  }
  if (auto found = best_of(lines, planes_to_try(lines, plane, settings.scan_prewarp), order, settings, id); !found)
    return unexpected(found.error().text);
  id.unpolished = id.quality;
  if (settings.polish == 0) return id;
  auto better = polished(lines, id.plane, id.model, settings.polish);
  if (!better || !*better) return id;  // the subspace model stands by itself
  id.model = std::move(**better);
  id.quality = quality_of(lines, id.model.response);
  id.polished = true;
  return id;
}

}  // namespace bodeflow::subspace
