#include <cmath>

#include "catch.hpp"
#include "drives.hpp"
#include "generate/case.hpp"
#include "generate/sensors.hpp"

using namespace battery;
using namespace battery::test;

namespace {

template <class P>
Hidden find(const std::vector<Maker<P>>& makers, const std::string& name, const P& plant, const Scale& scale) {
  Random random(name);
  for (const auto& m : makers) {
    if (m.name == name) return m.make(plant, scale, random);
  }
  FAIL("no " << name);
  return {};
}

template <class P>
Scale scale_of(const P& plant, const Drive& d) {
  const Series y = sampled(d, plant.clean(d));
  return {plant.input_rms(), root_mean_square(y), peak(y)};
}

Series run(const Hidden& h, const Drive& d, double strength) {
  Random random("run");
  return h.run(d, strength, random);
}

double distance(Series a, const Series& b) {
  for (std::size_t n = 0; n < a.size(); ++n) a[n] -= b[n];
  return root_mean_square(a);
}

/// At strength 0+ nothing is hidden, and more strength hides more.
template <class P>
void check_growth(const std::vector<Maker<P>>& makers, const P& plant) {
  const Drive d = drive_for(plant.line_choice(), plant.sample_time(), plant.input_rms());
  const Series clean = sampled(d, plant.clean(d));
  const Scale scale = scale_of(plant, d);
  for (const auto& maker : makers) {
    INFO(maker.name);
    const Hidden h = find(makers, maker.name, plant, scale);
    CHECK(h.name == maker.name);
    // What clips or stops touches nothing at first.
    const double first = distance(run(h, d, h.first), clean), little = distance(run(h, d, 1e-3 * h.first), clean);
    CHECK(first > 0.0);
    CHECK(first < scale.output_rms);
    CHECK(little < 0.05 * first);
  }
}

}  // namespace

TEST_CASE("battery: every effect of the motor begins at nothing and grows") {
  check_growth(motor_effects(), Motor{});
  check_growth(motor_strangers(), Motor{});
}

TEST_CASE("battery: every effect of the oscillator begins at nothing and grows") {
  check_growth(oscillator_effects(), Oscillator{});
  check_growth(oscillator_strangers(), Oscillator{});
}

TEST_CASE("battery: at least eight families are in no catalogue") {
  std::vector<std::string> names = effects_of("motor", Kind::outside);
  for (const auto& name : effects_of("mechanical", Kind::outside)) names.push_back(name);
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  CHECK(names.size() >= 8);
}

TEST_CASE("battery: a delay of one sample moves a record by one sample") {
  const Motor m;
  const Drive d = drive_for(m.line_choice(), m.sample_time(), 20.0);
  const Series clean = sampled(d, m.clean(d)), late = run(find(motor_effects(), "delay", m, scale_of(m, d)), d, 1.0);
  double worst = 0.0;
  for (std::size_t n = 1; n < late.size(); ++n) worst = std::max(worst, std::abs(late[n] - clean[n - 1]));
  CHECK(worst < 1e-12);

  const Oscillator o;
  const Drive e = drive_for(o.line_choice(), o.sample_time(), 10.0);
  const Series x = sampled(e, o.clean(e)), x_late = run(find(oscillator_effects(), "delay", o, scale_of(o, e)), e, 1.0);
  worst = 0.0;
  for (std::size_t n = 1; n < x.size(); ++n) worst = std::max(worst, std::abs(x_late[n] - x[n - 1]));
  CHECK(worst < 1e-12 * peak(x) + 1e-18);
}

TEST_CASE("battery: delay and lag of the motor's sensor are factors of what its current holds before it is sampled") {
  const Motor m;
  const Drive d = drive_for(m.line_choice(), m.sample_time(), 20.0);
  const Scale scale = scale_of(m, d);
  const double t = m.sample_time(), seconds = 0.37e-3;
  for (const bool lag : {false, true}) {
    const auto found = last_period(d, run(find(motor_effects(), lag ? "sensor_lag" : "delay", m, scale), d, seconds / t));
    for (const std::size_t j : {std::size_t{0}, d.lines.size() / 2, d.lines.size() - 1}) {
      Complex sum;
      for (int fold = -4000; fold <= 4000; ++fold) {
        const Complex s(0.0, d.omega(j) + fold * 2.0 * M_PI / t);
        sum += m.admittance(s, 1.0) * (1.0 - std::polar(1.0, -d.omega(j) * t)) / (s * t) *
               (lag ? 1.0 / (1.0 + s * seconds) : std::exp(-s * seconds));
      }
      CHECK(std::abs(found[j] / (sum * d.line(j)) - 1.0) < 1e-4);
    }
  }
}

TEST_CASE("battery: the cubic spring and the quadratic damper do what harmonic balance says of one sine") {
  Oscillator o;
  const Drive d = drive_for({203}, o.sample_time(), 10.0);
  const double w = d.omega(0), f = d.amplitude;
  o.stiffness = 1.3 * o.mass * w * w;
  const Scale scale = scale_of(o, d);
  const Hidden spring = find(oscillator_effects(), "cubic_stiffness", o, scale);
  double a = std::abs(last_period(d, run(spring, d, 0.02))[0]);
  const double k = o.stiffness + 0.75 * spring.values(0.02)[0].value * a * a - o.mass * w * w;
  CHECK(std::hypot(k, o.damping * w) * a == Approx(f).epsilon(1e-3));

  const Hidden damper = find(oscillator_effects(), "quadratic_damping", o, scale);
  a = std::abs(last_period(d, run(damper, d, 3.0))[0]);
  const double c = o.damping + 8.0 / (3.0 * M_PI) * damper.values(3.0)[0].value * w * a;
  CHECK(std::hypot(o.stiffness - o.mass * w * w, c * w) * a == Approx(f).epsilon(1e-3));
}

TEST_CASE("battery: play holds back half of its travel and clips nothing else") {
  const Oscillator o;
  const Drive d = drive_for({41}, o.sample_time(), 10.0);
  const Scale scale = scale_of(o, d);
  const Hidden h = find(oscillator_effects(), "play", o, scale);
  const double half = h.values(0.2)[0].value;
  CHECK(peak(run(h, d, 0.2)) == Approx(scale.output_peak - half).epsilon(1e-3));
  const Hidden clip = find(oscillator_effects(), "clipping", o, scale);
  CHECK(peak(run(clip, d, 0.2)) == Approx(clip.values(0.2)[0].value));
}

TEST_CASE("battery: a saturated motor keeps its small-signal inductance") {
  const Motor m;
  const Drive small = drive_for(m.line_choice(), m.sample_time(), 1e-3);
  Scale scale{20.0, 1.0, 3.0};
  const Hidden h = find(motor_effects(), "saturation", m, scale);
  const Series clean = sampled(small, m.clean(small));
  CHECK(distance(run(h, small, 1.0), clean) < 1e-5 * root_mean_square(clean));
}
