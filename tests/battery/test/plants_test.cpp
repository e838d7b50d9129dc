#include <cmath>

#include "catch.hpp"
#include "drives.hpp"
#include "generate/integrate.hpp"
#include "generate/stick_slip.hpp"
#include "generate/switching.hpp"

using namespace battery;
using namespace battery::test;

namespace {

/// Greatest difference between the coefficients of a record and the plant's response, relative to the greatest coefficient.
double mismatch(const Plant& plant, const Drive& d, const Series& y) {
  const auto found = last_period(d, y);
  double worst = 0.0, largest = 0.0;
  for (std::size_t j = 0; j < found.size(); ++j) {
    const Complex wanted = plant.response(plant.parameters(), d.omega(j)) * d.line(j);
    worst = std::max(worst, std::abs(found[j] - wanted));
    largest = std::max(largest, std::abs(wanted));
  }
  return worst / largest;
}

}  // namespace

TEST_CASE("battery: the modes of the motor are the impedance of its T circuit") {
  Random random("circuit");
  for (int n = 0; n < 5; ++n) {
    const Motor m = Motor::draw(random);
    for (const double omega : {0.0, 3.0, 100.0, 2000.0}) {
      const Complex s(0.0, omega);
      Complex sum;
      for (const Mode& mode : m.modes()) sum += mode.residue / (s - mode.pole);
      CHECK(std::abs(sum / m.admittance(s, 1.0) - 1.0) < 1e-11);
    }
  }
}

TEST_CASE("battery: the motor's clean record is the sampled response of its modes to a held voltage") {
  Random random("motor");
  const Motor m = Motor::draw(random);
  const Drive d = drive_for(m.line_choice(), m.sample_time(), m.input_rms());
  CHECK(mismatch(m, d, sampled(d, m.clean(d))) < 1e-10);
}

TEST_CASE("battery: the sampled response of the motor is its admittance folded over the harmonics of the staircase") {
  const Motor m;
  const double t = m.sample_time(), omega = 2.0 * M_PI * 130.0;
  Complex sum;
  for (int fold = -20000; fold <= 20000; ++fold) {
    const double w = omega + fold * 2.0 * M_PI / t;
    sum += m.admittance(Complex(0.0, w), 1.0) * (1.0 - std::polar(1.0, -omega * t)) / Complex(0.0, w * t);
  }
  CHECK(std::abs(sum / m.response(m.parameters(), omega) - 1.0) < 1e-5);
}

TEST_CASE("battery: the oscillator's clean record is its response to the multisine") {
  Random random("oscillator");
  const Oscillator o = Oscillator::draw(random);
  const Drive d = drive_for(o.line_choice(), o.sample_time(), o.input_rms());
  CHECK(mismatch(o, d, sampled(d, o.clean(d))) < 1e-7);
}

TEST_CASE("battery: the integrator is of order 4") {
  const auto error = [](int steps) {
    State<2> x{1.0, 0.0};
    const double h = 1.0 / steps;
    for (int n = 0; n < steps; ++n) {
      x = runge_kutta(x, h, [&](double c, const State<2>& s) { return State<2>{s[1], -s[0] + std::sin(2.0 * (n + c) * h)}; });
    }
    // x'' = -x + sin 2t from x = 1 at rest.
    return std::abs(x[0] - (std::cos(1.0) + 2.0 / 3.0 * std::sin(1.0) - std::sin(2.0) / 3.0));
  };
  CHECK(error(20) / error(40) == Approx(16.0).epsilon(0.1));
  CHECK(error(40) / error(80) == Approx(16.0).epsilon(0.1));
}

TEST_CASE("battery: switching without dead time gives the current of the held voltage") {
  const Motor m;
  const Drive d = drive_for(m.line_choice(), m.sample_time(), 20.0);
  const Series held = sampled(d, m.clean(d));
  Series switched = switched_current(m, {400.0, 10, 0.0}, d);
  for (std::size_t n = 0; n < held.size(); ++n) switched[n] -= held[n];
  CHECK(root_mean_square(switched) < 5e-4 * root_mean_square(held));  // of the ripple at the sampling instant
}

TEST_CASE("battery: dead time takes its share of the link from a current beyond the ripple, and nothing within it") {
  const Motor m;
  const Switching s{400.0, 10, 2e-6};
  const double lost = 400.0 * 2e-6 / 100e-6;
  for (const double volts : {30.0, -30.0}) {
    const Drive d = constant_drive(volts, m.sample_time());
    const double current = switched_current(m, s, d).back();
    CHECK(current == Approx((volts - std::copysign(lost, volts)) / m.rs).epsilon(2e-3));
  }
  // Half a ripple is link / 8 / sigma of a PWM period; a quarter of it flows.
  const double sigma = 1.0 / m.parameters()[3], ripple = 400.0 / 8.0 * 100e-6 / sigma;
  const double volts = 0.25 * ripple * m.rs;
  CHECK(switched_current(m, s, constant_drive(volts, m.sample_time())).back() == Approx(volts / m.rs).epsilon(0.02));
}

TEST_CASE("battery: what rubs does not move below its friction") {
  const Oscillator o;
  const Drive d = drive_for(o.line_choice(), o.sample_time(), 1.0);
  CHECK(peak(stick_slip(o, 1.01 * peak(d.half_steps), d)) == 0.0);
  CHECK(peak(stick_slip(o, 0.5 * peak(d.half_steps), d)) > 0.0);
}

TEST_CASE("battery: a pushed oscillator that rubs stops where energy and friction say") {
  Oscillator o;
  o.damping = 0.0;
  // From rest a force of two frictions carries it to 2 (F - Fc) / k, where spring and force balance: it stays.
  const Drive d = constant_drive(2.0, o.sample_time());
  const Series x = sampled(d, stick_slip(o, 1.0, d));
  CHECK(x.front() == Approx(2.0 * (2.0 - 1.0) / o.stiffness).epsilon(1e-8));
  CHECK(x.back() == x.front());
}

TEST_CASE("battery: friction takes the energy of its amplitude at resonance") {
  Oscillator o;
  const Drive d = drive_for({203}, o.sample_time(), 10.0);  // 9.91 Hz
  o.stiffness = o.mass * d.omega(0) * d.omega(0);
  const double friction = 1.0;
  const double a = std::abs(last_period(d, sampled(d, stick_slip(o, friction, d)))[0]);
  // Harmonic balance: F = c w A + 4 Fc / pi.
  CHECK(a == Approx((d.amplitude - 4.0 * friction / M_PI) / (o.damping * d.omega(0))).epsilon(2e-3));
}
