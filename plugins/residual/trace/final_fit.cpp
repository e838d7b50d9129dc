#include "trace/final_fit.hpp"

#include <Eigen/Dense>

#include "trace/profile.hpp"

namespace bodeflow::residual {
namespace {

// Inputs and parameters in turn until no parameter moves by more than this part of its deviation.
constexpr int kMostTurns = 12;
constexpr double kStill = 0.1;
constexpr std::uint64_t kPairs = 16;

bool bends(const JointModel& model) {
  return model.base->has_laws() || model.has(Acts::law) || model.has(Acts::output) || model.has(Acts::input);
}

/// The records with what `other` makes of them; those of which it makes nothing as they are.
template <class Other>
Measurements replaced(const Measurements& records, const Other& other) {
  Measurements all;
  for (std::size_t r = 0; r < records.size(); ++r) {
    auto some = other(r);
    all.push_back(some ? some : records[r]);
  }
  return all;
}

Measurements likely(const Measurements& records, const Fit& f) {
  return replaced(records, [&](std::size_t r) { return records[r]->with_likely_input(f.model, f.values(r)); });
}

Measurements noisy(const Measurements& records, std::uint64_t draw, double sign) {
  return replaced(records, [&](std::size_t r) { return records[r]->with_input_noise(draw * records.size() + r, sign); });
}

/// What the noise of the inputs scatters the coordinates.
Eigen::MatrixXd scatter_of(const Fit& f, const Measurements& records, const Eigen::MatrixXd& normal) {
  const auto step = [&](std::uint64_t draw, double sign) {
    const Measurements with = noisy(records, draw, sign);
    return Eigen::VectorXd(normal * (f.jacobian.transpose() * FitProblem(f.model, with).residual(f.at)));
  };
  Eigen::MatrixXd scatter = Eigen::MatrixXd::Zero(f.at.size(), f.at.size());
  double pairs = 0.0;
  for (std::uint64_t draw = 0; draw < kPairs; ++draw) {
    const Eigen::VectorXd half = 0.5 * (step(draw, 1.0) - step(draw, -1.0));
    if (!half.allFinite()) continue;
    scatter += half * half.transpose();
    ++pairs;
  }
  return pairs > 0.0 ? Eigen::MatrixXd(scatter / pairs) : scatter;
}

}  // namespace

Fit final_fit(const Fit& fit, const Measurements& records) {
  Fit f = fit;
  Measurements with = bends(fit.model) ? likely(records, fit) : records;
  const bool noisy_inputs = with != records;
  bool still = !noisy_inputs;
  for (int turn = 0; turn < kMostTurns && !still; ++turn) {
    if (turn > 0) with = likely(records, f);
    FitProblem problem(f.model, with);
    problem.bound_base(f.at);
    auto polished = polish(problem, f.at);
    if (!polished) return fit;
    const Eigen::VectorXd std = polished->covariance.diagonal().cwiseSqrt();
    still = ((polished->at - f.at).cwiseAbs().array() <= kStill * std.array()).all();
    f = std::move(*polished);
  }
  widen_by_profiles(FitProblem(f.model, with), f);
  if (!noisy_inputs) return f;
  const Eigen::MatrixXd normal = pseudo_inverse_normal(f.jacobian);
  f.covariance = normal + scatter_of(f, with, normal);
  const FitProblem problem(f.model, records);
  f.residual = problem.residual(f.at);
  if (!f.residual.allFinite()) return fit;
  f.jacobian = problem.jacobian(f.at, f.residual);
  f.chi2 = f.residual.squaredNorm();
  return f;
}

}  // namespace bodeflow::residual
