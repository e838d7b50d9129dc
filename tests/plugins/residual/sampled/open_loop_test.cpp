#include <cmath>
#include <memory>

#include "bases/second_order.hpp"
#include "catch.hpp"
#include "effects/coulomb_friction.hpp"
#include "effects/cubic_stiffness.hpp"
#include "effects/delay.hpp"
#include "plugins/residual/declared_base.hpp"
#include "plugins/residual/sampled/records.hpp"
#include "sampled/sampled_measurement.hpp"

using namespace bodeflow;
using namespace bodeflow::residual;
using namespace bodeflow::residual::testing;

namespace {

constexpr double kRate = 200.0, kStiffness = 800.0;
const Eigen::Vector3d kPlant(0.2, 1.2, kStiffness);

/// That oscillator with a law's force besides, by Runge-Kutta.
Eigen::VectorXd oscillator(const Eigen::VectorXd& force, const std::function<double(double x, double v)>& law) {
  const auto f = [&law](const Eigen::VectorXd& x, double u) {
    return Eigen::VectorXd(Eigen::Vector2d(x[1], (u - kPlant[1] * x[1] - kStiffness * x[0] - law(x[0], x[1])) / kPlant[0]));
  };
  return integrated(f, Eigen::Vector2d(0.01, -0.5), force, 1.0 / kRate, 20).col(0);
}

struct Bench {
  std::shared_ptr<const SecondOrder> base = declared_base<SecondOrder>({{"hold", std::string("zero_order")}});
  std::shared_ptr<const Measurement> record;
  JointModel plain{base, {}};

  Bench(const std::function<double(double, double)>& law, Eigen::Index samples) {
    const Eigen::VectorXd u = 5.0 * coloured_noise(5, samples, 0.6), y = oscillator(u, law);
    record = value_of(
        sampled_measurement(recording(u, y + 1e-3 * rms(y) * coloured_noise(6, samples, 0.0), kRate), "fit 1", {}, *base));
  }
  Eigen::VectorXd left() const { return record->residual(plain, kPlant); }
  std::unique_ptr<const OpenLoop> look(const Addition& effect) const { return record->open_loop(plain, kPlant, left(), effect); }
  /// How far the look's word of the residual with the effect is from the model's, over what the effect changes.
  double distance(const Addition& effect, double value) const {
    JointModel with = plain;
    with.additions.push_back(effect);
    Eigen::VectorXd values(4);
    values << kPlant, value;
    const Eigen::VectorXd before = left(), change = record->residual(with, values) - before;
    return (look(effect)->change(with, values) - change).norm() / change.norm();
  }
};

double rest(double, double) { return 0.0; }

}  // namespace

TEST_CASE("sampled look: a small law changes the residual as its simulation does, also in pieces of a record") {
  Bench b(rest, 3000);
  // 0.7 % of the stiffness at the largest deflection.
  CHECK(b.distance(addition<CubicStiffness>(*b.base), 2000.0) < 0.02);
  CHECK(b.distance(addition<CoulombFriction>(*b.base), 0.02) < 0.1);
  Bench longer(rest, 40000);
  longer.record = longer.record->excerpt();
  REQUIRE(longer.record);
  CHECK(longer.distance(addition<CubicStiffness>(*longer.base), 2000.0) < 0.02);
}

TEST_CASE("sampled look: on the motion that was measured the law that is missing explains what is left") {
  const double cubic = 1.5e5;
  Bench b([cubic](double x, double) { return cubic * x * x * x; }, 4000);
  const Addition law = addition<CubicStiffness>(*b.base);
  const auto look = b.look(law);
  REQUIRE(look);
  JointModel with = b.plain;
  with.additions.push_back(law);
  Eigen::VectorXd values(4);
  values << kPlant, cubic;
  const Eigen::VectorXd left = b.left();
  CHECK((left + look->change(with, values)).norm() < 0.05 * left.norm());
}

TEST_CASE("sampled look: none for what is as quick to compute") {
  Bench b(rest, 1000);
  CHECK(b.look(addition<Delay>(*b.base)) == nullptr);
}
