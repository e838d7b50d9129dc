#include "sampled/sampled_measurement.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include "bases/drive_axis.hpp"
#include "bases/second_order.hpp"
#include "catch.hpp"
#include "effects/coulomb_friction.hpp"
#include "effects/cubic_stiffness.hpp"
#include "effects/delay.hpp"
#include "effects/interharmonic.hpp"
#include "effects/offset.hpp"
#include "effects/sensor_lag.hpp"
#include "plugins/residual/declared_base.hpp"
#include "plugins/residual/sampled/records.hpp"
#include "trace/joint_fit.hpp"

using namespace bodeflow;
using namespace bodeflow::residual;
using namespace bodeflow::residual::testing;

namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;
constexpr double kRate = 200.0;
const Eigen::Vector3d kPlant(0.2, 1.2, 800.0);  // 10 Hz, damping ratio 0.047

std::shared_ptr<const SecondOrder> held_plant() { return declared_base<SecondOrder>({{"hold", std::string("zero_order")}}); }

/// An oscillator with a cubic spring behind a held force, by Runge-Kutta, from a state that is not rest.
Eigen::VectorXd oscillator(const Eigen::VectorXd& force, double cubic) {
  const auto f = [cubic](const Eigen::VectorXd& x, double u) {
    return Eigen::VectorXd(
        Eigen::Vector2d(x[1], (u - kPlant[1] * x[1] - kPlant[2] * x[0] - cubic * x[0] * x[0] * x[0]) / kPlant[0]));
  };
  return integrated(f, Eigen::Vector2d(0.01, -0.5), force, 1.0 / kRate, 20).col(0);
}

std::shared_ptr<const Measurement> measured(const BaseModel& base, const Eigen::VectorXd& u, const Eigen::VectorXd& y,
                                            double rate_hz = kRate, SampledOptions options = {}) {
  return value_of(sampled_measurement(recording(u, y, rate_hz), "fit 1", {}, base, options));
}

Eigen::VectorXd with(const Eigen::VectorXd& values, double more) {
  Eigen::VectorXd all(values.size() + 1);
  all << values, more;
  return all;
}

Fit fitted(const JointModel& model, const Measurements& records, const Eigen::VectorXd& start) {
  return value_of(fit(model, records, {start}));
}

std::string refusal(const BaseModel& base, const records::Recording& r, std::vector<double> known = {},
                    SampledOptions options = {}) {
  const auto m = sampled_measurement(r, "fit 1", std::move(known), base, options);
  return m ? "" : m.error().text;
}

/// x(t) of a smooth movement, and its derivatives.
struct Movement {
  Eigen::VectorXd position, velocity, acceleration;
};
Movement movement(Eigen::Index samples, double sample_time_s) {
  Movement m;
  m.position = m.velocity = m.acceleration = Eigen::VectorXd::Zero(samples);
  const double hz[] = {0.31, 0.83, 1.7}, size[] = {0.1, 0.03, 0.01}, phase[] = {0.3, 1.9, 4.0};
  for (Eigen::Index n = 0; n < samples; ++n) {
    for (int i = 0; i < 3; ++i) {
      const double w = kTwoPi * hz[i], a = w * sample_time_s * static_cast<double>(n) + phase[i];
      m.position[n] += size[i] * std::sin(a);
      m.velocity[n] += size[i] * w * std::cos(a);
      m.acceleration[n] -= size[i] * w * w * std::sin(a);
    }
  }
  return m;
}

}  // namespace

TEST_CASE("sampled: the true model leaves nothing of a record without noise, whatever its initial state") {
  const Eigen::VectorXd u = 5.0 * coloured_noise(1, 3000, 0.6), y = oscillator(u, 0.0);
  const auto base = held_plant();
  const auto m = measured(*base, u, y);
  // 25 samples for each of the two states, or the time constant of 0.33 s.
  CHECK(m->observations().at(0) == "the first 67 samples determine the initial state and are not counted");
  CHECK(m->rows() == 2933);
  CHECK_FALSE(m->floor_known());
  const JointModel model{base, {}};
  CHECK(m->error(m->residual(model, kPlant)).error < 1e-6 * rms(y));
  CHECK(m->eliminated(model, kPlant) == 2);
  const auto starts = base->starts(m->response());
  for (Eigen::Index i = 0; i < 3; ++i) CHECK(starts[0][static_cast<std::size_t>(i)] == Approx(kPlant[i]).epsilon(0.3));
}

TEST_CASE("sampled: residuals count in the root mean square of what the base leaves") {
  const Eigen::VectorXd u = 5.0 * coloured_noise(1, 3000, 0.6), noise = 1e-4 * coloured_noise(2, 3000, 0.3);
  const auto base = held_plant();
  const auto m = measured(*base, u, oscillator(u, 0.0) + noise);
  const Fit f = fitted({base, {}}, {m}, kPlant);
  CHECK(f.chi2 == Approx(static_cast<double>(m->rows())).epsilon(1e-3));
  CHECK(m->error(f.residual).error == Approx(rms(noise)).epsilon(0.02));
  for (Eigen::Index i = 0; i < 3; ++i) CHECK(std::abs(f.values()[i] - kPlant[i]) < 4.0 * f.std()[i]);
}

TEST_CASE("sampled: a cubic spring is found behind a held force, with noise, and gains on a record that was not fitted") {
  const double cubic = 1.5e5;
  const auto base = held_plant();
  Measurements records;
  for (const std::uint64_t seed : {1u, 2u}) {
    const Eigen::VectorXd u = 6.0 * coloured_noise(seed, 4000, 0.6);
    records.push_back(measured(*base, u, oscillator(u, cubic) + 2e-4 * coloured_noise(seed + 10, 4000, 0.5)));
  }
  const Measurements fit_part = {records[0]};
  const Fit linear = fitted({base, {}}, fit_part, kPlant);
  Situation s;
  s.place.coefficient = 1.0;
  const JointModel more{base, {addition<CubicStiffness>(*base, s)}};
  const Fit f = fitted(more, fit_part, with(linear.values(), 0.0));
  for (Eigen::Index i = 0; i < 3; ++i) CHECK(f.values()[i] == Approx(kPlant[i]).epsilon(0.01));
  CHECK(f.values()[3] == Approx(cubic).epsilon(0.02));
  const Eigen::VectorXd before = records[1]->residual(linear.model, linear.values()),
                        after = records[1]->residual(more, f.values());
  CHECK(records[1]->error(after).error == Approx(2e-4).epsilon(0.05));
  const Gain gain = records[1]->gain(before, after);
  CHECK(gain.likelihood > 100.0);
  CHECK(gain.block_z > 4.0);
  CHECK(gain.excess_after < 0.2 * gain.excess_before);
  const Eigen::MatrixXd none(records[1]->rows(), 0);
  const auto tests = records[1]->tests(after, none, Eigen::MatrixXd(), false);
  REQUIRE(tests.size() == 3);
  CHECK(tests[1].name == "input");
  CHECK(tests[1].p > 1e-3);
  CHECK(tests[2].p > 1e-3);
}

TEST_CASE("sampled: a band-limited input drives a linear and a nonlinear plant as its sines do") {
  // Sines that do not fit the record, through the plant's response: what a steady measurement behind an anti-alias filter shows.
  const Eigen::Index n = 3000;
  Eigen::VectorXd u = Eigen::VectorXd::Zero(n), y = u;
  for (int i = 0; i < 12; ++i) {
    const double w = kTwoPi * (0.9 + 5.77 * i);  // up to 64 Hz of 100
    const std::complex<double> s(0.0, w), g = 1.0 / (kPlant[0] * s * s + kPlant[1] * s + kPlant[2]);
    for (Eigen::Index k = 0; k < n; ++k) {
      const std::complex<double> wave = std::polar(1.0, w * static_cast<double>(k) / kRate + i * i);
      u[k] += wave.real();
      y[k] += (g * wave).real();
    }
  }
  const auto base = declared_base<SecondOrder>();
  const auto m = measured(*base, u, y);
  CHECK(m->error(m->residual({base, {}}, kPlant)).error < 2e-3 * rms(y));
}

TEST_CASE("sampled: the residual goes on smoothly where a delay passes whole samples, and finds it") {
  const Eigen::VectorXd force = 5.0 * coloured_noise(3, 2000, 0.6);
  // Two samples later.
  const Eigen::VectorXd y = oscillator(force, 0.0).head(1998), u = force.tail(1998);
  const auto base = held_plant();
  const auto m = measured(*base, u, y);
  const JointModel model{base, {addition<Delay>(*base)}};
  const double t = 1.0 / kRate;
  CHECK(m->error(m->residual(model, with(kPlant, 2.0 * t))).error < 1e-6 * rms(y));
  for (const double d : {0.0, t, 2.0 * t}) {
    const Eigen::VectorXd below = m->residual(model, with(kPlant, d - 1e-8)), above = m->residual(model, with(kPlant, d + 1e-8));
    CHECK((above - below).norm() < 1e-3);
  }
  const Fit f = fitted(model, {m}, with(kPlant, 1.6 * t));
  CHECK(f.values()[3] == Approx(2.0 * t).epsilon(1e-4));
}

TEST_CASE("sampled: a lag in series and a tone on top are taken into account") {
  const Eigen::Index n = 3000;
  const Eigen::VectorXd u = 5.0 * coloured_noise(4, n, 0.6), y = oscillator(u, 0.0);
  const double t = 1.0 / kRate, lag = 0.02;
  // dz/dt = (y - z) / lag with the true y between the samples: Runge-Kutta on the joint system.
  const auto f = [lag](const Eigen::VectorXd& x, double force) {
    return Eigen::VectorXd(Eigen::Vector3d(x[1], (force - kPlant[1] * x[1] - kPlant[2] * x[0]) / kPlant[0], (x[0] - x[2]) / lag));
  };
  Eigen::VectorXd z = integrated(f, Eigen::Vector3d(0.01, -0.5, 0.01), u, t, 20).col(2);
  const auto base = held_plant();
  const auto m = measured(*base, u, z);
  const JointModel model{base, {addition<SensorLag>(*base)}};
  CHECK(m->error(m->residual(model, with(kPlant, lag))).error < 5e-3 * rms(z));
  CHECK(m->error(m->residual({base, {}}, kPlant)).error > 0.1 * rms(z));

  Eigen::VectorXd hummed = y;
  for (Eigen::Index k = 0; k < n; ++k) hummed[k] += 0.01 * std::sin(kTwoPi * 31.7 * t * static_cast<double>(k) + 1.0);
  const auto h = measured(*base, u, hummed);
  Situation s;
  s.peaks_hz = {31.7};
  s.sample_time_s = t;
  const JointModel tone{base, {addition<Interharmonic>(*base, s)}};
  CHECK(h->error(h->residual(tone, with(kPlant, 31.7))).error < 5e-3 * 0.01);
  CHECK(h->eliminated(tone, with(kPlant, 31.7)) == 4);
  Situation told;
  h->say({base, {}}, kPlant, 0, told);
  REQUIRE_FALSE(told.peaks_hz.empty());
  CHECK(told.peaks_hz[0] == Approx(31.7).margin(0.02));
}

TEST_CASE("sampled: quick searches get a part of a long record, spread over it, and of a short one nothing") {
  const Eigen::VectorXd u = 5.0 * coloured_noise(5, 40000, 0.6), y = oscillator(u, 0.0);
  const auto base = held_plant();
  const auto m = measured(*base, u, y);
  const auto part = m->excerpt();
  REQUIRE(part);
  CHECK(part->rows() == 2400);
  const JointModel model{base, {}};
  CHECK(part->error(part->residual(model, kPlant)).error < 1e-6 * rms(y));
  CHECK(measured(*base, u.head(11000), y.head(11000))->excerpt() == nullptr);
}

TEST_CASE("sampled: what is said of a record: sizes, coefficients, what is missing") {
  const Eigen::VectorXd u = 5.0 * coloured_noise(5, 6000, 0.6), y = oscillator(u, 0.0);
  const auto base = held_plant();
  const auto m = measured(*base, u, y);
  Situation s;
  s.place = base->places()[0];
  m->say({base, {}}, kPlant, 0, s);
  CHECK(s.place.coefficient == Approx(kPlant[1]));
  CHECK(s.place.stored == Approx(y.cwiseAbs().maxCoeff()).epsilon(0.05));
  CHECK(s.place.effort == Approx(u.cwiseAbs().maxCoeff()));
  CHECK(s.input_rms == Approx(rms(u)));
  CHECK(s.duration_s == Approx(30.0));
  s.place = base->places()[1];
  m->say({base, {}}, kPlant, 1, s);
  CHECK(s.place.coefficient == Approx(kPlant[2]));
  // A plant that is 5 % stiffer lacks about dG = -G^2 0.05 k below its resonance.
  m->say({base, {}}, Eigen::Vector3d(kPlant[0], kPlant[1], 0.95 * kPlant[2]), 0, s);
  REQUIRE(s.line_hz.size() > 20);
  for (std::size_t i = 4; i < s.line_hz.size() && s.line_hz[i] < 5.0; ++i) {
    const std::complex<double> expected = -s.response[i] * s.response[i] * 0.05 * kPlant[2];
    CHECK(std::abs(s.missing[i] - expected) < 0.4 * std::abs(expected));
  }
}

TEST_CASE("sampled: an axis that integrates is cut into segments and its friction found in a closed loop") {
  // 2 kg, 4 N s/m and 1.5 N of dry friction under a position controller; small steps resolve where it sticks.
  const double rate = 500.0, mass = 2.0, viscous = 4.0, coulomb = 1.5;
  const Eigen::Index n = 2000;
  numerics::Random random(8);
  Eigen::VectorXd u(n), y(n);
  double x = 0.0, v = 0.0;
  const int fine = 100;
  const double h = 1.0 / (rate * fine);
  for (Eigen::Index k = 0; k < n; ++k) {
    y[k] = x + 2e-6 * random.normal();
    const double time = static_cast<double>(k) / rate,
                 reference = 0.05 * std::sin(3.0 * time) + 0.02 * std::sin(8.1 * time + 1.0);
    u[k] = 400.0 * (reference - y[k]) - 20.0 * v;
    for (int i = 0; i < fine; ++i) {
      const double free = v + h * (u[k] - viscous * v) / mass, grip = h * coulomb / mass;
      v = std::abs(free) <= grip ? 0.0 : free - std::copysign(grip, free);
      x += h * v;
    }
  }
  const auto base = declared_base<DriveAxis>();
  const auto m = measured(*base, u, y, rate);
  CHECK(m->observations().at(0).rfind("the plant integrates: ", 0) == 0);
  CHECK(m->rows() == n);
  const Eigen::Vector2d start(mass, viscous);
  const Fit linear = fitted({base, {}}, {m}, start);
  Situation s;
  s.place.effort = 10.0;
  const JointModel more{base, {addition<CoulombFriction>(*base, s)}};
  const Fit f = fitted(more, {m}, with(linear.values(), 0.8));
  CHECK(f.values()[0] == Approx(mass).epsilon(0.01));
  CHECK(f.values()[1] == Approx(viscous).epsilon(0.03));
  CHECK(f.values()[2] == Approx(coulomb).epsilon(0.02));
  CHECK(m->error(f.residual).error < 0.1 * m->error(linear.residual).error);
  const Gain gain = m->gain(linear.residual, f.residual);
  CHECK(gain.block_z > 4.0);
}

TEST_CASE("sampled: an inverse model is exact on smooth data, and its friction passes the filter as the force does") {
  const double t = 1e-3, mass = 95.0, viscous = 200.0, coulomb = 20.0;
  const Eigen::Index n = 12000;
  const Movement x = movement(n, t);
  const Eigen::VectorXd linear = mass * x.acceleration + viscous * x.velocity;
  const auto base = declared_base<DriveAxis>({{"inverse", true}, {"filter", 30.0}});
  const auto m = value_of(sampled_measurement(recording(x.position, linear, 1000.0, "m", "N"), "fit 1", {}, *base));
  const Eigen::Vector2d values(mass, viscous);
  CHECK(m->error(m->residual({base, {}}, values)).error < 1e-3 * rms(linear));
  CHECK(m->eliminated({base, {}}, values) == 0);
  CHECK(m->observations().at(0) ==
        "34 samples at both ends are left out (edges of the filter), every 8th of the others counts (the filter leaves nothing "
        "between)");

  const Eigen::VectorXd force = linear + coulomb * x.velocity.cwiseSign();
  const auto rough = value_of(sampled_measurement(recording(x.position, force, 1000.0, "m", "N"), "fit 1", {}, *base));
  Situation s;
  s.place.effort = 100.0;
  const JointModel more{base, {addition<CoulombFriction>(*base, s)}};
  CHECK(rough->error(rough->residual(more, with(values, coulomb))).error < 0.01 * coulomb);
  const Fit f = fitted(more, {rough}, with(values, 5.0));
  CHECK(f.values()[2] == Approx(coulomb).epsilon(1e-3));
  CHECK(f.values()[0] == Approx(mass).epsilon(1e-3));
}

TEST_CASE("sampled: feedback, drift, clipping and coarse steps are said") {
  const Eigen::Index n = 4000;
  const auto base = held_plant();
  const JointModel model{base, {}};
  // The controller answers the noise three samples later.
  const Eigen::VectorXd noise = 3e-3 * coloured_noise(21, n, 0.8), reference = 5.0 * coloured_noise(22, n, 0.6);
  Eigen::VectorXd u = reference;
  u.tail(n - 3) -= 800.0 * noise.head(n - 3);
  const auto loop = measured(*base, u, oscillator(u, 0.0) + noise);
  const auto remarks = loop->remarks(loop->residual(model, kPlant));
  REQUIRE(remarks.size() >= 3);
  CHECK(remarks[2].rfind("the residual goes with later samples of the input (", 0) == 0);
  CHECK(remarks[2].find(" at a lag of -15 ms)") != std::string::npos);

  const Eigen::VectorXd drift = Eigen::VectorXd::LinSpaced(n, 0.0, 0.01);
  const auto drifting = measured(*base, reference, oscillator(reference, 0.0) + drift + 0.1 * noise);
  const auto said = drifting->remarks(drifting->residual(model, kPlant));
  CHECK(said.back().rfind("the residual drifts by 0.0", 0) == 0);
  CHECK(remarks.back().find("drifts") == std::string::npos);

  const Eigen::VectorXd y = oscillator(reference, 0.0);
  const double limit = 0.6 * y.cwiseAbs().maxCoeff();
  const auto clipped = measured(*base, reference, y.cwiseMax(-limit).cwiseMin(limit));
  CHECK(clipped->observations().at(1).rfind("output 'y' has its greatest value ", 0) == 0);
  const auto coarse = measured(*base, reference, (y.array() / 0.002).round().matrix() * 0.002);
  CHECK(coarse->observations().at(1) == "output 'y' has steps of 0.002 m: rounding adds noise of 0.00058 m");
}

TEST_CASE("sampled: segments of a declared length, or the whole record in one") {
  const Eigen::VectorXd u = 5.0 * coloured_noise(1, 3000, 0.6), y = oscillator(u, 0.0);
  const auto base = held_plant();
  const auto cut = measured(*base, u, y, kRate, {2.5});
  CHECK(cut->rows() == 3000);
  CHECK(cut->eliminated({base, {}}, kPlant) == 12);
  CHECK(cut->error(cut->residual({base, {}}, kPlant)).error < 1e-6 * rms(y));
  const auto axis = declared_base<DriveAxis>();
  const auto whole = measured(*axis, u, y, kRate, {std::numeric_limits<double>::infinity()});
  CHECK(whole->eliminated({axis, {}}, Eigen::Vector2d(1.0, 1.0)) == 2);
}

TEST_CASE("sampled: refuses by name what it can't use") {
  const auto base = held_plant();
  const Eigen::VectorXd u = 5.0 * coloured_noise(1, 3000, 0.6), y = oscillator(u, 0.0);
  CHECK(refusal(*base, recording(u.head(80), y.head(80), kRate)) == "the record has 80 samples; needed: at least 128");
  CHECK(refusal(*base, recording(u.head(150), y.head(150), kRate)) == "the record has 150 samples; needed: at least 200");
  records::Recording gap = recording(u, y, kRate);
  gap.output(7, 0) = std::numeric_limits<double>::quiet_NaN();
  CHECK(refusal(*base, gap) == "'y' is not finite at sample 7");
  CHECK(refusal(*base, recording(Eigen::VectorXd::Ones(3000), y, kRate)) == "input 'u' does not change: nothing is excited");
  CHECK(refusal(*base, recording(u, Eigen::VectorXd::Ones(3000), kRate)) == "output 'y' does not change");
  CHECK(refusal(*base, recording(u, y, kRate), {1.0}) == "the base model needs 0 known values, found 1");
  records::Recording two = recording(u, y, kRate);
  two.input.conservativeResize(3000, 2);
  two.input.col(1) = u;
  CHECK(refusal(*base, two) == "the base model has 1 input channel, the record has 2");
  CHECK(refusal(*base, recording(u, -y, kRate)) ==
        "the output moves against the input at low and at high frequencies: check the signs of the signals");
  CHECK(refusal(*base, recording(u, y, kRate), {}, {0.1}) == "a segment of 0.1 s has 20 samples; needed: at least 100");
  const auto inverse = declared_base<DriveAxis>({{"inverse", true}, {"filter", 60.0}});
  CHECK(refusal(*inverse, recording(u, y, kRate)) == "the filter's corner of 60 Hz is not below a quarter of the sample rate");
}
