#include "report/response.hpp"

#include <cmath>

#include "catch.hpp"

using namespace bodeflow::tools::report;

namespace {

Record small_response() {
  Record record;
  record.key = "r";
  record.type = "frequency_response";
  record.attributes = {{"periods", 6}, {"output_names", {"y"}}, {"input_names", {"u"}}, {"response_units", {"rad/A"}}};
  record.arrays = {{"frequency", {"Hz", {3}, {30.0, 10.0, 20.0}, {}}},
                   {"response", {"", {3, 1, 1}, {3.0, 1.0, 2.0}, {0.0, 0.0, 0.0}}},
                   {"variance", {"", {3, 1, 1}, {0.09, 0.01, 0.04}, {}}}};
  return record;
}

}  // namespace

TEST_CASE("report response: lines are in order of frequency, with their own values") {
  const Record record = small_response();
  const auto response = read_response(record);
  REQUIRE(response);
  CHECK(response->frequency == std::vector<double>{10.0, 20.0, 30.0});
  CHECK(response->value(0, 0, 0) == std::complex<double>(1.0));
  CHECK(response->variance(2, 0, 0) == 0.09);
  CHECK(response->unit(0, 0) == "rad/A");
  CHECK(response->pair_name(0, 0) == "y / u");
}

TEST_CASE("report response: the radius is the record's, else that of F(2, 2 (P - 1))") {
  Record record = small_response();
  // sqrt(s^2 nu ((1 - c)^(-1/nu) - 1)) with nu = 5
  CHECK(read_response(record)->radius(0, 0, 0) == Approx(0.1 * std::sqrt(5.0 * (std::pow(0.05, -0.2) - 1.0))));
  record.arrays.push_back({"confidence_radius", {"", {3, 1, 1}, {0.3, 0.1, 0.2}, {}}});
  CHECK(read_response(record)->radius(0, 0, 0) == 0.1);
}

TEST_CASE("report response: without degrees of freedom there is no radius") {
  Record record = small_response();
  record.attributes.erase("periods");
  CHECK(std::isnan(read_response(record)->radius(0, 0, 0)));
  record.arrays.pop_back();
  CHECK(std::isnan(read_response(record)->variance(0, 0, 0)));
}

TEST_CASE("report response: arrays that don't fit each other are no response") {
  Record record = small_response();
  record.arrays[0].second.re.pop_back();
  record.arrays[0].second.shape = {2};
  CHECK_FALSE(read_response(record));
  record = small_response();
  record.arrays[1].second.shape = {3};
  CHECK_FALSE(read_response(record));
  record = small_response();
  record.type = "model";
  CHECK_FALSE(read_response(record));
}
