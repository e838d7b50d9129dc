#include "pwm.hpp"

#include <cmath>

#include "catch.hpp"

using namespace bodeflow::drive;

namespace {

Modulation bench() {
  Modulation m;
  m.dead_time_s = 1.5e-6;
  return m;
}

}  // namespace

TEST_CASE("pwm: the mean voltage is the reference in the linear range", "[drive]") {
  Modulation m;
  for (const bool min_max : {false, true}) {
    m.min_max = min_max;
    const double range = linear_range(m);
    CHECK(range == Approx(min_max ? 540.0 / kSqrt3 : 270.0).epsilon(1e-14));
    for (int k = 0; k < 36; ++k) {
      const AlphaBeta u{0.999 * range * std::cos(k * 0.1745), 0.999 * range * std::sin(k * 0.1745)};
      const Switching s = switching(m, u, {}, {});
      CHECK_FALSE(s.limited);
      CHECK(s.mean_voltage.alpha == Approx(u.alpha).margin(1e-10));
      CHECK(s.mean_voltage.beta == Approx(u.beta).margin(1e-10));
    }
  }
}

TEST_CASE("pwm: dead time takes 10.8 V from the alpha axis, against the current", "[drive]") {
  CHECK(switching(bench(), {20, 0}, {0.3, 0}, {}).mean_voltage.alpha == Approx(20 - 10.8).epsilon(1e-12));
  CHECK(switching(bench(), {20, 0}, {-0.3, 0}, {}).mean_voltage.alpha == Approx(20 + 10.8).epsilon(1e-12));
  CHECK(switching(bench(), {20, 0}, {0, 0}, {}).mean_voltage.alpha == Approx(20).epsilon(1e-12));
}

TEST_CASE("pwm: compensation by the right sign gives the reference back", "[drive]") {
  Modulation m = bench();
  m.compensation_time_s = m.dead_time_s;
  const Switching s = switching(m, {20, -7}, {0.3, -0.9}, {0.3, -0.9});
  CHECK(s.mean_voltage.alpha == Approx(20).epsilon(1e-12));
  CHECK(s.mean_voltage.beta == Approx(-7).epsilon(1e-12));
  CHECK(switching(m, {20, 0}, {0.3, 0}, {-0.3, 0}).mean_voltage.alpha == Approx(20 - 21.6).epsilon(1e-12));
}

TEST_CASE("pwm: over-modulation is said, and every edge stays inside the period", "[drive]") {
  const Modulation m = bench();
  for (int k = 0; k < 1000; ++k) {
    const double turn = 0.0063 * k, sign = k % 2 == 0 ? -1.0 : 1.0;
    const Switching s = switching(m, {400 * std::cos(turn), 400 * std::sin(turn)}, {sign, 0.5 * sign}, {});
    CHECK(s.limited);
    for (const Pulse& p : s.legs) {
      CHECK(p.on >= 0);
      CHECK(p.off > p.on);
      CHECK(p.off <= m.period_s);
    }
  }
  CHECK(switching(m, {linear_range(m) + 0.01, 0}, {}, {}).limited);
  CHECK_FALSE(switching(m, {linear_range(m) - 0.01, 0}, {}, {}).limited);
}
