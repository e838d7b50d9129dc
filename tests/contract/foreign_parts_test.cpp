#include <cmath>
#include <iostream>

#include "catch.hpp"
#include "runtime/plugins/shelf.hpp"

using namespace bodeflow;
using namespace bodeflow::test;

namespace {

/// The parts of the foreign plugin; nothing where there is no clang with libc++.
std::unique_ptr<Shelf> foreign() {
  const std::filesystem::path file = BODEFLOW_FOREIGN_PLUGIN;
  if (!file.empty()) return std::make_unique<Shelf>(std::vector{file});
  std::cout << "skipped: clang++-14 with libc++ is not installed\n";
  return nullptr;
}

Situation situation() {
  Situation s;
  s.place.name = "left";
  s.place.flow_unit = "m/s";
  s.place.reaction_unit = "N";
  s.line_hz = {1.0, 2.0};
  s.missing = {{3.0, 4.0}, {0.0, 1.0}};
  return s;
}

}  // namespace

TEST_CASE("an effect of a libc++ plugin is an Effect here: text, lists and numbers pass both ways") {
  const auto shelf = foreign();
  if (!shelf) return;
  CHECK(shelf->refused.empty());
  const auto listed = shelf->parts().effects();
  REQUIRE(listed.size() == 1);
  CHECK(listed[0].summary == "Brakes in a library of its own.");
  CHECK(listed[0].kinds == std::vector<std::string>{"bearing"});
  const auto drag = shelf->parts().effect("foreign.drag");
  CHECK(drag->parameters(situation()).at(0).unit == "N/(m/s)");
  CHECK(drag->starts(situation()) == std::vector<std::vector<double>>{{5.0}, {1.0, 2.0}});
  const std::vector<double> value{2.5};
  CHECK(drag->sentence(value, value, situation()) == "drag of 2.5 at the left");
  double next = 0.0;
  const double memory = 1.0;
  Signals s;
  s.flow = 3.0, s.step_s = 0.5;
  CHECK(drag->react(value.data(), s, &memory, &next).value == 7.5);
  CHECK(next == 1.5);
}

TEST_CASE("exceptions of a libc++ effect stay there, and their words arrive") {
  const auto shelf = foreign();
  if (!shelf) return;
  const auto drag = shelf->parts().effect("foreign.drag");
  const double value = 1.0, memory = 0.0;
  double next = 0.0;
  Signals s;
  s.flow = 13.0;
  for (int i = 0; i < 100; ++i) {
    CHECK(std::isnan(drag->react(&value, s, &memory, &next).value));
    CHECK(failure_of([&] { (void)drag->starts({}); }) == "thirteen again (13)");
  }
  CHECK(shelf->log ==
        std::vector<std::string>{"2 effect 'foreign.drag': react failed and gives no number: thirteen again (13) (told once)"});
}

TEST_CASE("a base model of a libc++ plugin is a BaseModel here") {
  const auto shelf = foreign();
  if (!shelf) return;
  const auto cart = shelf->parts().base_model("foreign.cart", {"rails=[front, rear, roof]", "delay=250 us"});
  CHECK(cart->timing().hold == Hold::zero_order);
  CHECK(cart->timing().delay_s == 250e-6);
  const auto places = cart->places();
  REQUIRE(places.size() == 3);
  CHECK(places[2].name == "roof");
  LinearPlant plant;
  const double mass = 4.0;
  REQUIRE(cart->state_space(&mass, nullptr, plant));
  CHECK(plant.E == std::vector<double>{-0.25, -0.25, -0.25});
  CHECK(plant.Ff == std::vector<double>(9, 0.0));
  MeasuredResponse measured;
  measured.frequency_hz = {7.0, 8.0};
  CHECK(cart->starts({&measured, 1}) == std::vector<std::vector<double>>{{7.0, 8.0}});
}
