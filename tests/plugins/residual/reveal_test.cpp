#include "reveal.hpp"

#include "catch.hpp"

using namespace bodeflow::residual;

namespace {
const std::vector<std::string> kAll = {"delay", "dead_time", "saturation"};
}

TEST_CASE("reveal: what counts as right") {
  CHECK(is_right({"none", {}, {}, kAll}, "none"));
  CHECK_FALSE(is_right({"unexplained", {}, {}, kAll}, "none"));
  CHECK(is_right({"named", {"dead_time"}, {}, kAll}, "dead_time"));
  CHECK_FALSE(is_right({"named", {"dead_time"}, {}, kAll}, "delay"));
  CHECK_FALSE(is_right({"none", {}, {}, kAll}, "delay"));
  CHECK(is_right({"not_separable", {"delay"}, {"skin_effect"}, kAll}, "delay"));
  CHECK(is_right({"not_separable", {"delay"}, {"skin_effect"}, kAll}, "skin_effect"));
  CHECK_FALSE(is_right({"not_separable", {"delay"}, {"skin_effect"}, kAll}, "saturation"));
  CHECK(is_right({"unexplained", {}, {}, kAll}, "hum"));
  CHECK_FALSE(is_right({"unexplained", {}, {}, kAll}, "saturation"));
}

TEST_CASE("reveal: says it in a sentence") {
  CHECK(comparison({"not_separable", {"delay"}, {"skin_effect"}, kAll}, "delay", 2e-4, "s") ==
        "Right: the bench hid delay (0.0002 s); the trace said that delay or skin_effect is missing.");
  CHECK(comparison({"named", {"delay"}, {}, kAll}, "none", 0, "") ==
        "Wrong: the bench hid nothing; the trace said that delay is missing.");
}

TEST_CASE("reveal: the true parameters of Table 1") {
  const Eigen::Vector4d p = motor_truth(6.6, 5.5, 0.475, 0.475, 0.454);
  CHECK(p[0] == Approx(283.0287).epsilon(1e-6));
  CHECK(p[1] == Approx(11.57895).epsilon(1e-6));
  CHECK(p[2] == Approx(10.56518).epsilon(1e-6));
  CHECK(p[3] == Approx(0.04107158).epsilon(1e-6));
}
