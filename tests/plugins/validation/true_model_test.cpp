#include <cmath>
#include <complex>

#include "block_driver.hpp"
#include "catch.hpp"
#include "validation/response_error.hpp"
#include "validation/true_model_block.hpp"

using namespace bodeflow;
using namespace bodeflow::test;
using validation::TrueModel;

namespace {

/// G = 2 / (1 + s / 10) at two frequencies, the second 10 % too large, with a variance of 1 % of |G|^2.
records::ResponseData response() {
  records::ResponseData d;
  d.form = "known_input";
  d.input_names = {"u"};
  d.output_names = {"y"};
  d.response_units = {""};
  d.frequency_hz = Eigen::Vector2d(1.0, 2.0);
  d.response.resize(2, 1);
  for (Eigen::Index k = 0; k < 2; ++k)
    d.response(k, 0) = 2.0 / (1.0 + std::complex<double>(0.0, 2.0 * M_PI * d.frequency_hz[k]) / 10.0);
  d.variance = 0.01 * d.response.cwiseAbs2();
  d.response(1, 0) *= 1.1;
  return d;
}

void set_lag(BlockDriver<TrueModel>& block) {
  block.set("numerator", std::vector<double>{4.0}).set("denominator", std::vector<double>{0.2, 2.0});
}

}  // namespace

TEST_CASE("true model: gives the model with exact parameters, and the relative error of a response") {
  BlockDriver<TrueModel> block;
  set_lag(block);
  block.configure();
  block.resolve({});
  block.activate(1, Rate(1, 1));
  block.receive(records::write_response(response()), 0.0);
  block.finish();
  REQUIRE(block.records().size() == 2);
  const auto model = records::read_model(RecordView(*block.records()[0]));
  REQUIRE(model);
  CHECK(model->numerator == Eigen::VectorXd::Constant(1, 20.0));
  CHECK(model->denominator == Eigen::Vector2d(1.0, 10.0));
  CHECK(model->parameter_names == std::vector<std::string>{"a1", "b1"});
  CHECK(model->parameters == Eigen::Vector2d(10.0, 20.0));
  CHECK(model->covariance.isZero(0.0));
  CHECK(model->poles[0].real() == Approx(-10.0));
  const RecordView error(*block.records()[1]);
  CHECK(error.number("error_of_mean") == Approx(0.1 / std::sqrt(2.0)));
  CHECK(error.number("error_of_one_run") == Approx(std::sqrt((0.01 + 0.01 + 0.01) / 2.0)));
  CHECK(error.array("relative_error")->as<double>()[0] == Approx(0.0).margin(1e-14));
  CHECK(error.array("relative_error")->as<double>()[1] == Approx(0.1));
}

TEST_CASE("true model: a sampled model stands at z = exp(s T), its delay beside") {
  records::ModelData m;
  m.numerator = Eigen::Vector2d(0.0, 1.0);
  m.denominator = Eigen::Vector2d(1.0, -0.5);
  m.sample_time_s = 0.01;
  m.delay_s = 0.003;
  const auto g = validation::model_response(m, Eigen::VectorXd::Constant(1, 7.0));
  const std::complex<double> z = std::polar(1.0, 2.0 * M_PI * 0.07), late = std::polar(1.0, -2.0 * M_PI * 0.021);
  CHECK(std::abs(g[0] - late / (z - 0.5)) < 1e-14);
}

TEST_CASE("true model: refuses what it cannot compare, by name") {
  const auto failing = [](std::vector<double> numerator, std::vector<double> denominator, double rate) {
    return failure_of([&] {
      BlockDriver<TrueModel> block;
      block.set("numerator", numerator).set("denominator", denominator).set("sample_rate", rate);
      block.configure();
      block.resolve({});
      block.activate(1, Rate(1, 1));
      block.receive(records::write_response(response()), 0.0);
      block.finish();
    });
  };
  CHECK(failing({0.0}, {1.0, 1.0}, 0.0) == "numerator needs finite coefficients, one of them not 0");
  CHECK(failing({1.0, 0.0, 0.0}, {1.0, 1.0}, 0.0) == "the numerator has a higher degree than the denominator");
  CHECK(failing({1.0}, {1.0, 0.5}, 3.0) == "the response goes to 2 Hz, above half the sample rate of the true model");
}
