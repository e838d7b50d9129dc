#include <cmath>
#include <complex>
#include <limits>

#include "catch.hpp"
#include "record_bytes.hpp"
#include "spectrum/delay_block.hpp"
#include "spectrum/merge_block.hpp"
#include "stream_signals.hpp"

using namespace bodeflow;
using namespace bodeflow::test;
using namespace bodeflow::spectrum;
using Complex = std::complex<double>;

namespace {

/// Two outputs, one input: a gain of 2 with a delay of 5 ms, and the same as an integrator. Lines each 2 Hz.
ResponseData delayed(double from, Eigen::Index lines) {
  ResponseData d;
  d.form = "local_polynomial";
  d.method = "spectrum.local_polynomial";
  d.input_names = {"u"};
  d.output_names = {"y", "angle"};
  d.response_units = {"V/A", "rad/A"};
  d.sample_rate_hz = 1000.0;
  d.degrees_of_freedom = 7.0;
  d.frequency_hz = Eigen::VectorXd::LinSpaced(lines, from, from + 2.0 * static_cast<double>(lines - 1));
  d.response.resize(lines, 2);
  for (Eigen::Index k = 0; k < lines; ++k) {
    const Complex s(0.0, 6.283185307179586 * d.frequency_hz[k]);
    d.response(k, 0) = 2.0 * std::exp(-0.005 * s);
    d.response(k, 1) = d.response(k, 0) / s;
  }
  d.variance = Eigen::MatrixXd::Constant(lines, 2, 1e-6);
  return d;
}

template <class B>
RecordView only_record(const BlockDriver<B>& block) {
  REQUIRE(block.records().size() == 1);
  return RecordView(*block.records()[0]);
}

}  // namespace

TEST_CASE("response data: what is written is read back, and damaged records are refused by name") {
  const ResponseData d = delayed(2.0, 5);
  const AlignedRecord record(write_response(d));
  const auto back = read_response(record.view());
  REQUIRE(back);
  CHECK(back->frequency_hz == d.frequency_hz);
  CHECK(back->response == d.response);
  CHECK(back->variance == d.variance);
  CHECK(back->output_names == d.output_names);
  CHECK(back->response_units == d.response_units);
  CHECK(back->degrees_of_freedom == 7.0);
  CHECK_FALSE(back->periods.has_value());

  const auto refusal = [](const RecordBuilder& r) {
    const AlignedRecord bad(r);
    const auto data = read_response(bad.view());
    return data ? std::string("none") : data.error().text;
  };
  CHECK(refusal(RecordBuilder("model")) == "a record of type 'model'; needed: frequency_response");
  RecordBuilder r("frequency_response");
  CHECK(refusal(r) == "the record has no array 'frequency'");
  auto f = r.array<double>("frequency", "Hz", {2});
  f[0] = 1.0;
  f[1] = 2.0;
  CHECK(refusal(r) == "the record has no array 'response'");
  RecordBuilder flat = r;
  flat.array<Complex>("response", "", {2});
  CHECK(refusal(flat) == "array 'response' is 2; needed: 2 x outputs x inputs");
  RecordBuilder real = r;
  real.array<double>("response", "", {2, 1, 1});
  CHECK(refusal(real).find("array 'response' holds ") == 0);
  r.array<Complex>("response", "", {2, 1, 1})[1] = std::numeric_limits<double>::quiet_NaN();
  CHECK(refusal(r) == "array 'response' is not finite at line 2 of 2");
}

TEST_CASE("merge block: merges all records at the end") {
  BlockDriver<MergeBlock> block;
  block.configure();
  block.resolve({});
  block.activate(1, {});
  block.receive(write_response(delayed(2.0, 20)), 0.0);
  block.receive(write_response(delayed(30.0, 20)), 1.0);
  CHECK(block.records().empty());
  block.finish();
  const RecordView r = only_record(block);
  CHECK(r.text("method") == "spectrum.merge");
  CHECK(r.integer("experiments") == 2);
  CHECK(r.array("frequency")->size == 34);
  CHECK(r.array("response")->size == 68);
  block.reset();
  CHECK(failure_of([&] { block.finish(); }) == "no record to merge; needed: at least one");
  CHECK(failure_of([&] { block.receive(RecordBuilder("trace"), 0.0); }) ==
        "experiment 1: a record of type 'trace'; needed: frequency_response");
}

TEST_CASE("delay block: a record for each record, of the output and band that are asked for") {
  BlockDriver<DelayBlock> block;
  block.set("output", "angle").set("slope", std::int64_t{-1}).set("band", std::vector<double>{10.0, 100.0});
  block.configure();
  block.resolve({});
  block.activate(1, {});
  block.receive(write_response(delayed(2.0, 100)), 0.0);
  const RecordView r = only_record(block);
  CHECK(r.type() == "delay_estimate");
  CHECK(r.number("delay") == Approx(5e-3));
  CHECK(r.number("delay_samples") == Approx(5.0));
  CHECK(r.number("gain") == Approx(2.0));
  CHECK(r.integer("lines") == 46);
  CHECK(r.numbers("band") == std::vector<double>{10.0, 100.0});
  CHECK(r.text("output_name") == "angle");
  CHECK(*r.number("standard_deviation") > 0.0);
  CHECK(warnings_of(r).empty());
}

TEST_CASE("delay block: says when the plant is no delayed gain, and refuses names that the record does not have") {
  const auto start = [](BlockDriver<DelayBlock>& block, const char* output) {
    block.set("output", output);
    block.configure();
    block.resolve({});
    block.activate(1, {});
  };
  BlockDriver<DelayBlock> integrator, wrong;
  start(integrator, "angle");
  integrator.receive(write_response(delayed(2.0, 100)), 0.0);
  const auto warnings = warnings_of(only_record(integrator));
  REQUIRE(!warnings.empty());
  CHECK(warnings[0].find("a delayed gain leaves ") == 0);
  start(wrong, "speed");
  CHECK(failure_of([&] { wrong.receive(write_response(delayed(2.0, 100)), 0.0); }) ==
        "output 'speed' is not in the record; it has 'y', 'angle'");
  BlockDriver<DelayBlock> narrow;
  narrow.set("band", std::vector<double>{3.0, 3.5});
  start(narrow, "y");
  CHECK(failure_of([&] { narrow.receive(write_response(delayed(2.0, 100)), 0.0); }) ==
        "the band has 0 lines; a delay needs at least 3");
}
