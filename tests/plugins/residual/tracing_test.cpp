#include <algorithm>
#include <cmath>

#include "catch.hpp"
#include "fake_measurement.hpp"
#include "trace/trace.hpp"
#include "trace/words.hpp"

using namespace bodeflow;
using namespace bodeflow::residual;
using namespace bodeflow::residual::test;

namespace {

double line(double n, double) { return n / 300.0; }
double wave(double n, double) { return std::sin(0.2 * n); }
double cubic(double n, double level) { return level * level * level * std::cos(0.61 * n); }
double constant(double, double) { return 1.0; }

CatalogueEntry bump(double least = 0.0) {
  return fake_effect({"bump",
                      {real("bump_size", "A", 1.0).between(least, 1e9), real("bump_at", "s", 30.0).between(0.0, 300.0)},
                      {{0.5, 60.0}, {0.5, 150.0}, {0.5, 240.0}},
                      [](const double* p, double n, double) { return p[0] * std::exp(-std::pow((n - p[1]) / 12.0, 2)); }});
}

Catalogue catalogue() {
  return {one_sided("trend", line), one_sided("ripple", wave), one_sided("cubic", cubic), one_sided("offset", constant), bump()};
}

using Hidden = std::function<double(double, double)>;

TraceData records(const Hidden& hidden, std::uint64_t seed, bool floor_known = true) {
  FakeRecord r;
  r.floor_known = floor_known;
  TraceData d;
  const double levels[] = {0.5, 1.0, 0.8, 0.9};
  const char* names[] = {"fit 1", "fit 2", "select", "test"};
  for (int n = 0; n < 4; ++n) {
    r.name = names[n];
    r.level = levels[n];
    r.seed = 10 * seed + static_cast<std::uint64_t>(n);
    auto m = measure(r, hidden);
    if (n < 2) d.fit.push_back(m);
    if (n == 2) d.select = m;
    if (n == 3) d.test = m;
  }
  return d;
}

Trace traced(const Hidden& hidden, std::uint64_t seed, const Catalogue& effects = catalogue(), bool floor_known = true,
             TraceSettings settings = {}) {
  auto t = trace(std::make_shared<FakeBase>(), effects, records(hidden, seed, floor_known), settings);
  if (!t) FAIL(t.error().text);
  return *t;
}

std::vector<std::string> names(const Trace& t) {
  std::vector<std::string> all;
  for (const Found& f : t.searched.found) all.push_back(f.addition.label);
  std::sort(all.begin(), all.end());
  return all;
}

/// Kolmogorov-Smirnov: the probability of so great a distance from the uniform distribution.
double uniformity(std::vector<double> p) {
  std::sort(p.begin(), p.end());
  double distance = 0.0;
  const auto n = static_cast<double>(p.size());
  for (std::size_t i = 0; i < p.size(); ++i)
    distance = std::max({distance, p[i] - static_cast<double>(i) / n, static_cast<double>(i + 1) / n - p[i]});
  const double x = (std::sqrt(n) + 0.12 + 0.11 / std::sqrt(n)) * distance;
  double sum = 0.0;
  for (int k = 1; k < 100; ++k) sum += (k % 2 == 1 ? 2.0 : -2.0) * std::exp(-2.0 * k * k * x * x);
  return std::min(std::max(sum, 0.0), 1.0);
}

}  // namespace

TEST_CASE("tracing: one effect is named with its size, and the error falls to the noise") {
  const Trace t = traced([](double n, double l) { return 1.6 * wave(n, l); }, 1);
  REQUIRE(t.verdict == Verdict::named);
  REQUIRE(names(t) == std::vector<std::string>{"ripple"});
  const Candidate& c = t.searched.steps.front().candidates.front();
  CHECK(std::abs(c.values()[0] - 1.6) < 4.0 * c.std()[0]);
  CHECK(c.std()[0] == Approx(std::sqrt(2.0 / 600.0)).epsilon(0.05));  // a sinusoid over 600 rows
  CHECK(t.before.error > t.before.highest);
  CHECK(t.after.at_floor());
  CHECK_FALSE(t.after.leak());
  CHECK(t.searched.share > 0.9);
}

TEST_CASE("tracing: where nothing is missing nothing is named") {
  const Trace t = traced({}, 2);
  CHECK(t.verdict == Verdict::none);
  CHECK(t.searched.found.empty());
  CHECK(t.before.error == t.after.error);
  CHECK(t.p > 0.01);
}

TEST_CASE("tracing: two and three effects together are all found, in any order") {
  CHECK(names(traced([](double n, double l) { return 0.8 * wave(n, l) + 0.6; }, 3)) ==
        std::vector<std::string>{"offset", "ripple"});
  CHECK(names(traced([](double n, double l) { return 1.6 * wave(n, l) + 3.0 * line(n, l) + 2.5 * cubic(n, l); }, 4)) ==
        std::vector<std::string>{"cubic", "ripple", "trend"});
}

TEST_CASE("tracing: an offset and a trend that hide each other are told apart") {
  // Their shapes share three quarters of their power: each alone explains a great part of both.
  const Trace t = traced([](double n, double l) { return 1.4 + 2.4 * line(n, l); }, 5);
  CHECK(t.verdict == Verdict::named);
  CHECK(names(t) == std::vector<std::string>{"offset", "trend"});
}

TEST_CASE("tracing: what is not in the catalogue is unexplained, and the error of the base is told") {
  const Catalogue some = {one_sided("trend", line), one_sided("cubic", cubic), one_sided("offset", constant)};
  const Trace t = traced([](double n, double l) { return 0.8 * wave(n, l); }, 6, some);
  CHECK(t.verdict == Verdict::unexplained);
  CHECK(t.after.error == t.before.error);
}

TEST_CASE("tracing: an effect with the wrong sign is not physical and not named") {
  const Catalogue some = {one_sided("ripple", wave)};
  const Trace t = traced([](double n, double l) { return -0.8 * wave(n, l); }, 7, some);
  CHECK(t.verdict == Verdict::unexplained);
  CHECK(t.searched.steps.front().candidates.front().reason == "not physical: ripple_size would be below 0 A");
}

TEST_CASE("tracing: two names for the same law are not separable") {
  Catalogue twins = catalogue();
  twins.push_back(one_sided("wavelet", [](double n, double) { return std::sin(0.2 * n) + 0.02 * std::cos(0.7 * n); }));
  const Trace t = traced([](double n, double l) { return 0.8 * wave(n, l); }, 8, twins);
  CHECK(t.verdict == Verdict::not_separable);
  CHECK(t.searched.found.front().equivalents.size() == 1);
  CHECK_FALSE(t.searched.found.front().separation.empty());
}

TEST_CASE("tracing: a second name for the second of two effects has a reason why it was not taken") {
  Catalogue twins = catalogue();
  twins.push_back(one_sided("wavelet", [](double n, double) { return std::sin(0.2 * n) + 0.02 * std::cos(0.7 * n); }));
  const Trace t = traced([](double n, double l) { return 0.8 * wave(n, l) + 0.9; }, 9, twins);
  REQUIRE(t.searched.found.size() == 2);
  bool told = false;
  for (const Step& step : t.searched.steps) {
    for (const Candidate& c : step.candidates) {
      CHECK_FALSE(c.reason.empty());
      told = told || c.reason.find("explains it too, ") == 0;
    }
  }
  CHECK(told);
}

TEST_CASE("tracing: a declared equivalent is told where the base has a place for it, tried or not") {
  TraceSettings settings;
  FakeLaw law{
      "ripple", {real("ripple_size", "A", 1.0)}, {{0.0}}, [](const double* p, double n, double l) { return p[0] * wave(n, l); }};
  law.equivalents = {"elsewhere", "skin"};
  EffectDescription skin, elsewhere;
  skin.id = "residual.skin";
  skin.acts = Acts::immittance;
  skin.kinds = {"winding"};
  elsewhere.id = "residual.elsewhere";
  elsewhere.acts = Acts::law;
  elsewhere.kinds = {"tank"};
  settings.known = {skin, elsewhere};
  Place winding;
  winding.name = "stator";
  winding.kind = "winding";
  const auto base = std::make_shared<FakeBase>(std::vector<Place>{winding});
  const auto t = trace(base, {fake_effect(law)}, records([](double n, double l) { return 0.8 * wave(n, l); }, 9), settings);
  REQUIRE(t);
  CHECK(t->verdict == Verdict::not_separable);
  CHECK(t->searched.found.front().equivalents == std::vector<std::string>{"skin"});
}

TEST_CASE("tracing: effects of places that the base does not have, and those that refuse, are told with the reason") {
  Catalogue all = {one_sided("ripple", wave), one_sided("cubic", cubic), one_sided("offset", constant)};
  all[0].what.acts = Acts::law;
  all[0].what.kinds = {"bearing", "spring"};
  all[1] = fake_effect(
      {"cubic", {real("size", "A", 1.0)}, {{0.0}}, [](const double*, double, double) { return 0.0; }, {}, "too quiet"});
  const Trace t = traced({}, 10, all);
  REQUIRE(t.searched.refused.size() == 2);
  CHECK(t.searched.refused[0].refusal == "acts inside the plant, of which this base model knows input and output alone");
  CHECK(t.searched.refused[1].refusal == "too quiet");
  CHECK(t.searched.steps.front().candidates.size() == 1);
}

TEST_CASE("tracing: with an unknown floor the effects are named one after the other, and nothing once they gain less than 2 %") {
  const Trace t = traced([](double n, double l) { return 3.0 * wave(n, l) + 1.5; }, 11, catalogue(), false);
  CHECK(t.verdict == Verdict::named);
  CHECK(names(t) == std::vector<std::string>{"offset", "ripple"});
  CHECK_FALSE(t.after.floor_known());
  CHECK(t.after.error == Approx(1.0).epsilon(0.15));
}

TEST_CASE("tracing: parameters that each record has for itself are fitted in every record") {
  FakeLaw law{"own", {real("own_size", "A", 1.0).own_in_each_record()}, {{0.0}}, [](const double* p, double n, double l) {
                return p[0] * wave(n, l);
              }};
  const Catalogue own = {fake_effect(law)};
  const Trace t = traced([](double n, double l) { return (l > 0.85 ? 1.0 : -0.7) * wave(n, l); }, 12, own);
  CHECK(t.verdict == Verdict::named);
  CHECK(t.after.at_floor());
  const Candidate& c = t.searched.steps.front().candidates.front();
  CHECK(c.null.freedom == 2.0);
  CHECK(c.values(0)[0] == Approx(-0.7).margin(0.3));
  CHECK(c.values(1)[0] == Approx(1.0).margin(0.3));
}

TEST_CASE("tracing: records that do not belong together are refused by name") {
  const auto refusal = [](TraceData d) {
    const auto t = trace(std::make_shared<FakeBase>(), catalogue(), d, {});
    return t ? std::string() : t.error().text;
  };
  TraceData d = records({}, 13);
  FakeRecord other;
  other.name = "select";
  other.unit = "mA";
  d.select = measure(other);
  CHECK(refusal(d) == "record 'select' is in V and mA, record 'fit 1' in V and A; allowed: the same");
  other.unit = "A";
  other.sample_rate_hz = 50.0;
  d.select = measure(other);
  CHECK(refusal(d) == "record 'select' has 50 samples a second, record 'fit 1' 100; allowed: the same");
  d.select = d.test;
  CHECK(refusal(d) == "the records 'select' and 'test' hold the same samples");
  d = records({}, 13);
  d.test = d.fit[1];
  CHECK(refusal(d) == "the records 'fit 2' and 'fit 2' hold the same samples; one of them must not be fitted");
  d = records({}, 13);
  d.fit.push_back(d.fit[0]);
  CHECK(refusal(d) ==
        "the records 'fit 1' and 'fit 1' hold the same samples; fitted twice they would seem to say more than they do");
  d.fit.clear();
  CHECK(refusal(d) == "no record to fit");
}

TEST_CASE("tracing: the p of an effect that is not there is uniform, bound, search over an instant and all") {
  const Catalogue all = {bump(-1e9), one_sided("ripple", wave)};
  std::vector<double> of_bump, of_ripple;
  for (std::uint64_t seed = 100; seed < 160; ++seed) {
    const Trace t = traced({}, seed, all);
    for (const Candidate& c : t.searched.steps.front().candidates) {
      if (c.label == "bump") of_bump.push_back(c.p);
      if (c.label == "ripple") of_ripple.push_back(c.p);
    }
  }
  CHECK(uniformity(of_bump) > 0.001);
  CHECK(uniformity(of_ripple) > 0.001);
}

TEST_CASE("tracing: levels that differ from record to record are not called by an effect that has a rate beside them") {
  FakeLaw law{"runaway",
              {real("rate", "A", 1.0), real("level", "A", 1.0).own_in_each_record()},
              {{0.0, 0.5}},
              [](const double* p, double n, double) { return p[0] * line(n, 1.0) + p[1]; }};
  const Catalogue one = {fake_effect(law)};
  const Trace levels = traced([](double, double l) { return l > 0.85 ? 1.0 : -0.7; }, 15, one);
  CHECK(levels.verdict == Verdict::unexplained);
  CHECK(levels.searched.steps.front().candidates.front().reason ==
        "rate can't be told from 0: all it explains are levels that differ from record to record");
  const Trace rate = traced([](double n, double l) { return 2.0 * line(n, l) + (l > 0.85 ? 1.0 : -0.7); }, 15, one);
  CHECK(names(rate) == std::vector<std::string>{"runaway"});
}

TEST_CASE("tracing: what does not lower the error on the test record is not named") {
  const auto hidden = [](double n, double l) { return 0.8 * wave(n, l); };
  TraceData d = records(hidden, 16);
  FakeRecord without;
  without.name = "test";
  without.level = 0.9;
  without.seed = 163;
  d.test = measure(without);
  const Trace t = trace(std::make_shared<FakeBase>(), catalogue(), d, {}).value();
  CHECK(names(t) == std::vector<std::string>{"ripple"});
  CHECK(t.verdict == Verdict::unexplained);
  CHECK(finding(t, "A").find("The nearest is ripple, but with it the error on data not used at all does not fall.") !=
        std::string::npos);
}

TEST_CASE("tracing: a class that could not be tested has not passed") {
  Examined x;
  x.tests = {{"fit 1", {{"excited", 1.0, 0.4}, {"odd", std::nan(""), 1.0}}}};
  CHECK(x.smallest_p() == 0.0);
  x.tests = {{"fit 1", {{"excited", 1.0, 0.4}, {"odd", 1.1, 0.2}}}};
  CHECK(x.smallest_p() == 0.2);
}

TEST_CASE("tracing: the same bits for the same records") {
  const auto hidden = [](double n, double l) { return 0.8 * wave(n, l) + 0.6; };
  const Trace a = traced(hidden, 14), b = traced(hidden, 14);
  CHECK(a.searched.best.fit.at == b.searched.best.fit.at);
  CHECK(a.p == b.p);
}

TEST_CASE("tracing: one clean case of a hundred at most holds a finding, and small effects get no wrong name", "[long]") {
  int found = 0, wrong = 0;
  std::vector<double> p;
  for (std::uint64_t seed = 1000; seed < 1400; ++seed) {
    const Trace clean = traced({}, seed);
    found += clean.verdict != Verdict::none;
    p.push_back(clean.p);
    const double size = 0.02 * static_cast<double>(seed - 1000) / 40.0;
    const Trace small = traced([size](double n, double l) { return size * wave(n, l); }, seed);
    if (small.verdict == Verdict::named) wrong += names(small) != std::vector<std::string>{"ripple"};
  }
  CHECK(found <= 8);
  CHECK(wrong <= 4);
  CHECK(uniformity(p) > 0.001);
}
