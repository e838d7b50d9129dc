#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "../declared_base.hpp"
#include "bases/motor_standstill.hpp"
#include "catch.hpp"
#include "linear_effects.hpp"
#include "model/simulate.hpp"

using namespace bodeflow;
using namespace bodeflow::residual;

/// What effects of a motor at standstill change in its response beyond what its own parameters can change.
namespace {

using Complex = std::complex<double>;

constexpr Eigen::Index kLines = 60;
const Eigen::Vector4d kMotor(286.5, 11.6, 10.6, 0.041);

double frequency_hz(Eigen::Index k) { return 0.25 * std::pow(400.0, static_cast<double>(k) / (kLines - 1.0)); }

class Directions {
 public:
  Directions() {
    model_.base = declared_base<MotorStandstill>({{"input", std::string("terminal")}});
    own_.resize(2 * kLines, 4);
    for (Eigen::Index i = 0; i < 4; ++i) {
      const double step = 1e-5 * kMotor[i];
      Eigen::VectorXd up = kMotor, down = kMotor;
      up[i] += step, down[i] -= step;
      own_.col(i) = (relative(model_, up) - relative(model_, down)) / 2e-5;
    }
  }

  /// The change by an effect at the rotor, the four parameters of the motor projected out, of unit length.
  Eigen::VectorXd of(const testing::Linear& effect, const Eigen::VectorXd& values) const {
    JointModel with = model_;
    Addition a;
    a.what = effect.what;
    a.effect = effect.effect;
    const auto places = model_.base->places();
    for (std::size_t p = 0; p < places.size(); ++p)
      if (effect.what.acts == Acts::immittance && places[p].name == "rotor_winding") a.place = p;
    a.parameters = effect.effect->parameters({});
    with.additions = {a};
    Eigen::VectorXd all(4 + values.size());
    all << kMotor, values;
    const Eigen::VectorXd change = relative(with, all) - relative(model_, kMotor);
    const Eigen::VectorXd rest = change - own_ * own_.colPivHouseholderQr().solve(change);
    return rest.normalized();
  }

 private:
  static Eigen::VectorXd relative(const JointModel& model, const Eigen::VectorXd& values) {
    Eigen::VectorXd rows(2 * kLines);
    for (Eigen::Index k = 0; k < kLines; ++k) {
      const Complex s(0.0, 2.0 * std::numbers::pi * frequency_hz(k));
      JointModel base;
      base.base = model.base;
      const Complex g = joint_response(model, values, {}, s)[0] / joint_response(base, kMotor, {}, s)[0];
      rows.segment<2>(2 * k) << g.real(), g.imag();
    }
    return rows;
  }

  JointModel model_;
  Eigen::MatrixXd own_;
};

testing::Linear effect(const std::string& name) {
  for (const testing::Linear& e : testing::linear_effects())
    if (e.what.name() == name) return e;
  throw std::runtime_error(name);
}

}  // namespace

TEST_CASE(
    "delay and skin_effect: at standstill a small one of each moves the response the same way beyond the motor's parameters") {
  const Directions directions;
  const Eigen::VectorXd delay = directions.of(effect("delay"), Eigen::VectorXd::Constant(1, 1e-7));
  const Eigen::VectorXd skin = directions.of(effect("skin_effect"), Eigen::Vector2d(1e-10, 1e-5));
  const Eigen::VectorXd cage = directions.of(effect("second_cage"), Eigen::Vector2d(1e-10, 1e-6));
  CHECK(std::abs(delay.dot(skin)) == Approx(1.0).margin(1e-4));
  CHECK(std::abs(delay.dot(cage)) == Approx(1.0).margin(1e-4));
}

TEST_CASE("delay and skin_effect: bars far beyond their skin depth move it another way") {
  const Directions directions;
  const Eigen::VectorXd delay = directions.of(effect("delay"), Eigen::VectorXd::Constant(1, 1e-7));
  const double time = 0.05;
  const Eigen::VectorXd skin = directions.of(effect("skin_effect"), Eigen::Vector2d(1e-3 * time * time / 45.0, time));
  CHECK(std::abs(delay.dot(skin)) < 0.98);
}

TEST_CASE("iron_loss: a resistance beside the magnetising inductance, as the circuit says up to the leakage that it induces in") {
  const auto base = declared_base<MotorStandstill>({{"input", std::string("terminal")}});
  const double gamma = kMotor[0], alpha = kMotor[1], lm_beta = kMotor[2], sigma = kMotor[3];
  const double ls = sigma * (1.0 + lm_beta), lm = std::sqrt(ls * sigma * lm_beta), leakage = ls - lm;
  const double rs = sigma * (gamma - alpha * lm_beta), rr = alpha * ls, iron = 60.0;
  JointModel model;
  model.base = base;
  const testing::Linear loss = effect("iron_loss");
  Addition a;
  a.what = loss.what;
  a.effect = loss.effect;
  const auto places = base->places();
  for (std::size_t p = 0; p < places.size(); ++p)
    if (places[p].kind == "core") a.place = p;
  REQUIRE(a.place != Addition::kNoPlace);
  a.parameters = loss.effect->parameters({});
  model.additions = {a};
  Eigen::VectorXd values(5);
  values << kMotor, 1.0 / iron;
  // The base model leaves out what a change of the losses induces in the leakage: the resistance stands in series with -q.
  const double q = 1.0 / (2.0 / leakage + 1.0 / lm);
  for (const double f : {0.5, 7.0, 90.0}) {
    const Complex s(0.0, 2.0 * std::numbers::pi * f);
    const auto with_branch = [&](Complex branch) {
      return 1.0 / (rs + s * leakage + 1.0 / (1.0 / (s * lm) + 1.0 / branch + 1.0 / (rr + s * leakage)));
    };
    const Complex found = joint_response(model, values, {}, s)[0], whole = with_branch(iron), none = with_branch(1e12);
    CHECK(std::abs(found - with_branch(iron - s * q)) < 1e-9 * std::abs(found));
    CHECK(std::abs(found - whole) < 0.15 * std::abs(whole - none));
  }
}
