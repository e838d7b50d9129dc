#include "catch.hpp"
#include "loop.hpp"

using namespace bodeflow::test;

namespace {

std::string refusal(const std::function<void(ac::DesignerSettings&)>& spoil) {
  ac::DesignerSettings s = example_1().design;
  spoil(s);
  const auto made = ac::Designer::make(s);
  return made ? std::string() : made.error().text;
}

}  // namespace

TEST_CASE("the design refuses wrong use by name") {
  CHECK(refusal([](auto&) {}).empty());
  CHECK(refusal([](auto& s) {
          s.structure.omega = {0.1, 0.3};
        }) == "2 frequencies of fitting for 5 unknown parameters; needed: at least 3 (3.27)");
  CHECK(refusal([](auto& s) {
          s.structure.omega = {0.1, 0.3, 3.5};
        }) == "frequency of fitting 3.5 rad/s; allowed: above 0 and below the Nyquist frequency 3.14159 rad/s");
  CHECK(refusal([](auto& s) { s.structure.omega = {0.1, 0.3, 0.3}; }) == "frequency of fitting 0.3 rad/s stands twice");
  CHECK(refusal([](auto& s) {
          s.structure.r_p = poly({1, -1.2});
        }) == "the prescribed factor of R is unstable: it has the root 1.2; allowed: roots inside or on the unit circle");
  CHECK(refusal([](auto& s) {
          s.structure.s_p = poly({1, 1.5});
        }) == "the prescribed factor of S is unstable: it has the root -1.5; allowed: roots inside or on the unit circle");
  CHECK(refusal([](auto& s) { s.structure.r_p = poly({2, -1}); }) == "the prescribed factor of R is not monic");
  CHECK(refusal([](auto& s) { s.structure.n_s = 3; }) ==
        "degree of S is 3, that of R is 2; allowed: no more than that, or the controller is not causal");
  CHECK(refusal([](auto& s) { s.structure.weights = {1, 2}; }) == "2 weights for 3 frequencies; allowed: one each");
  CHECK(refusal([](auto& s) { s.structure.weights = {1, 0, 1}; }) == "weight 0; allowed: above 0");
  CHECK(refusal([](auto& s) {
          s.desired.a_m = poly({1, -0.1});
        }) == "the desired response has a pole at 0.1 rad/s; allowed: the open left half plane");
  CHECK(refusal([](auto& s) {
          s.desired.a_o = poly({1, 0, 1});
        }) == "the observer polynomial has a pole at 0 + 1 i rad/s; allowed: the open left half plane");
  CHECK(refusal([](auto& s) { s.desired.a_o = ac::bessel(3, 0.5); }) ==
        "the observer polynomial has degree 3, R has 2; allowed: no more than that");
  CHECK(refusal([](auto& s) {
          s.desired_points = {1.0, 0.5};
        }) == "2 points of the desired response for 3 frequencies; allowed: one each");
  CHECK(refusal([](auto& s) {
          s.desired_points = {1.0, 0.0, 1.0};
        }) == "the desired response is 0 at 0.3 rad/s; allowed: finite and not 0");
  CHECK(refusal([](auto& s) { s.rate = 0.0; }) == "rate 0; allowed: above 0, up to 1");
}

TEST_CASE("a response of zero or without a number gives no design, and the last controller stays") {
  auto designer = ac::Designer::make(example_1().design);
  REQUIRE(designer);
  const auto truth = true_response(example_1());
  for (int k = 0; k < 100; ++k) designer->step(truth.data());
  REQUIRE(designer->adapted());
  const ac::Rst before = designer->step(truth.data());
  const std::vector<std::complex<double>> zero(3), wrong(3, {std::nan(""), 0.0});
  CHECK(designer->step(zero.data()).s == before.s);
  CHECK(designer->step(wrong.data()).s == before.s);
  CHECK(designer->acted(ac::Net::kept) == 2);
}

TEST_CASE("the desired response as points gives the design of its transfer function") {
  ac::DesignerSettings s = example_1().design;
  const auto truth = true_response(example_1());
  s.ladder_steps = 1;
  auto by_function = ac::Designer::make(s);
  s.desired_points = *ac::desired_points(s.desired, 1.0, s.structure.omega);
  auto by_points = ac::Designer::make(s);
  by_function->step(truth.data());
  by_points->step(truth.data());
  CHECK(by_function->accepted().rst.s == by_points->accepted().rst.s);
  CHECK(by_function->level() == 0);
}
