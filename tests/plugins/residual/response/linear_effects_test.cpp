#include "linear_effects.hpp"

#include <bodeflow/unit_parse.hpp>
#include <cmath>
#include <complex>
#include <numbers>
#include <set>

#include "catch.hpp"
#include "effects/creep.hpp"
#include "effects/delay.hpp"
#include "effects/eddy_shunt.hpp"
#include "effects/extra_mode.hpp"
#include "effects/feed_through.hpp"
#include "effects/iron_loss.hpp"
#include "effects/second_cage.hpp"
#include "effects/semi_inductance.hpp"
#include "effects/sensor_lag.hpp"
#include "effects/skin_effect.hpp"

using namespace bodeflow;
using namespace bodeflow::residual;
using namespace bodeflow::residual::testing;

namespace {

using Complex = std::complex<double>;

constexpr double kTwoPi = 2.0 * std::numbers::pi;

Complex axis(double frequency_hz) { return {0.0, kTwoPi * frequency_hz}; }

double error(Complex found, Complex expected) { return std::abs(found - expected) / std::abs(expected); }

/// sqrt(x) coth sqrt(x) as the continued fraction 1 + x / (3 + x / (5 + ...)), which is the ladder of a bar cut into layers.
Complex bar(Complex x) {
  Complex rest = 401.0;
  for (int n = 399; n >= 1; n -= 2) rest = static_cast<double>(n) + x / rest;
  return rest;
}

/// A resonance of 1 A/V and an effect beside it as its residual, over lines of 5 to 200 Hz.
Situation situation_with(const std::function<Complex(Complex s, Complex g)>& measured) {
  Situation s;
  s.input_unit = "V";
  s.output_unit = "A";
  for (int k = 1; k <= 80; ++k) {
    const double f = 2.5 * k + 0.01 * k * k;
    const Complex at = axis(f), g = 1.0 / (1.0 + at * 2e-3);
    s.line_hz.push_back(f);
    s.response.push_back(g);
    s.missing.push_back(measured(at, g) - g);
    s.missing_std.push_back(1e-4);
  }
  return s;
}

std::vector<Situation> situations(const Linear& t) {
  std::vector<Situation> all;
  for (const std::string& kind : t.what.kinds) {
    Situation s = situation_with([](Complex at, Complex g) { return g * std::exp(-1e-4 * at); });
    s.place = {"the_place", kind, "A", "A*s", "V", 0.0, 2.0, 0.05, 10.0};
    all.push_back(s);
  }
  all.push_back(Situation{});
  return all;
}

}  // namespace

TEST_CASE("linear effects: texts, units and places are there, and starts lie within the bounds") {
  std::set<std::string> ids;
  for (const Linear& t : linear_effects()) {
    INFO(t.what.id);
    CHECK(ids.insert(t.what.id).second);
    CHECK(t.what.linear());
    CHECK(t.what.summary.size() > 20);
    CHECK((t.what.acts == Acts::immittance) == !t.what.kinds.empty());
    for (const Situation& s : situations(t)) {
      const auto parameters = t.effect->parameters(s);
      const auto starts = t.effect->starts(s);
      REQUIRE_FALSE(starts.empty());
      for (const FitParameter& p : parameters) {
        INFO(p.name << " [" << p.unit << "]");
        CHECK(parse_unit(p.unit.empty() ? "1" : p.unit));
        CHECK_FALSE(p.doc.empty());
        CHECK(p.scale > 0.0);
      }
      for (const auto& start : starts) {
        REQUIRE(start.size() == parameters.size());
        for (std::size_t i = 0; i < start.size(); ++i) {
          CHECK(std::isfinite(start[i]));
          CHECK(start[i] >= parameters[i].low);
          CHECK(start[i] <= parameters[i].high);
          CHECK((!parameters[i].logarithmic || start[i] > 0.0));
        }
        const std::vector<double> std(start.size(), 0.01);
        CHECK(t.effect->sentence(start, std, s).size() > 15);
        for (const double f : {0.0, 1e-3, 50.0, 1e5}) {
          const Complex z = t.effect->transfer(start.data(), axis(f));
          CHECK(std::isfinite(std::abs(z)));
        }
      }
    }
  }
}

TEST_CASE("skin_effect: the deviation of a bar from its behaviour at low frequencies, by its continued fraction") {
  const double resistance = 3.5, time = 0.03, p[] = {resistance * time * time / 45.0, time};
  for (const double f : {1e-4, 0.1, 1.0, 20.0, 300.0, 1e4}) {
    const Complex x = axis(f) * time, expected = resistance * (bar(x) - 1.0 - x / 3.0);
    if (std::abs(x) > 1e-3) CHECK(error(SkinEffect().transfer(p, axis(f)), expected) < 1e-6);
  }
  // The series near 0 and the closed form meet; the law there is k w^2, far above it grows with the root of the frequency.
  const double below = 0.0499 / time, above = 0.0501 / time;
  CHECK(error(SkinEffect().transfer(p, {0.0, below}) * above * above, SkinEffect().transfer(p, {0.0, above}) * below * below) <
        1e-4);
  CHECK(error(SkinEffect().transfer(p, axis(1e-3)).real(), p[0] * kTwoPi * kTwoPi * 1e-6) < 1e-6);
  const double high =
      (SkinEffect().transfer(p, axis(4e6)).real() + resistance) / (SkinEffect().transfer(p, axis(1e6)).real() + resistance);
  CHECK(high == Approx(2.0).epsilon(1e-3));
}

TEST_CASE("second_cage: two cages in parallel, less what is seen of them at low frequencies") {
  const double ra = 2.0, la = 4e-3, rb = 0.7, lb = 11e-3, sum = ra + rb;
  const double time = (la + lb) / sum, rise = (ra * lb - rb * la) * (ra * lb - rb * la) / (sum * sum * sum);
  const double resistance = ra * rb / sum, inductance = (ra * lb + rb * la) / sum - resistance * time;
  const double p[] = {rise, time};
  for (const double f : {1.0, 30.0, 1000.0}) {
    const Complex s = axis(f), a = ra + s * la, b = rb + s * lb;
    CHECK(error(resistance + s * inductance + SecondCage().transfer(p, s), a * b / (a + b)) < 1e-12);
  }
}

TEST_CASE("eddy_shunt: an inductance with a resistance across it") {
  const double p[] = {3e-3, 5.0};
  for (const double f : {1.0, 250.0, 1e5}) {
    const Complex s = axis(f);
    CHECK(error(1.0 / EddyShunt().transfer(p, s), 1.0 / (s * p[0]) + 1.0 / p[1]) < 1e-12);
  }
}

TEST_CASE("semi_inductance: constant phase, a power of the frequency, and thick iron as the limit of many rings") {
  const double p[] = {3.2, 0.68};
  const Complex at_1k = SemiInductance().transfer(p, axis(1000.0)), at_8k = SemiInductance().transfer(p, axis(8000.0));
  CHECK(std::abs(at_1k) == Approx(3.2));
  CHECK(std::arg(at_1k) == Approx(0.68 * std::numbers::pi / 2.0));
  CHECK(std::arg(at_8k) == Approx(0.68 * std::numbers::pi / 2.0));
  CHECK(std::abs(at_8k) / std::abs(at_1k) == Approx(std::pow(8.0, 0.68)));
  const double half[] = {1.0, 0.5};
  const Complex deep = axis(100.0) * 1e3;  // a bar far beyond its skin depth is thick iron
  CHECK(error(SemiInductance().transfer(half, axis(100.0)) / std::abs(SemiInductance().transfer(half, axis(100.0))),
              bar(deep) / std::abs(bar(deep))) < 0.01);
}

TEST_CASE("creep: stiffness in proportion to the logarithm of the frequency, and the compliance of Knudsen and Jensen") {
  const double p[] = {120.0};
  const auto stiffness = [&p](double f) { return axis(f) * Creep().transfer(p, axis(f)); };
  CHECK(std::abs(stiffness(1.0).real()) < 1e-9);
  CHECK(stiffness(10.0).real() == Approx(120.0));
  CHECK(stiffness(1000.0).real() == Approx(360.0));
  CHECK(stiffness(3.0).imag() == Approx(120.0 * std::numbers::pi / (2.0 * std::log(10.0))));
  CHECK(Creep().transfer(p, axis(5.0)).real() > 0.0);  // it takes energy
  const double base = 5000.0, lambda = p[0] / base;
  for (const double f : {2.0, 20.0}) {
    const Complex compliance = (1.0 - lambda * std::log10(axis(f) / kTwoPi)) / base;
    const double first_order = lambda * std::abs(std::log10(axis(f) / kTwoPi));
    CHECK(error(base + stiffness(f), 1.0 / compliance) < 1.1 * first_order * first_order);
  }
}

TEST_CASE("sensor_lag, feed_through, iron_loss, delay: their closed forms") {
  const double time[] = {2e-3}, direct[] = {-0.3}, late[] = {150e-6};
  CHECK(error(SensorLag().transfer(time, axis(100.0)), 1.0 / Complex(1.0, kTwoPi * 0.2)) < 1e-14);
  CHECK(error(FeedThrough().transfer(direct, axis(7.0)), -0.3) < 1e-15);
  CHECK(error(IronLoss().transfer(time, axis(7.0)), 2e-3) < 1e-15);
  CHECK(Delay().delay_s(late) == 150e-6);
}

TEST_CASE("extra_mode: a resonance of that frequency and damping, whose value at it is the one that was asked for") {
  const double p[] = {50.0, 0.02, 0.3, -0.8};
  CHECK(error(ExtraMode().transfer(p, axis(50.0)), {0.3, -0.8}) < 1e-12);
  const double omega = kTwoPi * 50.0;
  for (const double f : {5.0, 49.0, 51.0, 400.0}) {  // as its two poles
    const Complex s = axis(f), pole = omega * Complex(-0.02, std::sqrt(1.0 - 0.02 * 0.02));
    const Complex residue = (2.0 * 0.02 * omega * (0.3 * pole + 0.8 * omega)) / (pole - std::conj(pole));
    CHECK(error(ExtraMode().transfer(p, s), residue / (s - pole) + std::conj(residue) / (s - std::conj(pole))) < 1e-12);
  }
}

TEST_CASE("delay and sensor_lag: one start is near the time that is missing") {
  for (const double time : {20e-6, 200e-6}) {
    const Situation delayed = situation_with([time](Complex s, Complex g) { return g * std::exp(-time * s); });
    CHECK(Delay().starts(delayed).back()[0] == Approx(time).epsilon(0.05));
    const Situation lagging = situation_with([time](Complex s, Complex g) { return g / (1.0 + time * s); });
    CHECK(SensorLag().starts(lagging).back()[0] == Approx(time).epsilon(0.1));
  }
}

TEST_CASE("feed_through and extra_mode: a start is near what is missing") {
  const Situation direct = situation_with([](Complex, Complex g) { return g - 0.07; });
  CHECK(FeedThrough().starts(direct).back()[0] == Approx(-0.07));
  CHECK(FeedThrough().parameters(direct)[0].unit == "S");
  const double p[] = {60.0, 0.06, 0.2, 0.4};
  const Situation more = situation_with([&p](Complex s, Complex g) { return g + ExtraMode().transfer(p, s); });
  const std::vector<double> start = ExtraMode().starts(more).front();
  CHECK(start[0] == Approx(60.0).epsilon(0.05));
  CHECK(start[1] == Approx(0.06).epsilon(0.5));
  CHECK(start[2] == Approx(0.2).margin(0.1));
  CHECK(start[3] == Approx(0.4).margin(0.1));
}

TEST_CASE("delay and skin_effect declare each other, delay and sensor_lag are left to the data") {
  for (const Linear& t : linear_effects()) {
    const std::vector<std::string> expected = t.what.name() == "delay"         ? std::vector<std::string>{"skin_effect"}
                                              : t.what.name() == "skin_effect" ? std::vector<std::string>{"delay"}
                                                                               : std::vector<std::string>{};
    INFO(t.what.name());
    CHECK(t.what.equivalents == expected);
    CHECK(t.what.separation.empty() == expected.empty());
  }
}
