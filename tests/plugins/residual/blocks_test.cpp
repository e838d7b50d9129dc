#include "amplitude_block.hpp"
#include "catch.hpp"
#include "plugins/block_driver.hpp"
#include "records/recording.hpp"
#include "reveal_block.hpp"
#include "simple_bench.hpp"
#include "trace_block.hpp"

using namespace bodeflow;
using namespace bodeflow::residual;
using bodeflow::test::BlockDriver;
using bodeflow::test::failure_of;

namespace {

RecordBuilder recording(std::uint64_t seed, double amplitude = 4.0) {
  return records::write_recording(bench::record({}, amplitude, seed, 3));
}

template <class Block>
void start(BlockDriver<Block>& driver) {
  driver.configure();
  driver.resolve({});
  driver.activate(1, Rate::from_hz(1));
}

RecordView sent(const bf_record* record) {
  return RecordView::check({record->bytes, static_cast<std::size_t>(record->size)}).value();
}

RecordBuilder bench_that_hides(const char* effect, double size) {
  RecordBuilder r("bench_properties");
  r.set("effect", effect).set("size", size).set("unit", "s");
  return r;
}

}  // namespace

TEST_CASE("residual.trace: sends the verdict and both models, to the same bits after a reset") {
  BlockDriver<TraceBlock> driver;
  driver.set("computation_delay", 100e-6);
  start(driver);
  for (int round = 0; round < 2; ++round) {
    driver.receive(recording(1, 1.8), 0, 0);
    driver.receive(recording(2), 0, 0);
    driver.receive(recording(3), 0, 1);
    driver.receive(recording(4), 0, 2);
    driver.finish();
    driver.reset();
  }
  REQUIRE(driver.records().size() == 6);
  const RecordView trace = sent(driver.records()[0]);
  CHECK(trace.type() == "trace");
  CHECK(trace.text("verdict") == "none");
  CHECK(trace.text("unit") == "A");
  CHECK(trace.texts("effects")->empty());
  CHECK(trace.texts("candidate_names")->size() == 3);
  CHECK(trace.array("class_before")->shape.size() == 2);
  CHECK(*trace.number("error_before") == *trace.number("error_after"));
  CHECK(sent(driver.records()[1]).type() == "model");
  CHECK(sent(driver.records()[2]).text("form") == "physical");
  for (int n = 0; n < 3; ++n) {
    const bf_record *a = driver.records()[static_cast<std::size_t>(n)], *b = driver.records()[static_cast<std::size_t>(n + 3)];
    REQUIRE(a->size == b->size);
    CHECK(std::equal(a->bytes, a->bytes + a->size, b->bytes));
  }
}

TEST_CASE("residual.trace: refuses what it can't use, with the record's name") {
  BlockDriver<TraceBlock> driver;
  start(driver);
  CHECK(failure_of([&] { driver.finish(); }) == "no recording arrived at 'fit'");
  CHECK(failure_of([&] { driver.receive(RecordBuilder("model"), 0, 0); }) ==
        "record 'fit 1': a record of type 'model'; needed: recording");
  driver.receive(recording(1), 0, 0);
  CHECK(failure_of([&] { driver.finish(); }).find("no recording arrived at 'select'") == 0);
  driver.receive(recording(2), 0, 1);
  CHECK(failure_of([&] { driver.receive(recording(3), 0, 1); }) == "a second record arrived at 'select', allowed: one");
  CHECK(failure_of([&] { driver.finish(); }).find("no recording arrived at 'test'") == 0);
  BlockDriver<TraceBlock> measured;
  measured.set("input", "terminal").set("computation_delay", 1e-4);
  CHECK(failure_of([&] { measured.configure(); }) ==
        "computation_delay belongs to a command; input is 'terminal', which is measured behind it");
}

TEST_CASE("residual.amplitude: sends a parameter change that says what it follows from") {
  BlockDriver<AmplitudeBlock> driver;
  driver.set("pilot", 4.0).set("largest_input", 150.0).set("largest_output", 6.0);
  start(driver);
  driver.receive(recording(1), 0);
  REQUIRE(driver.records().size() == 1);
  const RecordView change = sent(driver.records()[0]);
  CHECK(change.type() == "parameter_change");
  CHECK(change.text("parameter") == "gain");
  CHECK(*change.number("value") == Approx(4.0 * *change.number("factor")));
  CHECK(change.text("limited_by") == "largest_output");
}

TEST_CASE("residual.reveal: holds the verdict against the truth, with the true parameters where they are known") {
  BlockDriver<TraceBlock> tracer;
  tracer.set("computation_delay", 100e-6);
  start(tracer);
  for (int n = 0; n < 4; ++n) tracer.receive(recording(static_cast<std::uint64_t>(n + 1)), 0, n < 2 ? 0u : n == 2 ? 1u : 2u);
  tracer.finish();
  RecordBuilder said("trace");
  const RecordView trace = sent(tracer.records()[0]);
  said.set("verdict", "none").set("effects", std::vector<std::string>{}).set("equivalents", std::vector<std::string>{});
  said.set("candidate_names", std::vector<std::string>{"delay"});
  said.set("parameter_names", std::vector<std::string>{"gamma", "alpha", "Lm_beta", "sigma"});
  said.set("parameter_units", std::vector<std::string>{"1/s", "1/s", "1", "H"});
  for (const char* name : {"parameters_before", "parameters_after", "parameters_after_std"}) {
    const auto from = trace.array(name)->as<double>();
    const auto to = said.array<double>(name, "", {from.size()});
    std::copy(from.begin(), from.end(), to.begin());
  }
  BlockDriver<Reveal> driver;
  start(driver);
  CHECK(failure_of([&] { driver.finish(); }) == "no trace arrived at 'trace'");
  driver.receive(said, 0, 0);
  CHECK(failure_of([&] { driver.finish(); }) == "no truth arrived at 'truth'");
  RecordBuilder truth = bench_that_hides("none", 0.0);
  truth.set("rs", 6.6).set("rr", 5.5).set("ls", 0.475).set("lr", 0.475).set("lm", 0.454);
  driver.receive(truth, 0, 1);
  driver.finish();
  const RecordView reveal = sent(driver.records().back());
  CHECK(reveal.boolean("right") == true);
  CHECK(reveal.array("parameters_true")->as<double>()[0] == Approx(283.0287).epsilon(1e-6));
}
