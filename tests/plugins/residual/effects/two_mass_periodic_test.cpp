#include <bodeflow/numerics/random.hpp>
#include <cmath>
#include <complex>
#include <numbers>

#include "bases/two_mass.hpp"
#include "catch.hpp"
#include "model/simulate.hpp"
#include "periodic/periodic_measurement.hpp"

using namespace bodeflow;
using namespace bodeflow::residual;

namespace {

using Complex = std::complex<double>;

constexpr Eigen::Index kPeriod = 500, kPeriods = 8;
constexpr double kRate = 500.0;
const Eigen::VectorXd kDrive = (Eigen::VectorXd(6) << 2e-3, 4e-3, 47.0, 0.02, 0.01, 0.02).finished();

/// A drive that integrates, measured at every third line up to 120; the source adds even lines of its own, 30 times smaller, and
/// a mean that a load balances. The angle stands anywhere.
records::Recording recorded(double noise) {
  const TwoMass base;
  numerics::Random random(5);
  records::Recording r;
  r.sample_rate_hz = kRate;
  r.period = kPeriod;
  r.periods = kPeriods;
  r.input_signals = {{"torque"}, {"Nm"}};
  r.output_signals = {{"angle"}, {"rad"}};
  r.input = Eigen::MatrixXd::Constant(kPeriod * kPeriods, 1, 0.07);
  r.output = Eigen::MatrixXd::Constant(kPeriod * kPeriods, 1, 3.5);
  for (Eigen::Index k = 1; k <= 120; ++k) {
    const bool excited = k % 3 == 0, own = !excited && k % 2 == 0;
    if (!excited && !own) continue;
    const Complex u = std::polar(excited ? 0.3 : 0.01, 6.28 * random.uniform());
    const double w = 2.0 * std::numbers::pi * static_cast<double>(k);
    const Complex y = plant_response(base, kDrive, {}, {0.0, w})(0, 0) * u;
    for (Eigen::Index n = 0; n < r.input.rows(); ++n) {
      const Complex turn = std::polar(1.0, w * static_cast<double>(n) / kRate);
      r.input(n, 0) += (u * turn).real();
      r.output(n, 0) += (y * turn).real();
    }
  }
  for (Eigen::Index n = 0; n < r.input.rows(); ++n) {
    r.input(n, 0) += 1e-5 * random.normal();
    r.output(n, 0) += noise * random.normal();
  }
  return r;
}

}  // namespace

TEST_CASE("a drive that integrates: what the source adds is no excitation, and where the angle stands is no residual") {
  const double noise = 1e-4;
  const auto m = periodic_measurement(recorded(noise), "fit 1", {}, TwoMass());
  REQUIRE(m);
  CHECK((*m)->facts().periods == kPeriods);
  JointModel model;
  model.base = std::make_shared<TwoMass>();
  const Eigen::VectorXd r = (*m)->residual(model, kDrive);
  REQUIRE(r.allFinite());
  CHECK(r[0] == 0.0);
  CHECK(r.squaredNorm() / static_cast<double>(r.size()) == Approx(1.0).epsilon(0.1));
  // The band ends above line 120, so the 120th is the last excited one.
  CHECK(r.size() == 2 * kPeriods * 150 + 1);
  for (const MeasuredResponse& response : (*m)->response()) CHECK(response.frequency_hz.size() == 40);
}

TEST_CASE("a drive that integrates: a law in it is simulated to where it repeats") {
  const auto m = periodic_measurement(recorded(1e-4), "fit 1", {}, TwoMass());
  REQUIRE(m);
  JointModel model;
  model.base = std::make_shared<TwoMass>();
  const Eigen::VectorXd linear = (*m)->residual(model, kDrive);
  Situation s;
  s.place = model.base->places()[0];
  struct Nothing final : Effect {
    std::vector<FitParameter> parameters(const Situation&) const override { return {}; }
    std::vector<std::vector<double>> starts(const Situation&) const override { return {{}}; }
    std::string sentence(std::span<const double>, std::span<const double>, const Situation&) const override { return "nothing"; }
  };
  Addition a;
  a.what.acts = Acts::law;
  a.what.id = "test.nothing";
  a.effect = std::make_shared<Nothing>();
  a.place = 0;
  model.additions = {a};
  const Eigen::VectorXd simulated = (*m)->residual(model, kDrive);
  CHECK((simulated - linear).norm() < 1e-2 * linear.norm());
}
