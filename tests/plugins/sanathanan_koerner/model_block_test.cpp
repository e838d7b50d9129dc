// The blocks: records in and out, parameters, refusals.

#include "sanathanan_koerner/model_block.hpp"

#include <numbers>

#include "../block_driver.hpp"
#include "../spectrum/record_bytes.hpp"
#include "catch.hpp"
#include "records/model.hpp"
#include "records/response.hpp"
#include "sanathanan_koerner/vector_fitting_block.hpp"
#include "systems.hpp"

using namespace bodeflow;
using namespace bodeflow::test;
using sanathanan_koerner::ModelBlock;
using sanathanan_koerner::VectorFittingBlock;

namespace {

const Eigen::VectorXd kFrequency = geometric(0.2, 20.0, 60);

/// Two outputs and two inputs with two modes in common; noise of 0.1 %.
RecordBuilder response_record(bool variance, Eigen::Index inputs = 2, Eigen::Index outputs = 2, std::uint64_t seed = 4) {
  records::ResponseData d;
  d.form = "known_input";
  for (Eigen::Index j = 0; j < inputs; ++j) d.input_names.push_back("u" + std::to_string(j + 1));
  for (Eigen::Index i = 0; i < outputs; ++i) d.output_names.push_back("y" + std::to_string(i + 1));
  d.response_units.assign(static_cast<std::size_t>(inputs * outputs), "m/N");
  d.frequency_hz = kFrequency;
  d.response = Eigen::MatrixXcd::Zero(60, inputs * outputs);
  numerics::Random random(seed);
  for (Eigen::Index k = 0; k < 60; ++k) {
    const std::complex<double> s(0.0, 2.0 * std::numbers::pi * kFrequency[k]);
    for (Eigen::Index e = 0; e < inputs * outputs; ++e) {
      const auto a = static_cast<double>(e + 1);
      d.response(k, e) = 100.0 * a / (s * s + 0.4 * s + 100.0) - 900.0 / a / (s * s + 2.0 * s + 1600.0);
    }
  }
  const Eigen::MatrixXd deviation = 1e-3 * d.response.cwiseAbs();
  for (Eigen::Index k = 0; k < 60; ++k)
    for (Eigen::Index e = 0; e < inputs * outputs; ++e) d.response(k, e) += deviation(k, e) * complex_normal(random);
  if (variance) d.variance = deviation.cwiseAbs2();
  return records::write_response(d);
}

template <class Driver>
void run(Driver& block, const RecordBuilder& response) {
  block.configure();
  block.resolve({});
  block.activate(16, Rate(1, 1));
  block.receive(response, 0.0);
  block.finish();
}

template <class B>
std::string refusal(const std::vector<std::pair<std::string, std::string>>& texts, const RecordBuilder& response) {
  return failure_of([&] {
    BlockDriver<B> block;
    for (const auto& [name, value] : texts) block.set(name, value);
    run(block, response);
  });
}

}  // namespace

TEMPLATE_TEST_CASE("blocks: several inputs and outputs give a state space with poles and their covariance", "", ModelBlock,
                   VectorFittingBlock) {
  BlockDriver<TestType> block;
  block.set("order", "4");
  run(block, response_record(true));
  REQUIRE(block.records().size() == 2);
  const RecordView model(*block.records()[0]), residual(*block.records()[1]);
  const auto read = records::read_linear_model(model);
  REQUIRE(read);
  CHECK(read->form == "state_space");
  CHECK(read->order == 4);
  CHECK(read->inputs.names == std::vector<std::string>{"u1", "u2"});
  CHECK(read->state_space->inputs() == 2);
  CHECK(read->state_space->states() == 8);
  CHECK(worst_match(read->poles, Eigen::VectorXcd::Constant(1, std::complex<double>(-0.2, std::sqrt(100.0 - 0.04)))) < 1e-3);
  REQUIRE(model.array("pole_covariance"));
  CHECK(read->parameters.size() == 4 + 4 * 5);
  CHECK(read->covariance.rows() == 24);
  CHECK(*read->cost == Approx(*read->expected_cost).epsilon(0.2));
  CHECK(model.number("relative_error").value() < 0.1);
  CHECK(model.text("reason").value() != "");
  CHECK(residual.type() == "residual");
  CHECK(residual.array("residual")->shape[1] == 4);
}

TEMPLATE_TEST_CASE("blocks: one input and output give polynomials too, so that every reader has a model", "", ModelBlock,
                   VectorFittingBlock) {
  BlockDriver<TestType> block;
  block.set("order", "auto").set("highest_order", std::int64_t{6}).set("refine", true);
  run(block, response_record(true, 1, 1));
  REQUIRE(block.records().size() == 3);
  const auto read = records::read_model(RecordView(*block.records()[0]));
  REQUIRE(read);
  CHECK(read->order == 4);
  CHECK(read->denominator.size() == 5);
  CHECK(read->input_name == "u1");
  const RecordView scan(*block.records()[1]);
  CHECK(scan.type() == "order_scan");
  CHECK(scan.integer("chosen").value() == 4);
  CHECK(scan.text("rule").value().find("the minimum of MDL") == 0);
}

TEMPLATE_TEST_CASE("blocks: the order of several inputs and outputs is found", "", ModelBlock, VectorFittingBlock) {
  BlockDriver<TestType> block;
  block.set("highest_order", std::int64_t{7});
  run(block, response_record(true));
  REQUIRE(block.records().size() == 3);
  const RecordView model(*block.records()[0]), scan(*block.records()[1]);
  CHECK(scan.integer("chosen").value() == 4);
  CHECK(scan.array("order")->shape[0] == 7);
  CHECK(records::read_linear_model(model)->state_space->states() == 8);
}

TEMPLATE_TEST_CASE("blocks: two modes that all inputs and outputs see in one way need two states each", "", ModelBlock,
                   VectorFittingBlock) {
  // Residues of rank 1: the entries of each mode are those of [1; 2] [1 3].
  records::ResponseData d;
  d.form = "known_input";
  d.input_names = {"u1", "u2"};
  d.output_names = {"y1", "y2"};
  d.response_units.assign(4, "m/N");
  d.frequency_hz = kFrequency;
  d.response = Eigen::MatrixXcd::Zero(60, 4);
  numerics::Random random(6);
  const double gain[] = {1.0, 3.0, 2.0, 6.0};
  for (Eigen::Index k = 0; k < 60; ++k) {
    const std::complex<double> s(0.0, 2.0 * std::numbers::pi * kFrequency[k]);
    for (Eigen::Index e = 0; e < 4; ++e)
      d.response(k, e) =
          gain[e] * (100.0 / (s * s + 0.4 * s + 100.0) - 900.0 / (s * s + 2.0 * s + 1600.0)) + 1e-4 * complex_normal(random);
  }
  d.variance = Eigen::MatrixXd::Constant(60, 4, 1e-8);
  const RecordBuilder response = records::write_response(d);
  for (const char* states : {"auto", "4", "gilbert"}) {
    BlockDriver<TestType> block;
    block.set("order", "4").set("states", states);
    run(block, response);
    const RecordView model(*block.records()[0]);
    const auto read = records::read_linear_model(model);
    REQUIRE(read);
    CHECK(read->order == 4);
    CHECK(read->state_space->states() == 4);
    CHECK(read->state_space->inputs() == 2);
    CHECK(worst_match(read->poles, Eigen::VectorXcd::Constant(1, std::complex<double>(-0.2, std::sqrt(100.0 - 0.04)))) < 1e-3);
    CHECK(model.integer("fitted_poles").value() == 4);
    CHECK(model.integer("states_before").value() == 8);
    if (states != std::string("gilbert")) {
      CHECK(model.number("hankel_gap").value() > 100.0);
      CHECK(model.array("hankel_singular_values")->shape[0] == 8);
    }
    CHECK(model.number("reduction_change").value() < 1e-4);
    CHECK(model.number("rms_error").value() == Approx(1e-4).epsilon(0.15));
    CHECK(*read->cost == Approx(240.0).epsilon(0.15));
  }
}

TEST_CASE("sanathanan_koerner.model: without variance a warning says what is missing") {
  BlockDriver<ModelBlock> block;
  block.set("order", "4");
  run(block, response_record(false));
  const RecordView model(*block.records()[0]);
  CHECK_FALSE(model.number("cost"));
  REQUIRE_FALSE(warnings_of(model).empty());
  CHECK(warnings_of(model).front().find("the response has no variance") == 0);
}

TEST_CASE("sanathanan_koerner.model: too low an order is told against the noise") {
  BlockDriver<ModelBlock> block;
  block.set("order", "2");
  run(block, response_record(true));
  const auto warnings = warnings_of(RecordView(*block.records()[0]));
  CHECK(std::any_of(warnings.begin(), warnings.end(),
                    [](const std::string& w) { return w.find("times what the noise explains") != std::string::npos; }));
}

TEST_CASE("sanathanan_koerner.model: a repeated response chooses the order and must be of the same size") {
  BlockDriver<ModelBlock> block;
  block.set("highest_order", std::int64_t{6});
  block.configure();
  block.resolve({});
  block.activate(16, Rate(1, 1));
  block.receive(response_record(true, 1, 1), 0.0, 0);
  block.receive(response_record(true, 1, 1, 9), 0.0, 1);
  block.finish();
  const RecordView scan(*block.records()[1]);
  CHECK(scan.integer("chosen").value() == 4);
  CHECK(scan.text("rule").value().find("repeated measurement") != std::string::npos);
  block.reset();
  block.receive(response_record(true, 1, 1), 0.0, 0);
  block.receive(response_record(true, 2, 1), 0.0, 1);
  CHECK(failure_of([&] { block.finish(); }) == "the repeated response has 2 entries, the response 1");
}

TEST_CASE("sanathanan_koerner.model: a record is the same after reset") {
  BlockDriver<ModelBlock> block;
  block.set("order", "4");
  run(block, response_record(true));
  block.reset();
  block.receive(response_record(true), 0.0);
  block.finish();
  const auto bytes = bytes_of(block.records());
  REQUIRE(bytes.size() == 4);
  CHECK(bytes[0] == bytes[2]);
  CHECK(bytes[1] == bytes[3]);
}

TEST_CASE("sanathanan_koerner.model: parameters that can't be meant are refused with what is allowed") {
  const RecordBuilder r = response_record(false, 1, 1);
  CHECK(refusal<ModelBlock>({{"order", "four"}}, r) == "order: 'four'; allowed: 0 to 1000, or auto");
  CHECK(refusal<ModelBlock>({{"order", "90"}}, r) == "order 90 with 1 response needs at least 91 lines; there are 60");
  CHECK(refusal<ModelBlock>({{"states", "few"}}, r) == "states: 'few'; allowed: all, auto, gilbert, or a number from 0 on");
  CHECK(refusal<ModelBlock>({{"order", "4"}, {"states", "9"}}, r) == "states: 9 states; allowed: 0 to 4");
  CHECK(refusal<ModelBlock>({{"prewarp", "20"}}, r) ==
        "prewarp: '20'; allowed: a frequency above 0 with its unit, such as 20 Hz, or auto");
  CHECK(refusal<ModelBlock>({{"prewarp", "20 Hz"}, {"domain", "z"}}, r) ==
        "prewarp is for domain: s; a model in z has its lines on the circle");
  CHECK(refusal<ModelBlock>({{"domain", "z"}, {"order", "2"}}, r) == "domain: z needs a response with its sample rate");
  CHECK(refusal<ModelBlock>({{"weighting", "variance"}}, r) ==
        "weighting: variance needs a response with its variance; this one has none");
  CHECK(refusal<VectorFittingBlock>({{"band", "60 Hz:70 Hz"}}, r) == "band '60 Hz:70 Hz' holds no line of the response");
  BlockDriver<VectorFittingBlock> named;
  named.set("inputs", std::vector<std::string>{"force"});
  CHECK(failure_of([&] { run(named, r); }) == "input 'force' is not in the response; it has 'u1'");
  BlockDriver<ModelBlock> empty;
  empty.configure();
  empty.resolve({});
  empty.activate(16, Rate(1, 1));
  CHECK(failure_of([&] { empty.finish(); }) == "no frequency response arrived");
}
