#include <cmath>

#include "catch.hpp"
#include "periodic/periodic_measurement.hpp"
#include "periodic_bench.hpp"

using namespace bodeflow;
using namespace bodeflow::residual;
using namespace bodeflow::residual::small;
using Complex = std::complex<double>;

namespace {

Eigen::VectorXd with(std::vector<double> more) {
  Eigen::VectorXd all(3 + static_cast<Eigen::Index>(more.size()));
  all << mass_values(), Eigen::Map<const Eigen::VectorXd>(more.data(), static_cast<Eigen::Index>(more.size()));
  return all;
}

Addition law(std::function<Reaction(const double*, const Signals&)> reacts, std::size_t place) {
  auto [addition, effect] = made(Acts::law, 1, place);
  effect->law = [reacts](const double* p, const Signals& s, const double*, double*) { return reacts(p, s); };
  addition.what.steps_per_sample = 8;
  return addition;
}

Addition cubic() {
  return law(
      [](const double* p, const Signals& s) {
        return Reaction{p[0] * s.stored * s.stored * s.stored, 0.0, 3.0 * p[0] * s.stored * s.stored};
      },
      1);
}

/// A record of that model, a tenth of a percent of the output as noise.
struct Recorded {
  std::shared_ptr<Mass> base = std::make_shared<Mass>();
  Eigen::VectorXd u = multisine(1.0, 1);
  double rms = 0.0;
  std::shared_ptr<const Measurement> record;

  Recorded(const std::vector<Addition>& plant, const Eigen::VectorXd& values) {
    base->declared.hold = Hold::zero_order;
    const JointModel model{base, plant};
    Drive d = drive(model, values, u);
    d.periods = model.nonstationary() ? 7 : 1;
    const Eigen::VectorXd y = simulate(model, values, {}, d).value().output;
    rms = std::sqrt(y.squaredNorm() / static_cast<double>(y.size()));
    record = periodic_measurement(recording(u, y, noise(7 * kPeriod, 1e-3 * rms, 0.0, 2)), "x", {}, *base).value();
  }
};

/// What a look says and what the model itself says that an addition changes.
struct Both {
  Eigen::VectorXd look, model;
  double distance() const { return (look - model).norm() / model.norm(); }
};

Both both(const Recorded& r, const std::vector<Addition>& before, const Eigen::VectorXd& values, const Addition& effect,
          double value) {
  const JointModel model{r.base, before};
  JointModel joint = model;
  joint.additions.push_back(effect);
  Eigen::VectorXd all(values.size() + 1);
  all << values, value;
  const Eigen::VectorXd left = r.record->residual(model, values);
  const auto look = r.record->open_loop(model, values, left, effect);
  REQUIRE(look != nullptr);
  return {look->change(joint, all), r.record->residual(joint, all) - left};
}

}  // namespace

TEST_CASE("open loop: what a small law changes is what its simulation says") {
  const Recorded r({}, mass_values());
  const double k = mass_values()[2], c = mass_values()[1], x = r.rms;
  CHECK(both(r, {}, mass_values(), cubic(), 1e-5 * k / (x * x)).distance() < 0.01);
  const Addition square = law(
      [](const double* p, const Signals& s) {
        return Reaction{p[0] * s.flow * std::abs(s.flow), 2.0 * p[0] * std::abs(s.flow), 0.0};
      },
      0);
  CHECK(both(r, {}, mass_values(), square, 1e-5 * c / (50.0 * x)).distance() < 0.02);
  Addition dry = law(
      [](const double* p, const Signals& s) {
        const double width = 1e-4 + s.gain * p[0];
        return Reaction{p[0] * std::clamp(s.flow / width, -1.0, 1.0), std::abs(s.flow) < width ? p[0] / width : 0.0, 0.0};
      },
      0);
  dry.what.rough = true;
  CHECK(both(r, {}, mass_values(), dry, 1e-3).distance() < 0.05);
}

TEST_CASE("open loop: a great law on the measured motion leaves nearly noise, without a simulation") {
  const double k = mass_values()[2];
  const Recorded plain({}, mass_values());
  const double beta = 0.3 * k / (9.0 * plain.rms * plain.rms);
  const Recorded r({cubic()}, with({beta}));
  const JointModel model{r.base, {}}, joint{r.base, {cubic()}};
  const Eigen::VectorXd left = r.record->residual(model, mass_values());
  const auto look = r.record->open_loop(model, mass_values(), left, joint.additions.front());
  REQUIRE(look != nullptr);
  const double before = left.squaredNorm(), after = (left + look->change(joint, with({beta}))).squaredNorm();
  CHECK(before > 100.0 * static_cast<double>(left.size()));
  CHECK(after < 0.01 * before);
}

TEST_CASE("open loop: a law that depends on the time is run through the whole record") {
  Addition warming = law(
      [](const double* p, const Signals& s) {
        return Reaction{p[0] * s.time_s * s.flow, p[0] * s.time_s, 0.0};
      },
      0);
  warming.what.nonstationary = true;
  const Recorded r({}, mass_values());
  const double rate = 1e-3 * mass_values()[1] / (7.0 * kPeriod / kRate);
  CHECK(both(r, {}, mass_values(), warming, rate).distance() < 0.03);
}

TEST_CASE("open loop: beside a law the other kinds of effect follow in closed form") {
  // What the law does of its own to a change is left out: some per cent.
  const double k = mass_values()[2];
  const Recorded plain({}, mass_values());
  const double beta = 0.01 * k / (9.0 * plain.rms * plain.rms);
  const Recorded r({cubic()}, with({beta}));
  const auto distance = [&](Acts acts, auto set, double value, std::size_t place = Addition::kNoPlace) {
    auto [addition, effect] = made(acts, 1, place);
    set(*effect);
    return both(r, {cubic()}, with({beta}), addition, value).distance();
  };
  CHECK(distance(
            Acts::series, [](Made& e) { e.passes = [](const double* p, Complex s) { return 1.0 / (1.0 + s * p[0]); }; }, 1e-4) <
        0.05);
  CHECK(distance(
            Acts::delay, [](Made& e) { e.delays = [](const double* p) { return p[0]; }; }, 1e-4) < 0.05);
  CHECK(distance(
            Acts::parallel,
            [](Made& e) { e.passes = [](const double* p, Complex s) { return p[0] / (s * s + 9.0 * s + 900.0); }; },
            1e-4) < 0.05);
  CHECK(distance(
            Acts::output, [](Made& e) { e.maps = [](const double* p, double x, double, double*) { return x + p[0] * x * x; }; },
            1.0) < 0.01);
  CHECK(distance(
            Acts::input, [](Made& e) { e.maps = [](const double* p, double x, double, double*) { return x + p[0] * x * x; }; },
            1e-3) < 0.05);
  CHECK(distance(
            Acts::immittance, [](Made& e) { e.passes = [](const double* p, Complex) { return Complex(p[0]); }; },
            1e-4 * mass_values()[1], 0) < 0.1);
}

TEST_CASE("open loop: there is none where the residual itself is as quick") {
  const Recorded r({}, mass_values());
  auto [addition, effect] = made(Acts::series, 1);
  const JointModel model{r.base, {}};
  CHECK(r.record->open_loop(model, mass_values(), r.record->residual(model, mass_values()), addition) == nullptr);
}
