// The block: records in and out, parameters, refusals.

#include "subspace/model_block.hpp"

#include "../block_driver.hpp"
#include "../spectrum/record_bytes.hpp"
#include "catch.hpp"
#include "records/model.hpp"
#include "records/response.hpp"
#include "systems.hpp"

using namespace bodeflow;
using namespace bodeflow::test;
using subspace::ModelBlock;
using Driver = BlockDriver<ModelBlock>;

namespace {

/// One, or two by three, responses of example 2's slowest modes.
RecordBuilder response_record(bool several, std::uint64_t seed, double noise) {
  numerics::PoleResidue system = example_2();
  system.poles = system.poles.head(3).eval();
  system.residues.resize(3);
  const Eigen::VectorXd omega = geometric(5.0, 60.0, 120);
  subspace::Lines lines = test::lines_of(system, omega);
  numerics::Random random(seed);
  const double size = noise * lines.response.cwiseAbs().maxCoeff();
  for (Complex& g : lines.response.reshaped()) g += size * Complex(random.normal(), random.normal());
  records::ResponseData d;
  d.form = "known_input";
  d.input_names = {"force"};
  d.output_names = {"position"};
  d.response_units = {"m/N"};
  d.frequency_hz = omega / (2.0 * std::numbers::pi);
  d.response = lines.response.leftCols(1);
  if (several) {
    d.input_names = {"a", "b", "c"};
    d.output_names = {"x", "y"};
    d.response_units.assign(6, "m/N");
    d.response.resize(120, 6);
    for (Eigen::Index i = 0; i < 3; ++i)
      for (Eigen::Index o = 0; o < 2; ++o) d.response.col(o * 3 + i) = lines.response.col(i * 2 + o);
  }
  return records::write_response(d);
}

void run(Driver& block, const RecordBuilder& response) {
  block.configure();
  block.resolve({});
  block.activate(16, Rate(1, 1));
  block.receive(response, 0.0);
  block.finish();
}

std::string refusal(const std::vector<std::pair<std::string, std::string>>& texts) {
  return failure_of([&] {
    Driver block;
    for (const auto& [name, value] : texts) block.set(name, value);
    run(block, response_record(false, 1, 0.0));
  });
}

}  // namespace

TEST_CASE("subspace.model: one response gives a state space with its transfer function, scan and residual") {
  Driver block;
  block.set("highest_order", std::int64_t{10});
  run(block, response_record(false, 1, 0.0));
  REQUIRE(block.records().size() == 3);
  const RecordView record(*block.records()[0]), scan(*block.records()[1]), residual(*block.records()[2]);
  const auto model = records::read_model(record);
  REQUIRE(model);
  CHECK(model->method == "subspace.model");
  CHECK(model->order == 6);
  REQUIRE(model->state_space);
  CHECK(model->denominator.size() == 7);
  CHECK(record.number("rms_error").value() < 1e-10);
  CHECK(record.integer("unstable_poles") == 0);
  CHECK(scan.integer("chosen") == 6);
  CHECK(scan.text("rule")->substr(0, 19) == "singular value 6 is");
  CHECK(residual.type() == "residual");
}

TEST_CASE("subspace.model: responses of three inputs and two outputs give one system of them") {
  Driver block;
  block.set("order", "6").set("polish", std::int64_t{5});
  run(block, response_record(true, 1, 1e-4));
  const auto model = records::read_linear_model(RecordView(*block.records()[0]));
  REQUIRE(model);
  REQUIRE(model->state_space);
  CHECK(model->state_space->states() == 6);
  CHECK(model->inputs.names == std::vector<std::string>{"a", "b", "c"});
  CHECK(model->outputs.names == std::vector<std::string>{"x", "y"});
  numerics::PoleResidue truth = example_2();
  truth.poles = truth.poles.head(3).eval();
  truth.residues.resize(3);
  const Eigen::VectorXd omega = geometric(6.0, 50.0, 50);
  CHECK(relative(subspace::response_of(*model->state_space, omega), test::lines_of(truth, omega).response) < 1e-3);
}

TEST_CASE("subspace.model: poles lie in their 95 % regions as often as they should") {
  const Eigen::VectorXcd truth = example_2().poles.head(3);
  int inside = 0, all = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    Driver block;
    block.set("order", "6");
    run(block, response_record(false, seed, 1e-5));  // so small that three modes within 6 % of their frequencies stay apart
    const RecordView record(*block.records()[0]);
    const auto model = records::read_model(record);
    REQUIRE(model);
    const auto covariances = record.array("pole_covariance");
    REQUIRE(covariances);
    REQUIRE(covariances->size == 24);
    CHECK(model->covariance.rows() == 13);
    for (const Complex p : truth) {
      Eigen::Index nearest = 0;
      (model->poles.array() - p).abs().minCoeff(&nearest);
      const Complex away = model->poles[nearest] - p;
      const Eigen::Vector2d d(away.real(), away.imag());
      const Eigen::Map<const Eigen::Matrix2d> covariance(covariances->as<double>().data() + 4 * nearest);
      inside += d.dot(covariance.inverse() * d) < 5.991 ? 1 : 0;
      ++all;
    }
  }
  CHECK(inside >= 0.88 * all);  // 95 % expected; three deviations of 180
  CHECK(inside < all);
}

TEST_CASE("subspace.model: where the model has no covariance it says why") {
  Driver block;
  block.set("order", "6").set("polish", std::int64_t{0});
  run(block, response_record(false, 1, 1e-3));
  const RecordView record(*block.records()[0]);
  CHECK_FALSE(record.array("pole_covariance"));
  const auto warnings = warnings_of(record);
  CHECK(std::count(warnings.begin(), warnings.end(),
                   "the model has no covariance: it is that of a least-squares minimum; polish the model") == 1);
}

TEST_CASE("subspace.model: refusals say what is allowed") {
  CHECK(refusal({{"order", "0"}}) == "order: '0'; allowed: 1 to 1000, or auto");
  CHECK(refusal({{"functions", "many"}}) == "functions: 'many'; allowed: 2 to 2000, or auto");
  CHECK(refusal({{"prewarp", "20"}}) ==
        "prewarp: '20'; allowed: bandwidth, scan, or a frequency above 0 with its unit, such as 20 Hz");
  CHECK(refusal({{"domain", "z"}}) == "domain: z needs a response with its sample rate");
  CHECK(refusal({{"weighting", "variance"}}) == "weighting: variance needs a response with its variance; this one has none");
  CHECK(refusal({{"order", "200"}}) == "order 200; allowed with 120 basis functions: 1 to 119");
  CHECK(failure_of([] {
          Driver block;
          block.configure();
          block.resolve({});
          block.activate(16, Rate(1, 1));
          block.finish();
        }) == "no frequency response arrived");
}
