#include "trace/profile.hpp"

#include <algorithm>
#include <cmath>

namespace bodeflow::residual {
namespace {

constexpr double kHalfWidth = 1.96;
constexpr double kFall = kHalfWidth * kHalfWidth;
// Points on either side, in deviations: each is so many times as far as the one before.
constexpr double kFarther = 1.4;
constexpr int kPoints = 8;
constexpr int kSteps = 2;
// The likelihood of a tone is looked at in such steps up to so many deviations away.
constexpr double kToneStep = 0.5, kFarthestTone = 6.0;

class Profile {
 public:
  Profile(const FitProblem& problem, const Fit& fit, Eigen::Index i)
      : problem_(problem), fit_(fit), i_(i), std_(std::sqrt(fit.covariance(i, i))) {}

  /// Where the fall of twice the log likelihood reaches that of an interval of 95 %, in deviations from the optimum to that side.
  double reach(double side) const {
    double before = 0.0, fall_before = 0.0;
    for (int n = 0; n < kPoints; ++n) {
      const double t = kHalfWidth * std::pow(kFarther, n), fall = fall_at(side * t);
      if (!std::isfinite(fall)) return std::max(before, kHalfWidth);
      if (fall >= kFall) {
        const double a = std::sqrt(std::max(fall_before, 0.0)), b = std::sqrt(fall);
        return std::max(before + (t - before) * (kHalfWidth - a) / (b - a), kHalfWidth);
      }
      before = t;
      fall_before = fall;
    }
    return before;
  }

  /// The same of a tone: the farthest peak that reaches so high.
  double reach_of_tone() const {
    double farthest = kHalfWidth;
    for (const double side : {-1.0, 1.0}) {
      for (double t = kToneStep; t <= kFarthestTone; t += kToneStep) {
        Eigen::VectorXd at = fit_.at;
        at[i_] += side * t * std_;
        if (problem_.residual(at).squaredNorm() - fit_.chi2 < kFall) farthest = std::max(farthest, t);
      }
    }
    return farthest;
  }

  /// How many times as wide as by 1.96 deviations an interval is that ends `t` deviations from the optimum.
  double widened(double t) const {
    if (!fit_.layout.is_logarithmic(i_)) return std::abs(t) / kHalfWidth;
    return std::abs(std::expm1(t * std_)) / (kHalfWidth * std_);
  }

 private:
  /// With the other coordinates where they are best, t deviations from the optimum.
  double fall_at(double t) const {
    Eigen::VectorXd at = fit_.at + t / std_ * fit_.covariance.col(i_);
    Eigen::VectorXd residual = problem_.residual(at);
    double cost = residual.squaredNorm();
    for (int n = 0; n < kSteps && std::isfinite(cost) && cost - fit_.chi2 >= kFall; ++n) {
      Eigen::MatrixXd jacobian = problem_.jacobian(at, residual);
      jacobian.col(i_).setZero();
      const Eigen::VectorXd next = at - pseudo_inverse_normal(jacobian) * (jacobian.transpose() * residual);
      residual = problem_.residual(next);
      if (!(residual.squaredNorm() < cost)) break;
      at = next;
      cost = residual.squaredNorm();
    }
    return cost - fit_.chi2;
  }

  const FitProblem& problem_;
  const Fit& fit_;
  Eigen::Index i_;
  double std_;
};

}  // namespace

void widen_by_profiles(const FitProblem& problem, Fit& f) {
  const JointModel& model = f.model;
  for (std::size_t a = 0; a < model.additions.size(); ++a) {
    for (std::size_t p = 0; p < model.additions[a].parameters.size(); ++p) {
      if (model.additions[a].parameters[p].each_record) continue;
      const Eigen::Index i = f.layout.index(static_cast<std::size_t>(model.begin_of(a)) + p, 0);
      if (!(f.covariance(i, i) > 0.0)) continue;
      const Profile profile(problem, f, i);
      const bool tone = model.additions[a].what.acts == Acts::tone;
      const double below = tone ? profile.reach_of_tone() : profile.reach(-1.0), above = tone ? below : profile.reach(1.0);
      f.widening[i] = std::max({f.widening[i], profile.widened(-below), profile.widened(above)});
    }
  }
}

}  // namespace bodeflow::residual
