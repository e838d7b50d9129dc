#include <algorithm>
#include <bodeflow/numerics/chi_squared.hpp>
#include <cmath>
#include <complex>
#include <numbers>

#include "catch.hpp"
#include "models.hpp"
#include "plugins/block_driver.hpp"
#include "validation/comparison_block.hpp"
#include "validation/response_error.hpp"

using namespace bodeflow;
using namespace bodeflow::test;
using namespace bodeflow::validation;

namespace {

records::ModelData other() {
  records::ModelData m = second_order();
  m.parameters = Eigen::Vector4d(-1.48, 0.7, 0.42, 0.2);
  m.denominator = Eigen::Vector3d(1.0, -1.48, 0.7);
  m.numerator = Eigen::Vector2d(0.42, 0.2);
  m.parameter_names[3] = "other";
  return m;
}

StreamFacts facts(const char* name, const char* unit, std::int64_t length, int channels = 1) {
  StreamFacts f;
  f.known = true;
  f.channels = channels;
  f.rate = Rate(100, 1);
  f.length = length;
  f.unit = unit;
  f.channel_names.assign(static_cast<std::size_t>(channels), name);
  return f;
}

std::vector<double> list(const Eigen::VectorXd& x) { return {x.data(), x.data() + x.size()}; }

/// The record of models held against u and y.
RecordView compared(BlockDriver<ComparisonBlock>& block, const std::vector<records::ModelData>& models, const Eigen::VectorXd& u,
                    const Eigen::VectorXd& y) {
  block.configure();
  block.resolve({facts("voltage", "V", u.size()), facts("current", "A", y.size())});
  block.activate(static_cast<std::uint64_t>(u.size()), {100, 1});
  block.process({{list(u)}, {list(y)}}, static_cast<std::uint64_t>(u.size()));
  for (const auto& m : models) block.receive(records::write_model(m), 0.0);
  block.finish();
  REQUIRE(block.records().size() == 1);
  return RecordView(*block.records()[0]);
}

double value(const RecordView& r, const char* name, std::size_t i) { return r.array(name)->as<double>()[i]; }

}  // namespace

TEST_CASE("comparison: parameters side by side, and how far apart they are") {
  const ParameterTable t = parameter_table({"A", "B"}, {second_order(), other()});
  REQUIRE(t.names == std::vector<std::string>{"a1", "a2", "b1", "b2", "other"});
  CHECK(t.values(1, 0) == -1.48);
  CHECK(std::isnan(t.values(1, 3)));
  CHECK(std::isnan(t.values(0, 4)));
  CHECK(t.deviations(0, 2) == Approx(0.02));
  CHECK(t.difference(1, 0) == Approx(0.02 / std::sqrt(2e-4)));
  CHECK(std::isnan(t.difference(0, 0)));
  // Three common parameters: 0.02^2 / 2e-4 + 0 + 0.02^2 / 8e-4
  CHECK(t.probability[1] == Approx(numerics::chi_squared_tail(2.5, 3.0)));
  // Coefficients of another method are other parameters, physical ones are not.
  records::ModelData by_other_method = other();
  by_other_method.method = "elsewhere";
  const ParameterTable apart = parameter_table({"A", "B"}, {second_order(), by_other_method});
  CHECK(apart.names.front() == "a1 of A");
  CHECK(apart.names.size() == 8);
  CHECK(std::isnan(apart.probability[1]));
  records::ModelData motor = second_order();
  motor.form = by_other_method.form = "physical";
  CHECK(parameter_table({"A", "B"}, {motor, by_other_method}).difference(1, 0) == Approx(0.02 / std::sqrt(2e-4)));
  records::ModelData unsure = other();
  unsure.covariance.resize(0, 0);
  CHECK(std::isnan(parameter_table({"A", "B"}, {second_order(), unsure}).probability[1]));
}

TEST_CASE("comparison: poles and responses of models in s and z stand beside each other") {
  records::ModelData continuous;
  continuous.numerator = Eigen::VectorXd::Constant(1, 2.0);
  continuous.denominator = Eigen::Vector3d(1.0, 2.0, 101.0);  // -1 +- 10j
  continuous.delay_s = 0.1;
  records::ModelData sampled = continuous;
  sampled.sample_time_s = 0.01;
  sampled.delay_s = 0.0;
  const std::complex<double> z = std::exp(std::complex<double>(-0.01, 0.1));
  sampled.denominator = Eigen::Vector3d(1.0, -2.0 * z.real(), std::norm(z));
  for (const auto& m : {continuous, sampled}) {
    const auto poles = poles_rad_s(m);
    REQUIRE(poles);
    REQUIRE(poles->size() == 1);
    CHECK(std::abs((*poles)[0] - std::complex<double>(-1.0, 10.0)) < 1e-9);
  }
  const Eigen::VectorXcd g = model_response(continuous, Eigen::VectorXd::Constant(1, 2.5 / std::numbers::pi));  // s = 5j
  const std::complex<double> s(0.0, 5.0);
  CHECK(std::abs(g[0] - 2.0 / (s * s + 2.0 * s + 101.0) * std::exp(-0.1 * s)) < 1e-14);
  const Eigen::VectorXd grid = common_grid({continuous, sampled}, 50);
  CHECK(grid[0] == Approx(std::sqrt(101.0) / (2.0 * std::numbers::pi) / 10.0));
  CHECK(grid[49] == Approx(std::sqrt(101.0) / (2.0 * std::numbers::pi) * 10.0).epsilon(1e-6));
}

TEST_CASE("comparison block: a record with the fits of each model in the order in which they came") {
  const Eigen::VectorXd u = white(1500, 1), y = response_to(u) + white(1500, 2, 0.05);
  BlockDriver<ComparisonBlock> block;
  block.set("names", std::vector<std::string>{"right", "wrong"}).set("steps", std::int64_t{5}).set("shown", std::int64_t{100});
  const RecordView r = compared(block, {second_order(), other()}, u, y);
  CHECK(r.type() == "comparison");
  CHECK(r.texts("models") == std::vector<std::string_view>{"right", "wrong"});
  CHECK(r.integer("samples") == 1500);
  CHECK(r.integer("steps") == 5);
  CHECK(r.text("estimated") == "initial state and output offset, from these data");
  CHECK(r.texts("output_units") == std::vector<std::string_view>{"A"});
  CHECK(value(r, "fit", 0) > value(r, "fit", 1));
  CHECK(value(r, "residual_std", 0) == Approx(0.05).epsilon(0.05));
  CHECK(r.array("residual_std")->unit == "A");
  const auto simulated = r.array("simulated");
  REQUIRE(simulated);
  CHECK(std::vector<std::uint64_t>(simulated->shape.begin(), simulated->shape.end()) == std::vector<std::uint64_t>{2, 100});
  CHECK(value(r, "measured", 50) == y[50]);
  CHECK(value(r, "time", 50) == Approx(0.5));
  CHECK(r.array("cross_correlation")->shape[1] == 51);
  CHECK(r.array("poles")->shape[0] == 2);
}

TEST_CASE("comparison block: without data it holds the models beside each other") {
  BlockDriver<ComparisonBlock> block;
  block.configure();
  block.resolve({StreamFacts{}, StreamFacts{}});
  records::ModelData a = second_order(), b = other();
  a.data_checksum = b.data_checksum = "0123456789abcdef";
  block.receive(records::write_model(a), 0.0);
  block.receive(records::write_model(b), 0.0);
  block.finish();
  const RecordView r(*block.records()[0]);
  CHECK(r.texts("models") == std::vector<std::string_view>{"hand", "hand 2"});
  CHECK_FALSE(r.array("fit"));
  CHECK(r.array("parameter_difference")->shape[1] == 5);
  REQUIRE(r.texts("warnings")->size() == 1);
  CHECK(r.texts("warnings")->front().find("come from the same data") != std::string_view::npos);
}

TEST_CASE("comparison block: what can't be compared is refused by name") {
  const Eigen::VectorXd u = white(400, 1), y = response_to(u);
  const auto refusal = [](auto work) { return failure_of(work); };
  CHECK(refusal([&] {
          BlockDriver<ComparisonBlock> block;
          block.configure();
          block.resolve({facts("u", "V", 10), StreamFacts{}});
        }) == "only 'input' is connected; needed: both, or none");
  CHECK(refusal([&] {
          BlockDriver<ComparisonBlock> block;
          block.configure();
          block.resolve({facts("u", "V", 10, 2), facts("y", "A", 10)});
        }) == "'input' has 2 channels; a comparison takes one input and one output");
  CHECK(refusal([&] {
          BlockDriver<ComparisonBlock> block;
          block.configure();
          block.finish();
        }) == "no model arrived");
  CHECK(refusal([&] {
          BlockDriver<ComparisonBlock> block;
          block.set("names", std::vector<std::string>{"a", "b"});
          compared(block, {second_order()}, u, y);
        }) == "names has 2 for 1 model");
  CHECK(refusal([&] {
          BlockDriver<ComparisonBlock> block;
          Eigen::VectorXd bad = y;
          bad[17] = NAN;
          compared(block, {second_order()}, u, bad);
        }) == "output 'current': sample 17 is not finite");
  CHECK(refusal([&] {
          BlockDriver<ComparisonBlock> block;
          records::ModelData slow = second_order();
          slow.sample_time_s = 0.1;
          compared(block, {second_order(), slow}, u, y);
        }) == "model 'hand 2': its sample time is 0.1 s, that of the data 0.01 s; resample the data, or identify at this rate");
  CHECK(refusal([&] {
          BlockDriver<ComparisonBlock> block;
          block.configure();
          block.receive(RecordBuilder("trace"), 0.0);
        }) == "model 1: a record of type 'trace'; needed: model");
}

TEST_CASE("comparison block: data in other units give the same fit, another dimension is refused by name") {
  const Eigen::VectorXd u = white(600, 1), y = response_to(u) + white(600, 2, 0.05);
  const auto held_against = [&](const char* of_u, const char* of_y, const Eigen::VectorXd& in, const Eigen::VectorXd& out) {
    BlockDriver<ComparisonBlock> block;
    block.configure();
    block.resolve({facts("voltage", of_u, 600), facts("current", of_y, 600)});
    block.activate(600, {100, 1});
    block.process({{list(in)}, {list(out)}}, 600);
    block.receive(records::write_model(second_order()), 0.0);
    block.finish();
    const RecordView r(*block.records()[0]);
    return std::vector<double>{value(r, "fit", 0), value(r, "residual_std", 0)};
  };
  const auto plain = held_against("V", "A", u, y);
  const auto milli = held_against("mV", "uA", 1e3 * u, 1e6 * y);
  CHECK(milli[0] == Approx(plain[0]).epsilon(1e-9));
  CHECK(milli[1] == Approx(1e6 * plain[1]).epsilon(1e-9));
  CHECK(held_against("", "furlongs", u, y)[0] == plain[0]);
  CHECK(failure_of([&] { held_against("m", "A", u, y); }) ==
        "model 'hand': its input is a voltage in V, 'voltage' of the data is a length in m; compare with the input that it was "
        "identified from");
  CHECK(failure_of([&] { held_against("V", "rad/s", u, y); }) ==
        "model 'hand': its output is a current in A, 'current' of the data is an angular frequency in rad/s; compare with the "
        "output that it was identified from");
}

TEST_CASE("comparison block: a model without hold has its input linear between samples, the record says so") {
  // A slow sine through 1 / (s + 5): exact at the samples.
  Eigen::VectorXd u(800), y(800);
  const double w = 20.0;
  const std::complex<double> g = 5.0 / (std::complex<double>(0.0, w) + 5.0);
  for (Eigen::Index n = 0; n < 800; ++n) {
    const auto phasor = std::polar(1.0, w * 0.01 * static_cast<double>(n));
    u[n] = phasor.imag();
    y[n] = (g * phasor).imag();
  }
  records::ModelData m;
  m.method = "hand";
  m.form = "transfer_function";
  m.order = 1;
  m.numerator = Eigen::VectorXd::Constant(1, 5.0);
  m.denominator = Eigen::Vector2d(1.0, 5.0);
  m.output_name = "speed";
  BlockDriver<ComparisonBlock> block;
  block.configure();
  block.resolve({facts("voltage", "V", 800), facts("current", "A", 800)});
  block.activate(800, {100, 1});
  block.process({{list(u)}, {list(y)}}, 800);
  for (const char* hold : {"none", "zero_order"}) {
    RecordBuilder r = records::write_model(m);
    r.set("hold", hold);
    block.receive(r, 0.0);
  }
  block.finish();
  const RecordView r(*block.records()[0]);
  CHECK(r.texts("input_between_samples") == std::vector<std::string_view>{"linear between samples", "held over each sample"});
  CHECK(value(r, "fit", 0) > 99.6);
  CHECK(value(r, "fit", 1) < 92.0);
  const auto warnings = r.texts("warnings");
  REQUIRE(warnings);
  CHECK(std::any_of(warnings->begin(), warnings->end(), [](std::string_view text) {
    return text == "model 'hand': its output is 'speed', that of the data 'current': see that both are the same quantity";
  }));
}
