#include <bodeflow/record.hpp>

#include "bench.hpp"
#include "catch.hpp"
#include "execute/change.hpp"

namespace bodeflow::test {
namespace {

using execute::Outcome;

TEST_CASE("changes: a scheduled change takes effect at the first sample that is not before its time") {
  for (const auto& [time_s, sample] :
       {std::pair<double, std::size_t>{0.1, 100}, {0.1001, 101}, {0.0, 0}, {0.3, 300}, {0.4999, 500}}) {
    Bench bench;
    bench.add("count", "streams.counter");
    bench.add("gain", "streams.gain", {{"gain", 1.0}});
    bench.connect("count", "gain");
    bench.schedule(time_s, "gain", "gain", -2.0);
    bench.duration(0.6);
    for (const Cut& cut : {Cut{1024, 1, 0, 0}, Cut{64, 2, 3, 0}, Cut{1, 1, 0, 0}}) {
      const Result result = bench.run(cut);
      REQUIRE(result.outcome.status == Outcome::Status::complete);
      for (std::size_t n = 0; n < 600; ++n) {
        const double x = static_cast<double>(n);
        CHECK(result.stream("gain.out")[n] == (n < sample ? x : -2.0 * x));
      }
      REQUIRE(result.changes.at("gain").size() == 1);
      CHECK(result.changes.at("gain")[0].position == sample);
      CHECK(result.changes.at("gain")[0].parameter == "gain");
      CHECK(result.changes.at("gain")[0].value.numbers == std::vector<double>{-2.0});
    }
  }
}

TEST_CASE("changes: a change after the end of the run has no effect") {
  Bench bench;
  bench.add("count", "streams.counter");
  bench.add("gain", "streams.gain");
  bench.add("relay", "messages.relay");
  bench.connect("count", "gain");
  bench.schedule(0.1, "gain", "gain", 2.0);
  bench.schedule(0.05, "relay", "factor", 3.0);
  bench.schedule(0.2, "relay", "factor", 4.0);
  bench.duration(0.1);
  const Result result = bench.run({30, 1, 0, 0});
  CHECK(result.outcome.status == Outcome::Status::complete);
  CHECK(result.changes.count("gain") == 0);
  REQUIRE(result.changes.at("relay").size() == 1);
  CHECK(result.changes.at("relay")[0].value.numbers == std::vector<double>{3.0});
}

TEST_CASE("changes: records change parameters of every kind, in a loop too") {
  Bench bench;
  bench.add("count", "streams.counter");
  bench.add("pulse", "messages.pulse", {{"rate", 10.0}});
  bench.add("tuner", "messages.tuner", {{"base", 2.0}, {"slope", 1.0}});
  bench.add("gain", "streams.gain");
  bench.add("sum", "streams.sum");
  bench.add("back", "streams.pole", {{"pole", 0.0}, {"delay", std::int64_t{1}}});
  bench.connect("count", "sum.in");
  bench.connect("back", "sum.feedback");
  bench.connect("sum", "gain");
  bench.connect("gain", "back");
  bench.tell("pulse", "tuner");
  bench.tell("tuner", "gain.parameters", after_samples(2));
  bench.duration(0.3);
  const Result result = bench.run({64, 2, 0, 0});
  INFO(result.outcome.reason);
  REQUIRE(result.outcome.status == Outcome::Status::complete);
  double gain = 1.0, y = 0.0;
  for (std::size_t n = 0; n < 300; ++n) {
    if (n % 100 == 2) gain = 2.0 + static_cast<double>(n / 100);
    y = gain * (static_cast<double>(n) - y) + 0.0;
    REQUIRE(result.stream("gain.out")[n] == y);
  }
  REQUIRE(result.changes.at("gain").size() == 3);
  CHECK(result.changes.at("gain")[2].position == 202);
}

TEST_CASE("changes: a record that asks for what can't be ends the run, with what was found and what is allowed") {
  const std::vector<std::tuple<std::string, std::string, double, std::string>> cases = {
      {"gian", "number", 1.0,
       "parameter_change: unknown parameter 'gian' (did you mean 'gain'?); live parameters: gain, offset, steps, mode, on, list"},
      {"fixed", "number", 1.0,
       "parameter_change: parameter 'fixed' can't change while running; live parameters: gain, offset, steps, mode, on, list"},
      {"gain", "text", 1.0, "parameter_change: parameter 'gain': found 'word', allowed a number"},
      {"gain", "list", 1.0, "parameter_change: parameter 'gain': found [1, 1], allowed a number"},
      {"gain", "none", 1.0, "parameter_change of 'gain': the record has no 'value'"},
      {"gain", "other", 1.0, "found a record of type 'number' for its parameters, allowed 'parameter_change'"},
      {"gain", "number", 101.0, "parameter_change: parameter 'gain': found 101, allowed -100 to 100"},
      {"steps", "number", 2.0, "parameter_change: parameter 'steps': found 2, allowed an integer"},
      {"steps", "integer", 9.0, "parameter_change: parameter 'steps': found 9, allowed 0 to 8"},
      {"mode", "text", 0.0, "parameter_change: parameter 'mode': found 'word', allowed plain, negated"},
      {"on", "integer", 1.0, "parameter_change: parameter 'on': found 1, allowed a bool"},
      {"list", "number", 1.0, "parameter_change: parameter 'list': found 1, allowed a list of numbers"},
  };
  for (const auto& [parameter, kind, base, message] : cases) {
    Bench bench;
    bench.add("count", "streams.counter");
    bench.add("pulse", "messages.pulse", {{"rate", 10.0}});
    bench.add("tuner", "messages.tuner", {{"parameter", parameter}, {"kind", kind}, {"base", base}, {"slope", 0.0}});
    const int gain = bench.add("gain", "streams.gain");
    bench.connect("count", "gain");
    bench.tell("pulse", "tuner");
    bench.tell("tuner", "gain.parameters");
    bench.duration(0.3);
    const Result result = bench.run();
    CHECK(result.outcome.status == Outcome::Status::partial);
    CHECK(result.outcome.reason == message);
    CHECK(result.outcome.failed_block == gain);
  }
}

TEST_CASE("changes: lists come as attributes or as arrays") {
  for (const std::string kind : {"list", "array"}) {
    Bench bench;
    bench.add("count", "streams.counter");
    bench.add("pulse", "messages.pulse", {{"rate", 10.0}});
    bench.add("tuner", "messages.tuner", {{"parameter", std::string("list")}, {"kind", kind}, {"base", 3.0}, {"slope", 0.0}});
    bench.add("gain", "streams.gain");
    bench.connect("count", "gain");
    bench.tell("pulse", "tuner");
    bench.tell("tuner", "gain.parameters");
    bench.duration(0.1);
    const Result result = bench.run();
    INFO(result.outcome.reason);
    REQUIRE(result.outcome.status == Outcome::Status::complete);
    CHECK(result.stream("gain.out")[50] == 56.0);
    CHECK(result.changes.at("gain")[0].value.rows == 2);
  }
}

TEST_CASE("changes: a matrix comes as an array of rank 2") {
  BlockDescription type;
  type.parameters.resize(1);
  type.parameters[0].name = "k";
  type.parameters[0].type = BF_MATRIX;
  type.parameters[0].live = true;
  RecordBuilder builder("parameter_change");
  builder.set("parameter", "k");
  auto values = builder.array<double>("value", "1", {2, 3});
  for (std::size_t i = 0; i < 6; ++i) values[i] = static_cast<double>(i);
  const auto bytes = builder.bytes();
  const SharedRecord record = SharedRecord::copy(bytes.data(), bytes.size());
  const auto change = execute::parameter_change(type, RecordView(*record.c()));
  REQUIRE(change);
  CHECK(change->value.rows == 2);
  CHECK(change->value.columns == 3);
  CHECK(change->value.numbers == std::vector<double>{0, 1, 2, 3, 4, 5});
}

}  // namespace
}  // namespace bodeflow::test
