#include <bodeflow/numerics/levenberg_marquardt.hpp>
#include <cmath>
#include <numbers>

#include "all_effects.hpp"
#include "bases/second_order.hpp"
#include "catch.hpp"
#include "model/simulate.hpp"

using namespace bodeflow;
using namespace bodeflow::residual;

namespace {

constexpr double kSample = 5e-3;
const std::vector<double> kOscillator = {2.0, 5.0, 5000.0};

/// A base model with one effect, whose parameters are all fitted.
class Problem {
 public:
  Problem(const std::string& name, std::size_t place) {
    for (const auto& t : residual::testing::laws_maps_and_tones()) {
      if (t.what.name() == name) effect_ = t;
    }
    REQUIRE(effect_.effect);
    model_.base = std::make_shared<SecondOrder>();
    Situation s;
    s.place = model_.base->places()[place];
    s.duration_s = 2.0;
    input_.resize(400);
    for (Eigen::Index n = 0; n < input_.size(); ++n) {
      const double t = kSample * static_cast<double>(n), w = 2.0 * std::numbers::pi;
      input_[n] = 10.0 * (std::sin(w * 7.3 * t) + 0.7 * std::sin(w * 11.9 * t + 1.0) + 0.5 * std::sin(w * 2.1 * t));
    }
    const Simulated base = run({});
    s.place.flow = base.flow.col(static_cast<Eigen::Index>(place)).cwiseAbs().maxCoeff();
    s.place.stored = base.stored.col(static_cast<Eigen::Index>(place)).cwiseAbs().maxCoeff();
    s.place.effort = input_.cwiseAbs().maxCoeff();
    Addition a;
    a.what = effect_.what;
    a.effect = effect_.effect;
    a.place = place;
    a.situation = s;
    a.parameters = effect_.effect->parameters(s);
    model_.additions = {a};
  }

  /// The parameters of the effect, fitted jointly with the base's to the course that `truth` makes, from the best start.
  std::vector<double> found(const std::vector<double>& truth) const {
    const Eigen::VectorXd measured = run(truth).output;
    numerics::LeastSquaresFit best;
    best.cost = std::numeric_limits<double>::infinity();
    const auto parameters = model_.parameters();
    for (const std::vector<double>& start : effect_.effect->starts(model_.additions[0].situation)) {
      std::vector<double> all = kOscillator;
      for (double& v : all) v *= 1.1;
      all.insert(all.end(), start.begin(), start.end());
      Eigen::VectorXd at(static_cast<Eigen::Index>(all.size()));
      for (std::size_t i = 0; i < all.size(); ++i)
        at[static_cast<Eigen::Index>(i)] = parameters[i].logarithmic ? std::log(all[i]) : all[i] / parameters[i].scale;
      numerics::LeastSquaresProblem problem;
      problem.residuals = measured.size();
      problem.residual = [&](const Eigen::VectorXd& c, Eigen::VectorXd& r) {
        r = (simulate(model_, values(c), {}, drive()).value().output - measured) / measured.norm();
      };
      problem.jacobian = [&](const Eigen::VectorXd& c, Eigen::MatrixXd& j) {
        Eigen::VectorXd up, down;
        for (Eigen::Index i = 0; i < c.size(); ++i) {
          Eigen::VectorXd moved = c;
          moved[i] = c[i] + 1e-4, problem.residual(moved, up);
          moved[i] = c[i] - 1e-4, problem.residual(moved, down);
          j.col(i) = (up - down) / 2e-4;
        }
      };
      const auto fit = numerics::levenberg_marquardt(problem, at, {200, 1e-12});
      if (fit && fit->cost < best.cost) best = *fit;
    }
    const Eigen::VectorXd v = values(best.parameters);
    return {v.data() + kOscillator.size(), v.data() + v.size()};
  }

 private:
  Drive drive() const {
    Drive d;
    d.input = input_;
    d.sample_time_s = kSample;
    return d;
  }
  Simulated run(const std::vector<double>& effect) const {
    std::vector<double> all = kOscillator;
    all.insert(all.end(), effect.begin(), effect.end());
    return simulate(model_, Eigen::Map<const Eigen::VectorXd>(all.data(), static_cast<Eigen::Index>(all.size())), {}, drive())
        .value();
  }
  Eigen::VectorXd values(const Eigen::VectorXd& c) const {
    Eigen::VectorXd v = c;
    const auto parameters = model_.parameters();
    for (Eigen::Index i = 0; i < c.size(); ++i) {
      const FitParameter& p = parameters[static_cast<std::size_t>(i)];
      v[i] = p.logarithmic ? std::exp(c[i]) : c[i] * p.scale;
    }
    return v;
  }

  residual::testing::Tried effect_;
  JointModel model_;
  Eigen::VectorXd input_;
};

void recovers(const std::string& name, std::size_t place, const std::vector<double>& truth) {
  INFO(name);
  const std::vector<double> found = Problem(name, place).found(truth);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    INFO("parameter " << i);
    CHECK(found[i] == Approx(truth[i]).epsilon(1e-2));
  }
}

constexpr std::size_t kBearing = 0, kSpring = 1;

}  // namespace

TEST_CASE("starts: a fit from them finds springs and dampings again in data without noise") {
  recovers("cubic_stiffness", kSpring, {8e7});
  recovers("cubic_stiffness", kSpring, {-8e6});
  recovers("quadratic_stiffness", kSpring, {1e5});
  recovers("quadratic_damping", kBearing, {20.0});
  recovers("cubic_damping", kBearing, {80.0});
  recovers("stop", kSpring, {2e-3, 2500.0});
}

TEST_CASE("starts: a fit from them finds dry friction again in data without noise") {
  recovers("coulomb_friction", kBearing, {0.5});
  recovers("coulomb_friction", kBearing, {6.0});
  recovers("asymmetric_friction", kBearing, {2.0, 3.0});
  recovers("stribeck_friction", kBearing, {2.0, 0.5, 0.05});
}

TEST_CASE("starts: a fit from them finds friction and hysteresis with a memory again in data without noise") {
  recovers("dahl_friction", kBearing, {3.0, 6000.0});
  recovers("bouc_wen", kSpring, {2000.0, 1e-3, 0.5});
}

TEST_CASE("starts: a fit from them finds what changes with time again in data without noise") {
  recovers("stiffness_drift", kSpring, {200.0});
  recovers("stiffness_step", kSpring, {300.0, 0.8123});
  recovers("damping_step", kBearing, {3.0, 1.234});
}
