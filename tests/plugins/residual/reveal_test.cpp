#include "blocks/reveal.hpp"

#include "catch.hpp"

using namespace bodeflow::residual;

namespace {
const std::vector<std::string> kAll = {"delay", "dead_time", "saturation"};

std::vector<HiddenTruth> hidden(std::initializer_list<const char*> names) {
  std::vector<HiddenTruth> all;
  for (const char* name : names) all.push_back({name, 1.0, ""});
  return all;
}
}  // namespace

TEST_CASE("reveal: what counts as right") {
  CHECK(is_right({"none", {}, {}, kAll}, {}));
  CHECK_FALSE(is_right({"unexplained", {}, {}, kAll}, {}));
  CHECK(is_right({"named", {"dead_time"}, {}, kAll}, hidden({"dead_time"})));
  CHECK(is_right({"named", {"dead_time at inverter"}, {}, kAll}, hidden({"dead_time"})));
  CHECK_FALSE(is_right({"named", {"dead_time"}, {}, kAll}, hidden({"delay"})));
  CHECK_FALSE(is_right({"none", {}, {}, kAll}, hidden({"delay"})));
  CHECK(is_right({"not_separable", {"delay"}, {"skin_effect"}, kAll}, hidden({"delay"})));
  CHECK(is_right({"not_separable", {"delay"}, {"skin_effect"}, kAll}, hidden({"skin_effect"})));
  CHECK_FALSE(is_right({"not_separable", {"delay"}, {"skin_effect"}, kAll}, hidden({"saturation"})));
  CHECK(is_right({"unexplained", {}, {}, kAll}, hidden({"hum"})));
  CHECK_FALSE(is_right({"unexplained", {}, {}, kAll}, hidden({"saturation"})));
}

TEST_CASE("reveal: of two hidden effects both have to be named, and no third") {
  CHECK(is_right({"named", {"dead_time", "delay"}, {}, kAll}, hidden({"delay", "dead_time"})));
  CHECK(is_right({"not_separable", {"dead_time", "delay"}, {"skin_effect"}, kAll}, hidden({"skin_effect", "dead_time"})));
  CHECK_FALSE(is_right({"named", {"dead_time"}, {}, kAll}, hidden({"delay", "dead_time"})));
  CHECK_FALSE(is_right({"named", {"dead_time", "delay", "saturation"}, {}, kAll}, hidden({"delay", "dead_time"})));
  CHECK(is_right({"unexplained", {}, {}, kAll}, hidden({"delay", "hum"})));
  CHECK_FALSE(is_right({"unexplained", {}, {}, kAll}, hidden({"delay", "dead_time"})));
}

TEST_CASE("reveal: says it in a sentence") {
  CHECK(comparison({"not_separable", {"delay"}, {"skin_effect"}, kAll}, {{"delay", 2e-4, "s"}}) ==
        "Right: the bench hid delay (200 us); the trace said that delay or skin_effect is missing.");
  CHECK(comparison({"named", {"delay"}, {}, kAll}, {}) == "Wrong: the bench hid nothing; the trace said that delay is missing.");
  CHECK(comparison({"named", {"delay", "dead_time"}, {}, kAll}, {{"delay", 2e-4, "s"}, {"dead_time", 1e-6, "s"}}) ==
        "Right: the bench hid delay (200 us) and dead_time (1 us); the trace said that delay and dead_time are missing.");
}

TEST_CASE("reveal: the true parameters of Table 1") {
  const Eigen::Vector4d p = motor_truth(6.6, 5.5, 0.475, 0.475, 0.454);
  CHECK(p[0] == Approx(283.0287).epsilon(1e-6));
  CHECK(p[1] == Approx(11.57895).epsilon(1e-6));
  CHECK(p[2] == Approx(10.56518).epsilon(1e-6));
  CHECK(p[3] == Approx(0.04107158).epsilon(1e-6));
}
