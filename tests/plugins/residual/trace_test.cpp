#include "trace.hpp"

#include <cmath>

#include "catch.hpp"
#include "motor_standstill.hpp"
#include "simple_bench.hpp"
#include "trace_words.hpp"

using namespace bodeflow;
using namespace bodeflow::residual;

namespace {

const MotorStandstill kModel(MotorInput::command, 100e-6);

TraceData data_of(const bench::SimpleBench& b, std::uint64_t seed, double volt = 4.0) {
  const auto experiment = [&](double level, std::uint64_t n, const char* name) {
    return experiment_of(bench::record(b, level * volt, 10 * seed + n), name).value();
  };
  return {{experiment(0.45, 1, "fit 1"), experiment(1.0, 2, "fit 2")}, experiment(0.8, 3, "select"), experiment(0.9, 4, "test")};
}

const Catalogue kAll = catalogue().value();

Trace traced(const TraceData& data, const Catalogue& effects = kAll) { return trace(kModel, effects, data, {}).value(); }

/// What the record of a bench has that no effect of the catalogue makes: a share of the square of the current.
void add_even(records::Recording& r, double share) {
  for (Eigen::Index n = 0; n < r.samples(); ++n) r.output(n, 0) += share * r.output(n, 0) * r.output(n, 0);
}

}  // namespace

TEST_CASE("trace: a bench without anything hidden is left alone, its parameters within their deviations") {
  const Trace t = traced(data_of({}, 1));
  CHECK(t.verdict == Verdict::none);
  CHECK_FALSE(t.found);
  CHECK(t.after.at_floor());
  CHECK_FALSE(t.after.leak());
  const Eigen::Vector4d truth(283.0287, 11.57895, 10.56518, 0.04107158);
  for (Eigen::Index i = 0; i < 4; ++i) CHECK(std::abs(t.base.fit.values[i] - truth[i]) < 4 * t.base.fit.std[i]);
}

TEST_CASE("trace: dead time is named with its voltage, and the parameters come right") {
  bench::SimpleBench b;
  b.dead_time_voltage = 6;
  const Trace t = traced(data_of(b, 2));
  REQUIRE(t.verdict == Verdict::named);
  CHECK(t.candidates[0].name == "dead_time");
  CHECK(t.candidates[0].share > 0.99);
  CHECK(t.candidates[0].with.fit.values[4] == Approx(6).epsilon(0.01));
  CHECK(t.base.fit.values[0] > 300);  // what the missing effect did to gamma
  CHECK(t.extended().fit.values[0] == Approx(283.03).epsilon(0.02));
  CHECK(t.before.error > 3 * t.after.error);
  CHECK(t.after.at_floor());
  CHECK(finding(t, "A").find("Missing effect: dead time of the inverter, ") == 0);
}

TEST_CASE("trace: a delay is found, and declared not to be told from a skin effect") {
  bench::SimpleBench b;
  b.delay_s = 150e-6;
  const Trace t = traced(data_of(b, 3));
  REQUIRE(t.verdict == Verdict::not_separable);
  CHECK(t.candidates[0].name == "delay");
  CHECK(t.equivalents == std::vector<std::string>{"skin_effect"});
  CHECK(std::abs(t.candidates[0].with.fit.values[4] - 150e-6) < 4 * t.candidates[0].with.fit.std[4]);
  CHECK(t.after.at_floor());
}

TEST_CASE("trace: saturation is named, though its law is another one than the candidate's") {
  bench::SimpleBench b;
  b.saturation_current = 1.2;
  const Trace t = traced(data_of(b, 4));
  REQUIRE(t.verdict == Verdict::named);
  CHECK(t.candidates[0].name == "saturation");
  CHECK(t.after.at_floor());
  CHECK(t.extended().fit.values[1] == Approx(11.579).epsilon(0.05));
}

TEST_CASE("trace: what no effect of the catalogue explains is not given a name") {
  SECTION("the true effect is left out of the catalogue") {
    bench::SimpleBench b;
    b.dead_time_voltage = 6;
    const Catalogue without = catalogue({"delay", "saturation"}).value();
    const Trace t = traced(data_of(b, 5), without);
    CHECK(t.verdict == Verdict::unexplained);
    CHECK_FALSE(t.found);
    CHECK(t.before.error == t.after.error);
    CHECK(finding(t, "A").find("Something is missing that none of the known effects explains (excited lines ") == 0);
  }
  SECTION("a sensor that is bent to one side") {
    TraceData data = data_of({}, 6);
    const auto bent = [](double level, std::uint64_t seed, const char* name) {
      auto r = bench::record({}, 4.0 * level, seed);
      add_even(r, 0.01);
      return experiment_of(r, name).value();
    };
    data = {{bent(0.45, 61, "fit 1"), bent(1, 62, "fit 2")}, bent(0.8, 63, "select"), bent(0.9, 64, "test")};
    const Trace t = traced(data);
    CHECK(t.verdict == Verdict::unexplained);
    CHECK(remainder(t).find("even lines") != std::string::npos);
  }
}

TEST_CASE("trace: a declared delay that is not declared is a finding, the same one declared is none") {
  bench::SimpleBench b;
  b.computation_delay_s = 200e-6;
  const TraceData data = data_of(b, 7);
  CHECK(traced(data).verdict == Verdict::not_separable);
  const MotorStandstill declared(MotorInput::command, 200e-6);
  CHECK(trace(declared, kAll, data, {}).value().verdict == Verdict::none);
}

TEST_CASE("trace: records that were fitted may not select or test, nor may the two be the same") {
  const TraceData good = data_of({}, 8);
  const auto refusal = [](const TraceData& data) { return trace(kModel, kAll, data, {}).error().text; };
  TraceData bad = good;
  bad.select = good.fit[1];
  CHECK(refusal(bad) == "the records 'fit 2' and 'fit 2' hold the same samples; one of them must not be fitted");
  bad = good;
  bad.test = good.select;
  CHECK(refusal(bad) == "the records 'select' and 'test' hold the same samples");
  bad = good;
  bad.test.sample_rate_hz = 2000;
  CHECK(refusal(bad) == "record 'test' has 2000 samples a second, record 'fit 1' 1000; allowed: the same");
  bad = good;
  bad.fit.clear();
  CHECK(refusal(bad) == "no record to fit");
}

TEST_CASE("trace: levels follow from the probability of a false alarm") {
  const Levels l = Levels::of(0.01, 0.97, 18, 3);
  CHECK(l.p_class == Approx(0.005 / 18));
  CHECK(l.p_candidate == Approx(0.005 / 3));
  CHECK(l.select_gain == Approx(8.615).epsilon(1e-3));  // 2.935^2
}

TEST_CASE("held-out error: on noise alone it is at the floor, below it it is a leak") {
  const Experiment e = experiment_of(bench::record({}, 4.0, 5), "x").value();
  const Eigen::VectorXcd right = kModel.steady_state(e, Eigen::Vector4d(283.0287, 11.57895, 10.56518, 0.04107158), {});
  const HeldOutError h = held_out_error(e, right);
  CHECK(h.at_floor());
  CHECK_FALSE(h.leak());
  CHECK(h.floor == Approx(0.1 * std::sqrt(2.0 * static_cast<double>(e.lines()) / (4096.0 * 6.0))).epsilon(0.05));
  CHECK(h.highest / h.floor < 1.08);
  const HeldOutError copied = held_out_error(e, right + 0.2 * (e.output - right));
  CHECK(copied.leak());
  CHECK(copied.excess() == 0.0);
}
