// The block: records in and out, parameters, refusals.

#include "maximum_likelihood/model_block.hpp"

#include "../block_driver.hpp"
#include "../spectrum/record_bytes.hpp"
#include "catch.hpp"
#include "records/model.hpp"
#include "records/response.hpp"
#include "simulated.hpp"

using namespace bodeflow;
using namespace bodeflow::test;
using maximum_likelihood::ModelBlock;
using Driver = BlockDriver<ModelBlock>;

namespace {

const Eigen::VectorXd kOmega = 2.0 * std::numbers::pi * even_spaced(1.0, 40.0, 40);

/// Two outputs of one input with one denominator: motor and load.
struct TwoOutputs {
  Rational motor = ladder(4, kOmega, 0.0, 2e-3), load = motor;
  TwoOutputs() {
    load.zeros = list({});
    load.gain = 1e5;
  }
};

RecordBuilder response_record(bool variance, double rate_hz = 1000.0) {
  const TwoOutputs plant;
  numerics::Random random(9);
  records::ResponseData d;
  d.form = "known_input";
  d.input_names = {"current"};
  d.output_names = {"motor", "load"};
  d.response_units = {"rad/A", "rad/A"};
  if (rate_hz > 0.0) d.sample_rate_hz = rate_hz;
  d.input_amplitude = {2.5};
  d.frequency_hz = kOmega / (2.0 * std::numbers::pi);
  d.response.resize(40, 2);
  d.response << response_of(plant.motor, kOmega), response_of(plant.load, kOmega);
  const Eigen::MatrixXd deviation = 0.01 * d.response.cwiseAbs();
  for (Eigen::Index k = 0; k < 40; ++k) {
    for (Eigen::Index i = 0; i < 2; ++i) d.response(k, i) += deviation(k, i) * normal(random);
  }
  if (variance) d.variance = deviation.cwiseAbs2();
  return records::write_response(d);
}

/// The block after one response.
void run(Driver& block, const RecordBuilder& response) {
  block.configure();
  block.resolve({});
  block.activate(16, Rate(1, 1));
  block.receive(response, 0.0);
  block.finish();
}

std::string refusal(const std::vector<std::pair<std::string, std::string>>& texts, const RecordBuilder& response) {
  return failure_of([&] {
    Driver block;
    block.set("order", "4");
    for (const auto& [name, value] : texts) block.set(name, value);
    run(block, response);
  });
}

}  // namespace

TEST_CASE("maximum_likelihood.model: model, scan and residual of two outputs stand in the records") {
  Driver block;
  block.set("order", "auto").set("highest_order", std::int64_t{5}).set("delay", "estimate").set("starts", std::int64_t{2});
  block.set("bands", std::vector<double>{1.0, 10.0, 40.0});
  run(block, response_record(true));
  REQUIRE(block.records().size() == 3);
  const RecordView model(*block.records()[0]), scan(*block.records()[1]), residual(*block.records()[2]);
  const auto read = records::read_model(model);
  REQUIRE(read);
  CHECK(read->method == "maximum_likelihood.model");
  CHECK(read->form == "transfer_function");
  CHECK(read->order == 4);
  CHECK(read->input_amplitude == 2.5);
  CHECK(read->sample_time_s == 0.0);
  CHECK(read->delay_s == Approx(2e-3).epsilon(0.1));
  CHECK(read->output_name == "motor");
  CHECK(read->parameter_names == std::vector<std::string>{"b3", "b2", "b1", "b0", "a3", "a2", "a1", "a0", "delay"});
  CHECK(read->parameter_units.front() == "rad/A rad/s");
  CHECK(read->parameter_units.back() == "s");
  CHECK(read->covariance.rows() == 9);
  REQUIRE(model.array("pole_covariance"));
  CHECK(model.array("pole_covariance")->shape[0] == 4);
  CHECK(model.array("zero_covariance")->shape[0] == 3);
  CHECK(root_error(read->poles, TwoOutputs().motor.poles) < 0.02);
  CHECK(*read->expected_cost == 80.0 - 0.5 * 13.0);
  CHECK(model.text("covariance_method").value() == "residuals (sandwich)");
  CHECK(model.number("delay_std").value() > 0.0);
  CHECK(model.integer("starts_at_least_cost").value() >= 1);
  CHECK(scan.type() == "order_scan");
  CHECK(scan.integer("chosen").value() == 4);
  CHECK(scan.array("mdl")->size == 5);
  CHECK(residual.type() == "residual");
  const auto limits = residual.array("band")->as<double>();
  CHECK(limits[0] == Approx(1.0));
  CHECK(limits[1] == Approx(9.0));
  CHECK(limits[2] == Approx(10.0));
  CHECK(limits[3] == Approx(40.0));
  const auto bands = residual.array("band_residual");
  REQUIRE(bands);
  CHECK(bands->shape[0] == 2);
  for (const double value : bands->as<double>()) CHECK(value == Approx(1.0).margin(0.4));
}

TEST_CASE("maximum_likelihood.model: the first output named is the one of the record, the fit is the same") {
  Driver forward, backward;
  for (Driver* block : {&forward, &backward}) block->set("order", "4").set("delay", "2 ms");
  backward.set("outputs", std::vector<std::string>{"load", "motor"});
  run(forward, response_record(true));
  run(backward, response_record(true));
  const auto motor = records::read_model(RecordView(*forward.records()[0])),
             load = records::read_model(RecordView(*backward.records()[0]));
  REQUIRE(motor);
  REQUIRE(load);
  CHECK(load->output_name == "load");
  CHECK(*motor->cost == Approx(*load->cost).epsilon(1e-8));
  CHECK((motor->denominator - load->denominator).cwiseQuotient(motor->denominator).cwiseAbs().maxCoeff() < 1e-5);
}

TEST_CASE("maximum_likelihood.model: without variance lines weigh alike, no cost is told, and a warning says so") {
  Driver block;
  block.set("order", "4").set("delay", "estimate");
  run(block, response_record(false));
  const RecordView model(*block.records()[0]);
  CHECK_FALSE(model.number("cost"));
  CHECK(model.text("weighting").value() == "relative");
  REQUIRE_FALSE(warnings_of(model).empty());
  CHECK(warnings_of(model).front().find("the response has no variance") == 0);
  CHECK_FALSE(block.log().empty());
}

TEST_CASE("maximum_likelihood.model: a record is the same after reset, and the last response counts") {
  Driver block;
  block.set("order", "4").set("delay", "2 ms");
  block.configure();
  block.resolve({});
  block.activate(16, Rate(1, 1));
  block.receive(response_record(false), 0.0);
  block.receive(response_record(true), 0.0);
  block.finish();
  block.reset();
  block.receive(response_record(true), 0.0);
  block.finish();
  const auto bytes = bytes_of(block.records());
  REQUIRE(bytes.size() == 4);
  CHECK(bytes[0] == bytes[2]);
  CHECK(bytes[1] == bytes[3]);
}

TEST_CASE("maximum_likelihood.model: parameters that can't be meant are refused with what is allowed") {
  const RecordBuilder r = response_record(true);
  CHECK(refusal({{"order", "four"}}, r) == "order: 'four'; allowed: 0 to 30, or auto");
  CHECK(refusal({{"order", "2.5"}}, r) == "order: '2.5'; allowed: 0 to 30, or auto");
  CHECK(refusal({{"delay", "-1 ms"}}, r) == "delay: '-1 ms'; allowed: a time of at least 0, such as 150 us, or estimate");
  CHECK(refusal({{"delay", "3 m"}}, r) == "delay: '3 m'; allowed: a time of at least 0, such as 150 us, or estimate");
  CHECK(refusal({{"band", "60 Hz:70 Hz"}}, r) == "band '60 Hz:70 Hz' holds no line of the response");
  CHECK(refusal({{"input", "voltage"}}, r) == "input 'voltage' is not in the response; it has 'current'");
  CHECK(refusal({{"domain", "z"}}, response_record(true, 0.0)) ==
        "the domain z needs the sample rate of the data, and the response does not have it; choose domain: s");
  Driver fixed;
  fixed.set("order", "4").set("fixed", std::vector<std::string>{"c1 = 2"});
  CHECK(failure_of([&] { fixed.configure(); }) == "fixed: 'c1 = 2'; allowed: a coefficient and its value, such as b1 = 0");
  Driver empty;
  empty.configure();
  empty.resolve({});
  empty.activate(16, Rate(1, 1));
  CHECK(failure_of([&] { empty.finish(); }) == "no frequency response arrived");
}

TEST_CASE("maximum_likelihood.model: mean spectra with their covariance are taken where the record has them") {
  numerics::Random random(2);
  const Rational truth = ladder(2, kOmega, 0.0, 0.0);
  const maximum_likelihood::Spectra s = measured(truth, kOmega, {0.05, 0.02, 0.5}, random);
  records::ResponseData d;
  d.form = "errors_in_variables";
  d.input_names = {"u"};
  d.output_names = {"y"};
  d.response_units = {"1"};
  d.frequency_hz = kOmega / (2.0 * std::numbers::pi);
  d.response = s.response();
  d.variance = s.error_variance(d.response);
  RecordBuilder record = records::write_response(d);
  const auto put = [&](const char* name, const Eigen::MatrixXcd& m, auto zero) {
    const auto array = record.array<decltype(zero)>(name, "", {40, 1});
    for (Eigen::Index k = 0; k < 40; ++k) {
      if constexpr (std::is_same_v<decltype(zero), double>)
        array[static_cast<std::size_t>(k)] = m(k, 0).real();
      else
        array[static_cast<std::size_t>(k)] = m(k, 0);
    }
  };
  put("input_mean", s.input, Complex());
  put("output_mean", s.output, Complex());
  put("input_variance", s.input_variance.cast<Complex>(), 0.0);
  put("output_variance", s.output_variance.cast<Complex>(), 0.0);
  put("cross_covariance", s.covariance, Complex());
  Driver block;
  block.set("order", "2");
  run(block, record);
  const auto read = records::read_model(RecordView(*block.records()[0]));
  const auto expected = identify(s, settings(maximum_likelihood::Domain::s, 2));
  REQUIRE(read);
  REQUIRE(expected);
  CHECK(*read->cost == Approx(expected->test.cost).epsilon(1e-9));
}
