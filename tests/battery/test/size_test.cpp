#include "generate/size.hpp"

#include <cmath>

#include "catch.hpp"
#include "drives.hpp"

using namespace battery;
using namespace battery::test;

TEST_CASE("battery: a plant with other parameters has no model error") {
  Motor m, other;
  other.rs *= 1.1;
  other.lm *= 0.95;
  other.leakage *= 1.05;
  const Drive d = drive_for(m.line_choice(), m.sample_time(), 20.0);
  const Series y = sampled(d, other.clean(d));
  CHECK(model_error(m, {d}, {y}) < 1e-6 * root_mean_square(y));

  Oscillator o, changed;
  changed.stiffness *= 1.03;
  changed.damping *= 1.2;
  const Drive e = drive_for(o.line_choice(), o.sample_time(), 10.0);
  const Series x = sampled(e, changed.clean(e));
  CHECK(model_error(o, {e}, {x}) < 1e-6 * root_mean_square(x));
}

TEST_CASE("battery: the model error of an offset is the offset, of a foreign tone its rms") {
  const Oscillator o;
  const Drive d = drive_for(o.line_choice(), o.sample_time(), 10.0);
  const Series clean = sampled(d, o.clean(d));
  const double a = 0.1 * root_mean_square(clean);
  Series y = clean;
  for (double& v : y) v += a;
  CHECK(model_error(o, {d}, {y}) == Approx(a).epsilon(1e-6));
  y = clean;
  for (std::size_t n = 0; n < y.size(); ++n) y[n] += a * std::sin(0.7123 * static_cast<double>(n));
  CHECK(model_error(o, {d}, {y}) == Approx(a / std::sqrt(2.0)).epsilon(1e-3));
}

TEST_CASE("battery: a record that is no number has an infinite model error") {
  const Oscillator o;
  const Drive d = drive_for(o.line_choice(), o.sample_time(), 10.0);
  Series y = sampled(d, o.clean(d));
  y.back() = std::nan("");
  CHECK(std::isinf(model_error(o, {d}, {y})));
}

TEST_CASE("battery: the strength for a wanted size is found for any growth, and ends at the largest") {
  for (const double power : {0.5, 1.0, 2.0, 4.0}) {
    for (const double wanted : {1e-3, 1.0, 7.0}) {
      const Sized s = strength_for(wanted, 0.1, 1e9, [=](double x) { return 3.0 * std::pow(x, power); });
      CHECK(s.error == Approx(wanted).epsilon(0.06));
      CHECK(s.error == 3.0 * std::pow(s.strength, power));
    }
  }
  CHECK(strength_for(100.0, 0.1, 2.0, [](double x) { return x; }).strength == 2.0);
  // What runs away beyond 1 is not taken.
  const Sized s = strength_for(0.5, 3.0, 10.0, [](double x) { return x > 1.0 ? INFINITY : x; });
  CHECK(s.error == Approx(0.5).epsilon(0.06));
  // Clearances touch nothing below a strength.
  CHECK(strength_for(0.5, 0.1, 10.0, [](double x) { return std::max(0.0, x - 2.0); }).error == Approx(0.5).epsilon(0.06));
}
