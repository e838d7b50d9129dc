#include <cmath>

#include "bases/motor_standstill.hpp"
#include "catch.hpp"
#include "declared_base.hpp"
#include "every_effect.hpp"
#include "periodic/periodic_measurement.hpp"
#include "simple_bench.hpp"
#include "trace/trace.hpp"
#include "trace/words.hpp"

using namespace bodeflow;
using namespace bodeflow::residual;
using namespace bodeflow::residual::test;

namespace {

std::shared_ptr<const BaseModel> motor(double computation_delay_s = 100e-6) {
  return declared_base<MotorStandstill>({{"computation_delay", computation_delay_s}});
}

std::shared_ptr<const Measurement> measured(const records::Recording& r, const char* name) {
  auto m = periodic_measurement(r, name, {}, *motor());
  if (!m) FAIL(m.error().text);
  return *m;
}

TraceData data_of(const bench::SimpleBench& b, std::uint64_t seed, double volt = 4.0) {
  const auto record = [&](double level, std::uint64_t n, const char* name) {
    return measured(bench::record(b, level * volt, 10 * seed + n), name);
  };
  return {{record(0.45, 1, "fit 1"), record(1.0, 2, "fit 2")}, record(0.8, 3, "select"), record(0.9, 4, "test")};
}

/// The effects of the first closed loop: the whole catalogue is for [long].
Catalogue three() {
  Catalogue some;
  for (const CatalogueEntry& e : every_effect())
    for (const char* name : {"delay", "dead_time", "saturation"})
      if (e.what.name() == name) some.push_back(e);
  return some;
}

Trace traced(const TraceData& data, const Catalogue& effects = three(), std::shared_ptr<const BaseModel> base = motor()) {
  TraceSettings settings;
  settings.known = every_description();
  auto t = trace(std::move(base), effects, data, settings);
  if (!t) FAIL(t.error().text);
  return *t;
}

std::string found(const Trace& t) {
  std::string text = word(t.verdict);
  for (const Found& f : t.searched.found) text += " " + f.addition.label;
  return text;
}

const Eigen::Vector4d kTruth(283.0287, 11.57895, 10.56518, 0.04107158);

}  // namespace

TEST_CASE("trace of a motor: a bench without anything hidden is left alone, its parameters within their deviations") {
  const Trace t = traced(data_of({}, 1));
  CHECK(found(t) == "none");
  CHECK(t.after.at_floor());
  CHECK_FALSE(t.after.leak());
  const Eigen::VectorXd values = t.searched.base.fit.values(), std = t.searched.base.fit.std();
  for (Eigen::Index i = 0; i < 4; ++i) CHECK(std::abs(values[i] - kTruth[i]) < 4 * std[i]);
}

TEST_CASE("trace of a motor: dead time is named with its voltage, and the parameters come right") {
  bench::SimpleBench b;
  b.dead_time_voltage = 6;
  const Trace t = traced(data_of(b, 2));
  REQUIRE(found(t) == "named dead_time");
  CHECK(t.searched.share > 0.99);
  CHECK(t.extended().fit.values()[4] == Approx(6).epsilon(0.01));
  CHECK(t.searched.base.fit.values()[0] > 300);  // what the missing effect did to gamma
  CHECK(t.extended().fit.values()[0] == Approx(283.03).epsilon(0.02));
  CHECK(t.before.error > 3 * t.after.error);
  CHECK(t.after.at_floor());
  CHECK(finding(t, "A").find("Missing effect: dead time of the inverter, ") == 0);
}

TEST_CASE("trace of a motor: a delay is found, and declared not to be told from a skin effect") {
  bench::SimpleBench b;
  b.delay_s = 150e-6;
  const Trace t = traced(data_of(b, 3));
  REQUIRE(found(t) == "not_separable delay");
  CHECK(t.searched.found.front().equivalents == std::vector<std::string>{"skin_effect"});
  CHECK(std::abs(t.extended().fit.values()[4] - 150e-6) < 4 * t.extended().fit.std()[4]);
  CHECK(t.after.at_floor());
}

TEST_CASE("trace of a motor: saturation is named, though its law is another one than the candidate's") {
  bench::SimpleBench b;
  b.saturation_current = 1.2;
  const Trace t = traced(data_of(b, 4));
  REQUIRE(found(t) == "named saturation");
  CHECK(t.after.at_floor());
  CHECK(t.extended().fit.values()[1] == Approx(11.579).epsilon(0.05));
}

TEST_CASE("trace of a motor: what no effect of the catalogue explains is not given a name") {
  bench::SimpleBench b;
  b.dead_time_voltage = 6;
  Catalogue without = three();
  without.erase(std::remove_if(without.begin(), without.end(), [](const auto& e) { return e.what.name() == "dead_time"; }),
                without.end());
  const Trace t = traced(data_of(b, 5), without);
  CHECK(t.verdict == Verdict::unexplained);
  CHECK(t.before.error == t.after.error);
  CHECK(finding(t, "A").find("Something is missing that none of the known effects explains (excited lines ") == 0);
}

TEST_CASE("trace of a motor: a delay that is not declared is a finding, the same one declared is none") {
  bench::SimpleBench b;
  b.computation_delay_s = 200e-6;
  const TraceData data = data_of(b, 7);
  CHECK(traced(data).verdict == Verdict::not_separable);
  CHECK(found(traced(data, three(), motor(200e-6))) == "none");
}

TEST_CASE("trace of a motor: with the whole catalogue each effect keeps its name, and two at once are both named", "[long]") {
  const Catalogue all = every_effect();
  CHECK(found(traced(data_of({}, 31), all)) == "none");
  bench::SimpleBench dead_time;
  dead_time.dead_time_voltage = 6;
  CHECK(traced(data_of(dead_time, 32), all).searched.found.front().addition.name() == "dead_time");
  bench::SimpleBench late = dead_time;
  late.delay_s = 150e-6;
  const Trace both = traced(data_of(late, 33), all);
  CHECK(both.searched.found.size() == 2);
  CHECK(both.after.at_floor());
}

TEST_CASE("trace of a motor: leave one out, and the rest finds the declared twin or says that it can't name it", "[long]") {
  bench::SimpleBench b;
  b.dead_time_voltage = 6;
  CHECK(traced(data_of(b, 34), every_effect({"dead_time"})).verdict == Verdict::unexplained);
}
