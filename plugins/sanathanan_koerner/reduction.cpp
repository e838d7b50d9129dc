#include "reduction.hpp"

#include <Eigen/Eigenvalues>
#include <bodeflow/numerics/balanced_truncation.hpp>
#include <bodeflow/numerics/frequency_response.hpp>
#include <bodeflow/numerics/pole_residue.hpp>
#include <cmath>
#include <numbers>

namespace bodeflow::sanathanan_koerner {
namespace {

constexpr double kRounding = 1e-12;  // of the largest Hankel singular value; states below hold rounding, however good the fit
constexpr double kResidueRounding = 1e-9;  // of the response: what residues may lose of it by rounding
constexpr double kShare = 0.5;  // of the fit's error that an open number of states may change the response by: 12 % more error

double rms(const Eigen::MatrixXcd& error) { return error.norm() / std::sqrt(static_cast<double>(error.size())); }

Eigen::MatrixXcd response_of(const numerics::StateSpace& system, const Data& data) {
  const auto lines = numerics::hessenberg_response(system, data.omega_rad_s / (2.0 * std::numbers::pi));
  Eigen::MatrixXcd response(data.lines(), data.channels());
  for (Eigen::Index k = 0; k < data.lines(); ++k) response.row(k) = lines[static_cast<std::size_t>(k)].reshaped().transpose();
  return response;
}

/// Of the weighted response: what fewer states may change.
double change_limit(const Data& data, const Eigen::MatrixXcd& response, double least) {
  return std::max(kShare * weighted_residual(data, response).norm(), least * weighted_norm(data));
}

/// How a reduced model with its response differs from the fit's response, and from the data.
void judge(const Data& data, const Eigen::MatrixXcd& response, Reduction& r) {
  r.rms_change = rms(r.response - response);
  r.relative_error = weighted_residual(data, r.response).norm() / weighted_norm(data);
}

numerics::PoleResidue pole_residue(const PartialFractions& m, Eigen::Index inputs) {
  const Eigen::Index outputs = m.channels() / inputs, M = m.poles.order();
  const auto pairs = static_cast<Eigen::Index>(m.poles.pairs.size());
  numerics::PoleResidue p;
  p.poles.resize(M - pairs);
  for (Eigen::Index n = 0; n < p.poles.size(); ++n) {
    const bool pair = n < pairs;
    const Eigen::Index row = pair ? 2 * n : pairs + n;
    Eigen::VectorXcd residue = m.coefficients.row(row).transpose().cast<std::complex<double>>();
    if (pair) residue.imag() = m.coefficients.row(row + 1).transpose();
    p.poles[n] = pair ? m.poles.pairs[static_cast<std::size_t>(n)] : m.poles.real[static_cast<std::size_t>(n - pairs)];
    p.residues.emplace_back(residue.reshaped(outputs, inputs));
  }
  p.D = m.coefficients.row(M).transpose().reshaped(outputs, inputs);
  return p;
}

/// The truncation of a balanced system.
numerics::StateSpace first_states(const numerics::StateSpace& balanced, Eigen::Index count) {
  return {balanced.A.topLeftCorner(count, count), balanced.B.topRows(count), balanced.C.leftCols(count), balanced.D,
          balanced.sample_time};
}

/// The fewest states that change the response by no more than kShare of the fit's error, by bisection.
Eigen::Index fewest_states(const Data& data, const numerics::StateSpace& balanced, const Eigen::MatrixXcd& response) {
  const Data model{data.omega_rad_s, response, data.weights};
  const double limit = change_limit(data, response, kRounding);
  Eigen::Index low = -1, high = balanced.states();
  while (high - low > 1) {
    const Eigen::Index middle = low + (high - low) / 2;
    const double change = weighted_residual(model, response_of(first_states(balanced, middle), data)).norm();
    (change <= limit ? high : low) = middle;
  }
  return high;
}

}  // namespace

double Reduction::gap() const {
  const Eigen::Index kept = system.states();
  if (kept == 0 || kept >= hankel_singular_values.size()) return INFINITY;
  return hankel_singular_values[kept - 1] / hankel_singular_values[kept];
}

Expected<Reduction> reduced_states(const Data& data, const numerics::StateSpace& full, const Eigen::MatrixXcd& response,
                                   const States& states) {
  Eigen::Index count = states.count.value_or(0);
  if (!states.count) {
    const auto hankel = numerics::hankel_singular_values(full);
    if (!hankel) return unexpected("states: " + hankel.error().text);
    if (hankel->size() > 0) count = (hankel->array() > kRounding * (*hankel)[0]).count();
  }
  auto smaller = numerics::balanced_truncation(full, count);
  if (!smaller) return unexpected("states: " + smaller.error().text);
  Reduction r;
  r.states_before = full.states();
  r.system = std::move(smaller->system);
  r.hankel_singular_values = std::move(smaller->hankel_singular_values);
  if (!states.count) r.system = first_states(r.system, fewest_states(data, r.system, response));
  r.error_bound = 2.0 * r.hankel_singular_values.tail(r.hankel_singular_values.size() - r.system.states()).sum();
  if (r.system.states() > 0) r.poles = r.system.A.eigenvalues();
  r.response = response_of(r.system, data);
  judge(data, response, r);
  return r;
}

Expected<Reduction> gilbert_states(const Data& data, const PartialFractions& model, const Eigen::MatrixXcd& response,
                                   Eigen::Index inputs) {
  const numerics::PoleResidue residues = pole_residue(model, inputs);
  const Data fitted{data.omega_rad_s, response, data.weights};
  Reduction r;
  r.states_before = model.poles.order() * std::min(inputs, data.channels() / inputs);
  r.poles = all_poles(model.poles);
  const double limit = change_limit(data, response, kResidueRounding);
  for (double tolerance = 0.1; tolerance > kRounding; tolerance *= 0.1) {
    auto system = numerics::gilbert_realisation(residues, tolerance);
    if (!system) return unexpected("states: " + system.error().text);
    r.system = std::move(*system);
    r.response = response_of(r.system, data);
    if (weighted_residual(fitted, r.response).norm() > limit) continue;
    judge(data, response, r);
    return r;
  }
  return unexpected("states: gilbert: the residues by least squares do not give the response of the fit");
}

}  // namespace bodeflow::sanathanan_koerner
