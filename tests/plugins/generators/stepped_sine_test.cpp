#include <cmath>
#include <numbers>

#include "catch.hpp"
#include "plugins/block_driver.hpp"
#include "stepped_sine_block.hpp"

using namespace bodeflow;
using bodeflow::test::BlockDriver;
using bodeflow::test::failure_of;
using generators::SteppedSine;

namespace {

using Driver = BlockDriver<SteppedSine>;

/// 1 kHz; 50 Hz (20 samples a cycle), 100 Hz (10), 40 Hz (25).
void start(Driver& block) {
  block.set("sample_rate", 1000.0).set("frequencies", std::vector<double>{50.0, 100.0, 40.0});
  block.configure();
  block.resolve({});
  block.activate(10000, Rate(1000, 1));
}

RecordBuilder measured(std::int64_t index) {
  RecordBuilder record("frequency_step");
  record.set("index", index);
  return record;
}

std::vector<double> samples(Driver& block, std::uint64_t count) { return block.process({}, count)[0][0]; }

// Of 2 pi times the cycles that the expected sine is taken of.
constexpr double kRounding = 1e-14;

double sine(double cycles) { return std::sin(2.0 * std::numbers::pi * cycles); }

std::vector<std::int64_t> indices(const Driver& block) {
  std::vector<std::int64_t> all;
  for (const bf_record* r : block.records()) all.push_back(RecordView(*r).integer("index").value());
  return all;
}

}  // namespace

TEST_CASE("stepped sine: a frequency lasts until the record of its index comes, then the next begins where the phase is") {
  Driver block;
  start(block);
  const auto first = samples(block, 33);
  for (std::size_t n = 0; n < 33; ++n) CHECK(std::abs(first[n] - sine(0.05 * static_cast<double>(n))) < kRounding);
  block.receive(measured(0), 0.033);
  const auto second = samples(block, 20);
  for (std::size_t n = 0; n < 20; ++n) CHECK(std::abs(second[n] - sine(0.65 + 0.1 * static_cast<double>(n))) < kRounding);
  CHECK(indices(block) == std::vector<std::int64_t>{0, 1});
  CHECK(block.record_positions() == std::vector<std::uint64_t>{0, 33});
}

TEST_CASE("stepped sine: what begins is told with the frequency really used") {
  Driver block;
  block.set("sample_rate", 1000.0).set("frequencies", std::vector<double>{300.4}).set("amplitude", std::vector<double>{2.5});
  block.set("tolerance", 0.01);
  block.configure();
  const auto facts = block.resolve({});
  CHECK(facts[0].length == -1);
  CHECK(facts[0].note("excitation.frequencies") == std::vector<double>{300.0});
  CHECK(facts[0].note("excitation.amplitudes") == std::vector<double>{2.5});
  block.activate(100, Rate(1000, 1));
  samples(block, 1);
  const RecordView record(*block.records().at(0));
  CHECK(record.type() == "frequency_step");
  CHECK(record.integer("index") == 0);
  CHECK(record.integer("count") == 1);
  CHECK(record.number("frequency") == 300.0);
  CHECK(record.number("wanted_frequency") == 300.4);
  CHECK(record.integer("cycles") == 3);
  CHECK(record.integer("window") == 10);
  CHECK(record.number("sample_rate") == 1000.0);
  CHECK(record.number("amplitude") == 2.5);
}

TEST_CASE("stepped sine: a record for another frequency than the one that is on changes nothing") {
  Driver block;
  start(block);
  samples(block, 10);
  for (const std::int64_t index : {-1, 1, 2, 99}) block.receive(measured(index), 0.01);
  samples(block, 10);
  CHECK(indices(block) == std::vector<std::int64_t>{0});
  CHECK(failure_of([&] { block.receive(RecordBuilder("model"), 0.0); }) ==
        "a record of type 'model' on 'step'; needed: frequency_step with an integer 'index'");
}

TEST_CASE("stepped sine: the stream ends after the last frequency") {
  Driver block;
  start(block);
  for (std::int64_t index = 0; index < 3; ++index) {
    samples(block, 7);
    CHECK(block.done() == 7);
    block.receive(measured(index), 0.0);
  }
  samples(block, 7);
  CHECK(block.done() == 0);
}

TEST_CASE("stepped sine: with a dwell each frequency lasts whole windows, after silence, whatever the size of the calls") {
  const auto run = [](std::uint64_t chunk) {
    Driver block;
    block.set("silence", 0.05).set("dwell", 0.03).set("phase", "restart").set("amplitude", std::vector<double>{1.0, 2.0, 3.0});
    block.set("sample_rate", 1000.0).set("frequencies", std::vector<double>{50.0, 100.0, 40.0});
    block.configure();
    CHECK(block.resolve({})[0].length == 50 + 40 + 30 + 50);
    block.activate(chunk, Rate(1000, 1));
    std::vector<double> all;
    do {
      const auto part = samples(block, chunk);
      all.insert(all.end(), part.begin(), part.begin() + static_cast<std::ptrdiff_t>(block.done()));
    } while (block.done() == chunk);
    CHECK(block.record_positions() == std::vector<std::uint64_t>{50, 90, 120});
    return all;
  };
  const auto all = run(1000);
  REQUIRE(all.size() == 170);
  for (std::size_t n = 0; n < 50; ++n) CHECK(all[n] == 0.0);
  for (std::size_t n = 0; n < 40; ++n) CHECK(std::abs(all[50 + n] - sine(static_cast<double>(n) / 20)) < kRounding);
  for (std::size_t n = 0; n < 30; ++n) CHECK(std::abs(all[90 + n] - 2 * sine(static_cast<double>(n) / 10)) < kRounding);
  for (std::size_t n = 0; n < 50; ++n) CHECK(std::abs(all[120 + n] - 3 * sine(static_cast<double>(n) / 25)) < kRounding);
  for (const std::uint64_t chunk : {1u, 7u, 64u}) CHECK(run(chunk) == all);
}

TEST_CASE("stepped sine: a frequency is as exact after 1e7 samples as at first: the sine repeats with its window") {
  Driver block;
  block.set("sample_rate", 1000.0).set("frequencies", std::vector<double>{1000.0 * 7 / 23});
  block.configure();
  block.resolve({});
  block.activate(1 << 20, Rate(1000, 1));
  const auto first = samples(block, 23);
  for (int call = 0; call < 20; ++call) samples(block, 23 * 20000);
  const auto later = samples(block, 23);
  for (std::size_t n = 0; n < 23; ++n) CHECK(std::abs(later[n] - first[n]) < 1e-15);
}

TEST_CASE("stepped sine: parameters that do not fit each other are refused") {
  const auto refusal = [](auto prepare) {
    Driver block;
    block.set("sample_rate", 1000.0);
    prepare(block);
    return failure_of([&] { block.configure(); });
  };
  CHECK(refusal([](Driver&) {}) == "no frequencies: give a list 'frequencies', or 'grid' with first, last and count");
  CHECK(refusal([](Driver& b) { b.set("grid.first", 1.0).set("frequencies", std::vector<double>{5.0}); }) ==
        "frequencies are given as a list as well as a grid; allowed: one of the two");
  CHECK(refusal([](Driver& b) { b.set("grid.first", 5.0).set("grid.last", 5.0).set("grid.count", std::int64_t{2}); }) ==
        "grid: first and last are both 5 Hz; allowed: two frequencies");
  CHECK(refusal([](Driver& b) {
          b.set("frequencies", std::vector<double>{5.0, 10.0}).set("amplitude", std::vector<double>{1.0, 2.0, 3.0});
        }) == "amplitude has 3 values, allowed: 1, or one for each of the 2 frequencies");
  CHECK(refusal([](Driver& b) { b.set("frequencies", std::vector<double>{600.0}); }) ==
        "frequency 600 Hz; allowed: above 0 and below half of the sample rate, 500 Hz");
}

TEST_CASE("stepped sine: how far the frequencies are moved and the longest time are told before the run") {
  Driver block;
  block.set("sample_rate", 1000.0).set("frequencies", std::vector<double>{300.3, 50.0}).set("tolerance", 0.01).set("dwell", 0.1);
  block.configure();
  CHECK(block.advise({}) ==
        std::vector<std::string>{
            "2 frequencies from 300 Hz to 50 Hz, moved by at most 0.1 % to fit the samples; at most 0.2 s in all"});
}
