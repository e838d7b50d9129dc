#include "method.hpp"

#include <bodeflow/numerics/frequency_response.hpp>
#include <cmath>

#include "monomial.hpp"
#include "refinement.hpp"

namespace bodeflow::sanathanan_koerner {
namespace {

FitSettings fit_settings(const Settings& s, Eigen::Index order) { return {order, s.weight_exponent, s.stable, s.stop}; }

Expected<Fit> monomial_scan(const Data& data, const FitSettings& settings) {
  Expected<Fit> best = unexpected("no pre-warp frequency");
  for (const double a : prewarp_candidates(data.omega_rad_s)) {
    auto one = monomial_fit(data, Plane{a, 0.0}, settings);
    if (!best || (one && one->error() < best->error())) best = std::move(one);
  }
  return best;
}

Expected<Fit> polynomial_fit(const Data& data, const Settings& s, Eigen::Index order) {
  const FitSettings settings = fit_settings(s, order);
  const bool scanned = s.sample_time_s == 0.0 && !s.prewarp_rad_s;
  if (auto good = check(data); !good) return unexpected(good.error().text);
  if (s.method == Method::monomial && scanned) return monomial_scan(data, settings);
  const Plane plane{s.prewarp_rad_s.value_or(1.0), s.sample_time_s};
  if (s.method == Method::monomial) return monomial_fit(data, plane, settings);
  return scanned ? fit_with_scan(data, settings) : fit(data, plane, settings);
}

/// The column with the largest weighted responses, of `inputs` columns.
Data strongest_column(const Data& data, Eigen::Index inputs) {
  const Eigen::Index outputs = data.channels() / inputs;
  const Eigen::MatrixXcd weighted = weighted_residual(data, Eigen::MatrixXcd::Zero(data.lines(), data.channels()));
  Eigen::Index column = 0;
  for (Eigen::Index j = 1; j < inputs; ++j) {
    if (weighted.middleCols(j * outputs, outputs).norm() > weighted.middleCols(column * outputs, outputs).norm()) column = j;
  }
  Data one{data.omega_rad_s, data.response.middleCols(column * outputs, outputs), data.weights};
  if (!data.common_weights()) one.weights = data.weights.middleCols(column * outputs, outputs);
  return one;
}

Expected<Fitted> finished(const Data& data, Expected<Fit> f, const Settings& s, std::optional<double> prewarp) {
  if (!f) return unexpected(f.error().text);
  Fitted result;
  result.course = f->course;
  result.reflected = f->reflected;
  if (s.refine) {
    auto better = refined(data, *f, {s.stable});
    if (!better) return unexpected("refinement: " + better.error().text);
    result.refinement = better->course;
    f = std::move(better);
  }
  auto system = state_space(f->model);
  if (!system) return unexpected(system.error().text);
  result.system = std::move(*system);
  result.poles = f->poles;
  result.response = f->response;
  result.prewarp_rad_s = prewarp;
  return result;
}

Expected<Fitted> by_vector_fitting(const Data& data, const Settings& s, Eigen::Index order, Eigen::Index inputs) {
  if (s.sample_time_s > 0.0) return unexpected("vector fitting gives models in s; for one in z take sanathanan_koerner.model");
  const VectorFittingSettings settings{order, s.initial_poles, s.stable, s.stop};
  const bool split = s.columns == Columns::by_column && inputs > 1;
  auto found = vector_fit(split ? strongest_column(data, inputs) : data, settings);
  if (!found) return unexpected(found.error().text);
  Fitted result;
  result.course = found->course;
  result.reflected = found->mirrored;
  PartialFractions model = found->model;
  if (split) {
    auto all = fit_residues(data, model.poles);
    if (!all) return unexpected(all.error().text);
    model = std::move(*all);
    result.course.errors[static_cast<std::size_t>(result.course.best)] =
        weighted_residual(data, response(model, data.omega_rad_s)).norm() / weighted_norm(data);
  }
  if (s.refine && order > 0) {
    const Eigen::VectorXcd poles = all_poles(model.poles);
    const Eigen::VectorXd candidates = prewarp_candidates(data.omega_rad_s);
    const Plane plane{candidates[candidates.size() / 2], 0.0};
    auto start = with_denominator(data, plane, denominator_of(poles, plane, data.omega_rad_s), order);
    if (!start) return unexpected("refinement: " + start.error().text);
    const Course course = result.course;
    auto better = finished(data, std::move(start), s, {});
    if (better) better->course = course;
    return better;
  }
  result.system = state_space(model);
  result.poles = all_poles(model.poles);
  result.response = response(model, data.omega_rad_s);
  return result;
}

}  // namespace

Expected<Fitted> fitted(const Data& data, const Settings& s, Eigen::Index order, Eigen::Index inputs) {
  if (s.method == Method::vector_fitting) return by_vector_fitting(data, s, order, inputs);
  const bool split = s.columns == Columns::by_column && inputs > 1;
  auto f = polynomial_fit(split ? strongest_column(data, inputs) : data, s, order);
  if (f && split) {
    const Course course = f->course;
    const Eigen::Index reflected = f->reflected;
    f = with_denominator(data, f->model.plane, f->denominator, order);
    if (f) {
      const double error = f->error();
      f->course = course;
      f->course.errors[static_cast<std::size_t>(course.best)] = error;
      f->reflected = reflected;
    }
  }
  const auto prewarp = f && s.sample_time_s == 0.0 ? std::optional(f->model.plane.prewarp_rad_s) : std::nullopt;
  return finished(data, std::move(f), s, prewarp);
}

}  // namespace bodeflow::sanathanan_koerner
