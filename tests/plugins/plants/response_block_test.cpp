// plants.response: the response of a known model as an instrument would give it.

#include "response_block.hpp"

#include <cmath>
#include <numbers>

#include "catch.hpp"
#include "plugins/block_driver.hpp"
#include "plugins/spectrum/record_bytes.hpp"
#include "records/response.hpp"

using namespace bodeflow;
using plants::ResponseBlock;
using Driver = test::BlockDriver<ResponseBlock>;
using Complex = std::complex<double>;

namespace {

/// 2 / (s + 3), 5 ms late.
RecordBuilder lag() {
  records::ModelData m;
  m.method = "hand";
  m.form = "transfer_function";
  m.order = 1;
  m.numerator = Eigen::VectorXd::Constant(1, 2.0);
  m.denominator = Eigen::Vector2d(1.0, 3.0);
  m.delay_s = 0.005;
  m.input_name = "u";
  m.output_name = "y";
  m.input_unit = "V";
  m.output_unit = "A";
  return records::write_model(m);
}

Complex lag_at(double hertz) {
  const Complex s(0.0, 2.0 * std::numbers::pi * hertz);
  return 2.0 / (s + 3.0) * std::exp(-0.005 * s);
}

Driver& ready(Driver& block, double first, double last, std::int64_t count) {
  return block.set("first", first).set("last", last).set("count", count);
}

records::ResponseData run(Driver& block) {
  block.configure();
  block.resolve({});
  block.activate(16, Rate(1, 1));
  block.receive(lag(), 0.0);
  block.finish();
  REQUIRE(block.records().size() == 1);
  auto read = records::read_response(RecordView(*block.records()[0]));
  REQUIRE(read);
  return *read;
}

}  // namespace

TEST_CASE("plants.response: without noise it is the model's response with its delay") {
  Driver block;
  const auto r = run(ready(block, 0.1, 10.0, 21));
  REQUIRE(r.frequency_hz.size() == 21);
  CHECK(r.frequency_hz[0] == Approx(0.1));
  CHECK(r.frequency_hz[10] == Approx(1.0));
  CHECK(r.frequency_hz[20] == Approx(10.0));
  for (Eigen::Index k = 0; k < 21; ++k) CHECK(std::abs(r.response(k, 0) - lag_at(r.frequency_hz[k])) < 1e-12);
  CHECK(r.variance.size() == 0);
  CHECK(r.input_names == std::vector<std::string>{"u"});
  CHECK(r.output_names == std::vector<std::string>{"y"});
  CHECK(r.response_units == std::vector<std::string>{"A/V"});
}

TEST_CASE("plants.response: linear spacing may begin at zero") {
  Driver block;
  const auto r = run(ready(block, 0.0, 10.0, 11).set("spacing", "linear"));
  for (Eigen::Index k = 0; k < 11; ++k) CHECK(r.frequency_hz[k] == Approx(static_cast<double>(k)));
  CHECK(r.response(0, 0).real() == Approx(2.0 / 3.0));
}

TEST_CASE("plants.response: the noise has the variance that the record states") {
  Driver block;
  const auto r =
      run(ready(block, 0.1, 10.0, 20000).set("noise.relative", 0.02).set("noise.absolute", 0.01).set("seed", std::int64_t{5}));
  REQUIRE(r.variance.rows() == 20000);
  const double largest = std::abs(lag_at(0.1));
  double power = 0.0;
  Complex squares = 0.0;
  for (Eigen::Index k = 0; k < 20000; ++k) {
    const Complex g = lag_at(r.frequency_hz[k]);
    const double expected = std::norm(0.02 * g) + std::pow(0.01 * largest, 2);
    REQUIRE(r.variance(k, 0) == Approx(expected));
    const Complex e = (r.response(k, 0) - g) / std::sqrt(expected);
    power += std::norm(e) / 20000.0;
    squares += e * e / 20000.0;
  }
  CHECK(power == Approx(1.0).epsilon(0.03));
  CHECK(std::abs(squares) < 0.03);  // as much in the real as in the imaginary part, and apart
}

TEST_CASE("plants.response: scatter is one factor of all lines that the record does not state") {
  Driver block;
  const auto r = run(ready(block, 0.1, 10.0, 30).set("scatter", 0.1).set("seed", std::int64_t{2}));
  const Complex factor = r.response(0, 0) / lag_at(r.frequency_hz[0]);
  CHECK(std::abs(factor - 1.0) > 1e-3);
  CHECK(std::abs(factor - 1.0) < 0.5);
  for (Eigen::Index k = 0; k < 30; ++k) CHECK(std::abs(r.response(k, 0) / lag_at(r.frequency_hz[k]) - factor) < 1e-12);
  CHECK(r.variance.size() == 0);
}

TEST_CASE("plants.response: a seed fixes the noise and the variance can be kept back") {
  const auto with = [](std::int64_t seed) {
    Driver block;
    return run(ready(block, 0.1, 10.0, 5).set("noise.relative", 0.1).set("seed", seed).set("variance", false));
  };
  CHECK(with(1).response == with(1).response);
  CHECK(with(1).response != with(2).response);
  CHECK(with(1).variance.size() == 0);
}

TEST_CASE("plants.response: refusals say what is wrong") {
  const auto refusal = [](double first, double last) {
    return test::failure_of([&] {
      Driver block;
      run(ready(block, first, last, 10));
    });
  };
  CHECK(refusal(2.0, 1.0) == "last must be above first");
  CHECK(refusal(0.0, 1.0) == "first must be above 0 Hz for logarithmic spacing");
  CHECK(test::failure_of([&] {
          Driver block;
          ready(block, 1.0, 2.0, 10).configure();
          block.resolve({});
          block.activate(16, Rate(1, 1));
          block.finish();
        }) == "no model arrived");
}
