#include "sampled/initial_state.hpp"

#include <Eigen/Dense>
#include <cmath>

namespace bodeflow::residual {
namespace {

constexpr int kSteps = 12, kHalvings = 5;
// Of the errors' norm: a step that promises less ends the search. Far below what the differences of a fit resolve.
constexpr double kSettled = 1e-10;
constexpr double kWeak = 1e-8;        // of the strongest direction: not shown by the output
constexpr double kDifference = 1e-5;  // of the output's size

class Search {
 public:
  Search(const Prediction& prediction, const Stretch& stretch, const Eigen::VectorXd& measured)
      : prediction_(prediction), stretch_(stretch), measured_(measured), slopes_(prediction.free_response(stretch.count)) {
    unit_ = slopes_.colwise().norm().transpose();
    // One unit of a state moves the output by its own size, as far as the linear part tells.
    const double size = std::max(measured.norm(), 1e-300), usual = size / std::sqrt(static_cast<double>(stretch.count));
    for (double& u : unit_) u = u > 0.0 ? size / u : usual;
  }

  Expected<Eigen::VectorXd> run() {
    auto error = error_at(Eigen::VectorXd::Zero(unit_.size()));
    if (!error) return tl::unexpected(error.error());
    state_ = Eigen::VectorXd::Zero(unit_.size());
    error_ = std::move(*error);
    for (int step = 0; step < kSteps; ++step) {
      if (step > 0 && !differentiate()) break;
      const auto moved = take_step();
      if (!moved) return tl::unexpected(moved.error());
      if (prediction_.linear() || (!*moved && step > 0)) break;
    }
    return state_;
  }

 private:
  Expected<Eigen::VectorXd> error_at(const Eigen::VectorXd& state) const {
    auto predicted = prediction_.run(stretch_, state);
    if (!predicted) return tl::unexpected(predicted.error());
    return Eigen::VectorXd(measured_ - predicted->output);
  }

  bool differentiate() {
    for (Eigen::Index i = 0; i < unit_.size(); ++i) {
      Eigen::VectorXd moved = state_;
      const double step = kDifference * unit_[i];
      moved[i] += step;
      const auto error = error_at(moved);
      if (!error || !error->allFinite()) return false;
      slopes_.col(i) = (error_ - *error) / step;
    }
    return true;
  }

  /// False once nothing more is gained.
  Expected<bool> take_step() {
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
    solver.setThreshold(kWeak);
    solver.compute(slopes_ * unit_.asDiagonal());
    Eigen::VectorXd step = unit_.asDiagonal() * solver.solve(error_);
    if ((slopes_ * step).norm() <= kSettled * measured_.norm()) return false;
    for (int halving = 0; halving <= kHalvings; ++halving, step *= 0.5) {
      const Eigen::VectorXd next = state_ + step;
      auto error = error_at(next);
      if (!error) return tl::unexpected(error.error());
      if (!(error->squaredNorm() < error_.squaredNorm())) continue;
      const bool gained = error->norm() < (1.0 - kSettled) * error_.norm();
      state_ = next;
      error_ = std::move(*error);
      return gained;
    }
    return false;
  }

  const Prediction& prediction_;
  const Stretch& stretch_;
  const Eigen::VectorXd& measured_;
  Eigen::MatrixXd slopes_;
  Eigen::VectorXd unit_, state_, error_;
};

}  // namespace

Expected<Eigen::VectorXd> initial_state(const Prediction& prediction, const Stretch& stretch, const Eigen::VectorXd& measured) {
  if (prediction.states() == 0) return Eigen::VectorXd();
  return Search(prediction, stretch, measured).run();
}

}  // namespace bodeflow::residual
