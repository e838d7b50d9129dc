#include "records/recording.hpp"

#include <cmath>

#include "acquisition/recording_block.hpp"
#include "catch.hpp"
#include "plugins/block_driver.hpp"

using namespace bodeflow;
using records::Recording;
using test::BlockDriver;
using Block_ = acquisition::RecordingBlock;

namespace {

StreamFacts facts(double rate_hz, int channels, const char* unit) {
  StreamFacts f;
  f.known = true;
  f.channels = channels;
  f.rate = Rate::from_hz(rate_hz);
  f.unit = unit;
  return f;
}

Recording example() {
  Recording r;
  r.sample_rate_hz = 100.0;
  r.period = 4;
  r.skip = 1;
  r.periods = 2;
  r.input_signals = {{"u"}, {"V"}};
  r.output_signals = {{"a", "b"}, {"A", "m"}};
  r.input = Eigen::VectorXd::LinSpaced(13, 0.0, 12.0);
  r.output = Eigen::MatrixXd::Random(13, 2);
  r.excited_lines = {1};
  r.excited_amplitudes = {2.5};
  return r;
}

Expected<Recording> carried(const Recording& r) {
  const auto bytes = records::write_recording(r).bytes();
  return records::read_recording(RecordView(bytes.data()));
}

}  // namespace

TEST_CASE("recording record: what is written is read") {
  const Recording r = example();
  const auto read = carried(r);
  REQUIRE(read);
  CHECK(read->input == r.input);
  CHECK(read->output == r.output);
  CHECK(read->output_signals.names == r.output_signals.names);
  CHECK(read->output_signals.units == r.output_signals.units);
  CHECK(read->periods == 2);
  CHECK(read->excited_lines == r.excited_lines);
  CHECK(read->excited_amplitudes == r.excited_amplitudes);
}

TEST_CASE("recording record: what does not fit is refused by name") {
  const auto reason = [](auto change) {
    Recording r = example();
    change(r);
    const auto read = carried(r);
    return read ? std::string("read") : read.error().text;
  };
  CHECK(reason([](Recording& r) { r.periods = 3; }) == "the record has 13 samples, too few for 1 + 3 periods of 4");
  CHECK(reason([](Recording& r) { r.skip = INT64_MAX; }).substr(0, 38) == "the record has 13 samples, too few for");
  CHECK(reason([](Recording& r) { r.output(5, 1) = NAN; }) == "array 'output', channel 2: sample 5 is not finite");
  CHECK(reason([](Recording& r) { r.output = Eigen::MatrixXd::Zero(12, 2); }) == "array 'input' has 13 samples, 'output' 12");
  CHECK(reason([](Recording& r) { r.sample_rate_hz = 0.0; }) == "attribute 'sample_rate' is missing or not above 0");
}

TEST_CASE("acquisition.recording: sends all samples with the excitation's lines") {
  BlockDriver<Block_> block;
  block.set("period", std::int64_t{10}).set("skip", std::int64_t{1});
  block.configure();
  auto u = facts(100.0, 1, "V");
  u.notes["excitation.frequencies"] = {10.0, 30.0};
  u.notes["excitation.amplitudes"] = {1.0, 0.5};
  block.resolve({u, facts(100.0, 1, "A")});
  block.activate(35, Rate::from_hz(100.0));
  std::vector<double> x(35), y(35);
  for (std::size_t n = 0; n < x.size(); ++n) x[n] = static_cast<double>(n), y[n] = -x[n];
  block.process({{x}, {y}}, x.size());
  block.finish();
  REQUIRE(block.records().size() == 1);
  const auto read = records::read_recording(RecordView(*block.records().front()));
  REQUIRE(read);
  CHECK(read->periods == 2);
  CHECK(read->samples() == 35);
  CHECK(read->output(34, 0) == -34.0);
  CHECK(read->excited_lines == std::vector<std::int64_t>{1, 3});
  CHECK(read->input_signals.units == std::vector<std::string>{"V"});
}

TEST_CASE("acquisition.recording: refuses too few periods, too many samples, and values that are not finite") {
  const auto reason = [](std::int64_t limit, std::vector<double> x) {
    try {
      BlockDriver<Block_> block;
      block.set("period", std::int64_t{10}).set("skip", std::int64_t{1}).set("limit", limit);
      block.configure();
      block.resolve({facts(100.0, 1, "V"), facts(100.0, 1, "A")});
      block.activate(100, Rate::from_hz(100.0));
      const std::size_t count = x.size();
      block.process({{x}, {x}}, count);
      block.finish();
      return std::string();
    } catch (const Failure& failure) {
      return std::string(failure.what());
    }
  };
  CHECK(reason(100, std::vector<double>(19, 1.0)) == "19 samples came; needed: 1 periods of 10 samples to skip, and one more");
  CHECK(reason(16, std::vector<double>(20, 1.0)) == "more than 16 samples: give a greater limit, or a shorter duration");
  CHECK(reason(100, {1.0, 2.0, NAN}) == "'input' is not finite at sample 2");
}
