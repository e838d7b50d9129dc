#include "sampled/initial_state.hpp"

#include <Eigen/Dense>
#include <cmath>

namespace bodeflow::residual {
namespace {

constexpr int kSteps = 20, kStepsBetween = 2, kHalvings = 5;
constexpr Eigen::Index kFirst = 25;  // samples a state
// Of the squared error: a step that promises less is the last, as what it leaves is far below that.
constexpr double kSettled = 1e-8;
constexpr double kWeak = 1e-8;  // of the strongest direction: not shown by the output
// Differences for derivatives, of the output's size: coarse ones look past the kinks of friction, finer ones follow once a step
// gains little.
constexpr double kCoarse = 3e-2, kFinest = 1e-5, kFiner = 0.1, kLittle = 0.9;

class Search {
 public:
  Search(const Prediction& prediction, const Stretch& stretch, const Eigen::VectorXd& measured)
      : prediction_(prediction), stretch_(stretch), measured_(measured), weight_(prediction.certainty(stretch)) {}

  /// From that state, or (empty) from the answer of the base model to it.
  Expected<Eigen::VectorXd> run(const Eigen::VectorXd& start, int steps) {
    slopes_ = prediction_.free_response(stretch_.count);
    slopes_ = weight_.asDiagonal() * slopes_;
    unit_ = slopes_.colwise().norm().transpose();
    // One unit of a state moves the output by its own size, as far as the linear part tells.
    const double size = std::max(measured_.norm(), 1e-300), usual = size / std::sqrt(static_cast<double>(stretch_.count));
    for (double& u : unit_) u = u > 0.0 ? size / u : usual;
    difference_ = prediction_.rough() ? kCoarse : kFinest;
    state_ = start.size() > 0 ? start : Eigen::VectorXd::Zero(unit_.size());
    auto error = error_at(state_);
    if (!error) return tl::unexpected(error.error());
    error_ = std::move(*error);
    for (int step = 0; step < steps; ++step) {
      const bool known = step == 0 && start.size() == 0 && !prediction_.filters_state();
      if (!known && !differentiate()) break;
      const double before = error_.squaredNorm();
      if (auto tried = take_step(); !tried) return tl::unexpected(tried.error());
      const double after = error_.squaredNorm();
      const bool finest = difference_ <= kFinest;
      if (prediction_.linear() || (finest && (promised_ <= kSettled * before || !(after < before)))) break;
      if (!finest && after > kLittle * before) difference_ = std::max(difference_ * kFiner, kFinest);
    }
    return state_;
  }

 private:
  Expected<Eigen::VectorXd> error_at(const Eigen::VectorXd& state) const {
    auto predicted = prediction_.run(stretch_, state);
    if (!predicted) return tl::unexpected(predicted.error());
    return Eigen::VectorXd(weight_.cwiseProduct(measured_ - predicted->output));
  }

  bool differentiate() {
    for (Eigen::Index i = 0; i < unit_.size(); ++i) {
      Eigen::VectorXd moved = state_;
      const double step = difference_ * unit_[i];
      moved[i] += step;
      const auto error = error_at(moved);
      if (!error || !error->allFinite()) return false;
      slopes_.col(i) = (error_ - *error) / step;
    }
    return true;
  }

  Expected<void> take_step() {
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
    solver.setThreshold(kWeak);
    solver.compute(slopes_ * unit_.asDiagonal());
    Eigen::VectorXd step = unit_.asDiagonal() * solver.solve(error_);
    promised_ = (slopes_ * step).squaredNorm();
    for (int halving = 0; halving <= kHalvings; ++halving, step *= 0.5) {
      const Eigen::VectorXd next = state_ + step;
      auto error = error_at(next);
      if (!error) return tl::unexpected(error.error());
      if (!(error->squaredNorm() < error_.squaredNorm())) continue;
      state_ = next;
      error_ = std::move(*error);
      break;
    }
    return {};
  }

  const Prediction& prediction_;
  const Stretch stretch_;
  const Eigen::VectorXd measured_, weight_;
  Eigen::MatrixXd slopes_;
  Eigen::VectorXd unit_, state_, error_;
  double difference_ = kCoarse;  ///< of the differences that stand for derivatives, in units
  double promised_ = 0.0;        ///< fall of the squared error by the last step, as the slopes tell
};

}  // namespace

Expected<Eigen::VectorXd> initial_state(const Prediction& prediction, const Stretch& stretch, const Eigen::VectorXd& measured) {
  if (prediction.states() == 0) return Eigen::VectorXd();
  const auto part = [&](Eigen::Index count, const Eigen::VectorXd& start, int steps) {
    return Search(prediction, {stretch.first, count}, measured.head(count)).run(start, steps);
  };
  if (prediction.linear()) return part(stretch.count, Eigen::VectorXd(), 1);
  Eigen::VectorXd state;
  for (Eigen::Index count = std::min(kFirst * prediction.states(), stretch.count); count < stretch.count; count *= 2) {
    auto better = part(count, state, kStepsBetween);
    if (!better) return better;
    state = std::move(*better);
  }
  return part(stretch.count, state, kSteps);
}

}  // namespace bodeflow::residual
