#include "blocks/given_records.hpp"

#include "bases/impedance.hpp"
#include "bases/motor_standstill.hpp"
#include "catch.hpp"
#include "declared_base.hpp"
#include "plugins/block_driver.hpp"
#include "simple_bench.hpp"

using namespace bodeflow;
using namespace bodeflow::residual;
using bodeflow::test::failure_of;

namespace {

records::Recording plain(Eigen::Index samples) {
  records::Recording r;
  r.sample_rate_hz = 1000.0;
  r.input_signals = {{"u"}, {"V"}};
  r.output_signals = {{"y"}, {"A"}};
  r.input = Eigen::MatrixXd::Random(samples, 1);
  r.output = Eigen::MatrixXd::Random(samples, 1);
  return r;
}

const records::Recording& recording_in(const Given& g) { return std::get<records::Recording>(g); }

GivenRecords only_fit(std::vector<Given> fit) {
  GivenRecords g;
  g.fit = std::move(fit);
  return g;
}

}  // namespace

TEST_CASE("given records: of many the last ones are held out whole") {
  const auto g = with_all_parts(only_fit({plain(900), plain(901), plain(902), plain(903)}), Engine::sampled).value();
  REQUIRE(g.fit.size() == 2);
  CHECK(recording_in(*g.test).samples() == 903);
  CHECK(recording_in(*g.select).samples() == 902);
  CHECK(g.notes == std::vector<std::string>{"record 'fit 4' is not fitted but serves as 'test'",
                                            "record 'fit 3' is not fitted but serves as 'select'"});
}

TEST_CASE("given records: one record alone is split in time, the order kept and nothing used twice") {
  const records::Recording whole = plain(1000);
  const auto g = with_all_parts(only_fit({whole}), Engine::sampled).value();
  REQUIRE(recording_in(g.fit[0]).samples() == 500);
  REQUIRE(recording_in(*g.select).samples() == 250);
  REQUIRE(recording_in(*g.test).samples() == 250);
  CHECK(recording_in(*g.select).output(0, 0) == whole.output(500, 0));
  CHECK(recording_in(*g.test).output(249, 0) == whole.output(999, 0));
  CHECK(g.notes.front() == "record 'select' is a quarter of the samples at its end of record 'fit 1'");
  CHECK(with_all_parts(only_fit({plain(500)}), Engine::sampled).error().text ==
        "record 'fit 1': the recording has 500 samples, allowed: 600 or more where it is split; give records of their own at "
        "'select' and 'test'");
}

TEST_CASE("given records: of a very long one over time the middle is looked at, and the whole tells the error") {
  records::Recording whole = plain(200000), test = plain(140000);
  GivenRecords given = only_fit({whole});
  given.select = plain(300);
  given.test = test;
  const auto g = with_all_parts(given, Engine::sampled).value();
  REQUIRE(recording_in(g.fit[0]).samples() == 131072);
  CHECK(recording_in(g.fit[0]).output(0, 0) == whole.output((200000 - 131072) / 2, 0));
  CHECK(recording_in(*g.select).samples() == 300);
  CHECK(recording_in(*g.test).samples() == 140000);
  CHECK(g.notes ==
        std::vector<std::string>{"record 'fit 1' has 200000 samples, of which the 131072 in its middle are looked at"});
}

TEST_CASE("given records: units that the base model can't have are refused where they are given") {
  const auto motor = declared_base<MotorStandstill>();
  GivenRecords given = only_fit({bench::record({}, 4.0, 1, 2)});
  given.select = bench::record({}, 4.0, 2, 2);
  given.test = bench::record({}, 4.0, 3, 2);
  auto foreign = recording_in(given.fit[0]);
  foreign.input_signals.units = {"N"};
  foreign.output_signals.units = {"m"};
  const std::string in = foreign.input_signals.names[0], out = foreign.output_signals.names[0];
  given.fit[0] = foreign;
  CHECK(measurements_of(given, Engine::periodic, *motor, {}).error().text ==
        "record 'fit 1': '" + out + "' is in m and '" + in +
            "' in N; the base model needs output over input in S: check the signals and what is declared");
  for (const char* unit : {"", "1"}) {
    foreign.output_signals.units = {unit};
    given.fit[0] = foreign;
    CHECK(measurements_of(given, Engine::periodic, *motor, {}));
  }
}

TEST_CASE("given records: the one that tells the error may be cut in segments of its own") {
  GivenRecords given = only_fit({bench::record({}, 4.0, 1, 2)});
  given.select = bench::record({}, 4.0, 2, 2);
  given.test = bench::record({}, 4.0, 3, 2);
  const Eigen::Index samples = recording_in(*given.test).samples();
  const auto motor = declared_base<MotorStandstill>();
  const auto alike = measurements_of(given, Engine::sampled, *motor, {}).value();
  CHECK(alike.test->rows() < samples);  // the first ones determine the state
  const auto data = measurements_of(given, Engine::sampled, *motor, {}, 0.0, 0.5).value();
  CHECK(data.fit[0]->rows() == alike.fit[0]->rows());
  CHECK(data.test->rows() == samples);  // all count, and each segment has a state
}

TEST_CASE("given records: a periodic one is split by whole periods, the skipped ones left out") {
  const records::Recording whole = bench::record({}, 4.0, 1, 7);
  const auto g = with_all_parts(only_fit({whole}), Engine::periodic).value();
  CHECK(recording_in(g.fit[0]).periods == 3);
  CHECK(recording_in(g.fit[0]).skip == 0);
  CHECK(recording_in(g.fit[0]).output(0, 0) == whole.output(4096, 0));
  CHECK(recording_in(*g.test).periods == 2);
  CHECK(recording_in(*g.test).output(2 * 4096 - 1, 0) == whole.output(8 * 4096 - 1, 0));
  CHECK(
      with_all_parts(only_fit({bench::record({}, 4.0, 1, 5)}), Engine::periodic).error().text ==
      "record 'fit 1': the recording has 5 periods, allowed: 6 or more where it is split; give records of their own at 'select' "
      "and 'test'");
}

TEST_CASE("given records: periodic where all repeat a period, else over time") {
  const Given periodic = bench::record({}, 4.0, 1, 2), single = bench::record({}, 4.0, 1, 1), none = plain(600);
  CHECK(engine_for(only_fit({periodic}), Engine::automatic) == Engine::periodic);
  CHECK(engine_for(only_fit({periodic, single}), Engine::automatic) == Engine::sampled);
  CHECK(engine_for(only_fit({periodic, none}), Engine::automatic) == Engine::sampled);
  CHECK(engine_for(only_fit({none}), Engine::periodic) == Engine::periodic);
}

TEST_CASE("given records: what is known of a record is read with its unit and refused by name") {
  const auto base = declared_base<Impedance>();
  records::ResponseData r;
  r.input_names = {"i"};
  r.output_names = {"u"};
  r.response_units = {"ohm"};
  r.frequency_hz = Eigen::VectorXd::LinSpaced(200, 10.0, 2000.0);
  r.response = Eigen::MatrixXcd::Constant(200, 1, 3.2);
  for (Eigen::Index k = 0; k < 200; ++k) r.response(k, 0) += std::complex<double>(0.001, 0.02) * static_cast<double>(k);
  GivenRecords g = only_fit({r});
  r.response *= 1.01;
  g.select = r;
  r.response *= 1.01;
  g.test = r;
  const auto refusal = [&](const char* statement) {
    return failure_of([&] { measurements_of(g, Engine::periodic, *base, {statement}).value(); });
  };
  const auto data = measurements_of(g, Engine::periodic, *base, {"fit 1: added_mass = 8 g"});
  REQUIRE(data);
  CHECK(data->fit[0]->facts().known.at(0) == Approx(0.008));
  CHECK(data->select->facts().known.at(0) == 0.0);
  CHECK(refusal("added_mass = 8 g") == "known: 'added_mass = 8 g' has not the form record: name=value");
  CHECK(refusal("fit 2: added_mass = 8 g") == "known: there is no record 'fit 2'; there are: fit 1, select, test");
  CHECK(refusal("test: mass = 8 g").find("known of 'test' declares no 'mass'") == 0);
}
