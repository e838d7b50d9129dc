#include "report/model.hpp"

#include <cmath>
#include <numbers>

#include "catch.hpp"
#include "report/pole_zero.hpp"

using namespace bodeflow::tools::report;

namespace {

/// 100 / (s^2 + 2 s + 100).
Record second_order() {
  Record record;
  record.key = "m";
  record.type = "model";
  record.attributes = {{"form", "transfer_function"}, {"sample_time", 0.0}};
  record.arrays = {{"numerator", {"", {1}, {100.0}, {}}}, {"denominator", {"", {3}, {1.0, 2.0, 100.0}, {}}}};
  return record;
}

std::size_t count(const std::string& text, const std::string& word) {
  std::size_t found = 0;
  for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++found;
  return found;
}

}  // namespace

TEST_CASE("report model: a transfer function is evaluated over frequency, its delay included") {
  Record record = second_order();
  const double f = 10.0 / (2.0 * std::numbers::pi);  // s = 10 i: G = 100 / (20 i)
  auto value = read_model(record)->responses({f})[0][0];
  CHECK(value.real() == Approx(0.0).margin(1e-12));
  CHECK(value.imag() == Approx(-5.0));
  record.attributes["delay"] = std::numbers::pi / 20.0;  // a quarter turn more at 10 rad/s
  value = read_model(record)->responses({f})[0][0];
  CHECK(value.real() == Approx(-5.0));
}

TEST_CASE("report model: the same plant in states gives the same curve") {
  Record states;
  states.type = "model";
  states.attributes = {{"form", "state_space"}};
  states.arrays = {{"A", {"", {2, 2}, {0.0, 1.0, -100.0, -2.0}, {}}},
                   {"B", {"", {2, 1}, {0.0, 100.0}, {}}},
                   {"C", {"", {1, 2}, {1.0, 0.0}, {}}},
                   {"D", {"", {1, 1}, {0.0}, {}}}};
  const Record transfer = second_order();
  const std::vector<double> frequency{0.1, 1.0, 1.6, 5.0};
  const auto a = read_model(transfer)->responses(frequency)[0], b = read_model(states)->responses(frequency)[0];
  for (std::size_t k = 0; k < frequency.size(); ++k) CHECK(std::abs(a[k] - b[k]) < 1e-12);
}

TEST_CASE("report model: many states of several inputs and outputs give each entry its own response") {
  // State n decays with n + 1 and goes from input n % 2 to output n / 2 % 3.
  const std::size_t states = 40;
  const double delay = 0.01;
  Record record;
  record.type = "model";
  record.attributes = {{"form", "state_space"}, {"delay", delay}};
  std::vector<double> A(states * states), B(states * 2), C(3 * states);
  for (std::size_t n = 0; n < states; ++n) {
    A[n * states + n] = -(static_cast<double>(n) + 1.0);
    B[n * 2 + n % 2] = 1.0;
    C[n / 2 % 3 * states + n] = 1.0;
  }
  record.arrays = {{"A", {"", {states, states}, A, {}}},
                   {"B", {"", {states, 2}, B, {}}},
                   {"C", {"", {3, states}, C, {}}},
                   {"D", {"", {3, 2}, {1.0, 2.0, 3.0, 4.0, 5.0, 6.0}, {}}}};
  const std::vector<double> frequency{0.1, 1.0, 7.0};
  const auto found = read_model(record)->responses(frequency);
  REQUIRE(found.size() == 6);
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 2; ++j)
      for (std::size_t k = 0; k < frequency.size(); ++k) {
        const std::complex<double> s(0.0, 2.0 * std::numbers::pi * frequency[k]);
        std::complex<double> expected = 1.0 + static_cast<double>(i * 2 + j);
        for (std::size_t n = 0; n < states; ++n)
          if (n % 2 == j && n / 2 % 3 == i) expected += 1.0 / (s + static_cast<double>(n) + 1.0);
        CHECK(std::abs(found[i * 2 + j][k] - expected * std::exp(-s * delay)) < 1e-11);
      }
}

TEST_CASE("report model: a model fitted to samples of a held input is drawn as these samples see it") {
  // 3 a / (s + a), late by 1.5 samples of 10 ms: y[n+1] = c y[n] + 3 (1 - d) u[n-1] + 3 (d - c) u[n-2], c and d over a sample and
  // half of one.
  const double a = 30.0, h = 0.01, c = std::exp(-a * h), d = std::exp(-0.5 * a * h), f = 12.0;
  Record record;
  record.type = "model";
  record.attributes = {
      {"form", "transfer_function"}, {"sample_time", 0.0}, {"delay", 1.5 * h}, {"hold", "zero_order"}, {"sample_rate", 100.0}};
  record.arrays = {{"numerator", {"", {1}, {3.0 * a}, {}}}, {"denominator", {"", {2}, {1.0, a}, {}}}};
  const std::complex<double> z = std::polar(1.0, 2.0 * std::numbers::pi * f * h);
  const std::complex<double> expected = 3.0 * ((1.0 - d) / z + (d - c) / (z * z)) / (z - c);
  CHECK(std::abs(read_model(record)->responses({f})[0][0] - expected) < 1e-12);
  record.attributes["hold"] = "none";
  const std::complex<double> s(0.0, 2.0 * std::numbers::pi * f);
  CHECK(std::abs(read_model(record)->responses({f})[0][0] - 3.0 * a / (s + a) * std::exp(-1.5 * h * s)) < 1e-12);
}

TEST_CASE("report model: arrays that don't fit each other can't be evaluated") {
  Record record = second_order();
  record.arrays[1].second.shape = {1, 3};
  CHECK_FALSE(read_model(record));
  record = second_order();
  record.attributes["form"] = "state_space";
  CHECK_FALSE(read_model(record));
  record = second_order();
  record.arrays[0].second = {"", {0}, {}, {}};
  CHECK_FALSE(read_model(record));
}

TEST_CASE("report model: roots come from the record, with covariance where it fits, else from the polynomials") {
  Record record = second_order();
  auto poles = roots_of(record, true);
  REQUIRE(poles.size() == 2);
  CHECK(std::abs(poles[0].value) == Approx(10.0));
  CHECK_FALSE(poles[0].has_covariance);
  CHECK(roots_of(record, false).empty());
  record.arrays.push_back({"poles", {"rad/s", {2}, {-1.0, -1.0}, {9.0, -9.0}}});
  record.arrays.push_back({"pole_covariance", {"", {2, 2, 2}, {1.0, 0.5, 0.5, 4.0, 1.0, -0.5, -0.5, std::nan("")}, {}}});
  poles = roots_of(record, true);
  CHECK(poles[0].value == std::complex<double>(-1.0, 9.0));
  CHECK(poles[0].has_covariance);
  CHECK(poles[0].imaginary_variance == 4.0);
  CHECK_FALSE(poles[1].has_covariance);
}

TEST_CASE("report model: the pole-zero map draws every root, an ellipse where it is known, and names the plane") {
  Record record = second_order();
  record.arrays.push_back({"poles", {"rad/s", {2}, {-1.0, -1.0}, {9.0, -9.0}}});
  record.arrays.push_back({"zeros", {"rad/s", {2}, {-3.0, -1e6}, {0.0, 0.0}}});
  record.arrays.push_back({"pole_covariance", {"", {2, 2, 2}, {1.0, 0.5, 0.5, 4.0, 1.0, -0.5, -0.5, 4.0}, {}}});
  const auto picture = draw_pole_zero(record, 940.0);
  REQUIRE(picture);
  CHECK(count(picture->body.str(), "class=\"a0\"") == 3);  // two ellipses and the legend
  CHECK(count(picture->body.str(), "class=\"r1\"") == 2);  // the near zero and the legend; the far one stands in the table
  CHECK(picture->description == "2 poles and 1 zeros in the s plane.");
  CHECK_FALSE(is_z_plane(record));
  record.attributes["sample_time"] = 0.001;
  CHECK_FALSE(is_z_plane(record));  // the unit says rad/s
  record.arrays[2].second.unit = "";
  CHECK(is_z_plane(record));
  CHECK_FALSE(draw_pole_zero(Record{}, 940.0));
}
