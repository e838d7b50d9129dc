#include "blocks/amplitude_block.hpp"
#include "blocks/reveal_block.hpp"
#include "blocks/trace_block.hpp"
#include "catch.hpp"
#include "plugins/block_driver.hpp"
#include "records/recording.hpp"
#include "simple_bench.hpp"

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

TEST_CASE("residual.trace: refuses what it can't use, with the record's name") {
  BlockDriver<TraceBlock> driver;
  start(driver);
  CHECK(failure_of([&] { driver.receive(RecordBuilder("model"), 0, 0); }) ==
        "record 'fit 1': a record of type 'model'; needed: recording");
  driver.receive(recording(1), 0, 0);
  driver.receive(recording(2), 0, 1);
  CHECK(failure_of([&] { driver.receive(recording(3), 0, 1); }) == "a second record arrived at 'select', allowed: one");
  CHECK(failure_of([&] { driver.finish(); }) == "no plugin gives the base model 'residual.motor_standstill'");
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
  RecordBuilder said("trace");
  said.set("verdict", "none").set("effects", std::vector<std::string>{}).set("equivalents", std::vector<std::string>{});
  said.set("candidate_names", std::vector<std::string>{"delay"});
  said.set("parameter_names", std::vector<std::string>{"gamma", "alpha", "Lm_beta", "sigma"});
  said.set("parameter_units", std::vector<std::string>{"1/s", "1/s", "1", "H"});
  for (const char* name : {"parameters_before", "parameters_after", "parameters_after_std"}) {
    const auto to = said.array<double>(name, "", {4});
    std::fill(to.begin(), to.end(), 1.0);
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
