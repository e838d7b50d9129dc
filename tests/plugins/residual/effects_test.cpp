#include <cmath>

#include "catalogue.hpp"
#include "catch.hpp"

using namespace bodeflow::residual;

TEST_CASE("catalogue: effects by name, all without names, unknown and repeated ones refused") {
  CHECK(catalogue().value().size() == effect_names().size());
  CHECK(catalogue({"saturation", "delay"}).value()[0]->name() == "saturation");
  CHECK(catalogue({"skin"}).error().text == "effect 'skin' is not known; there are: delay, dead_time, saturation");
  CHECK(catalogue({"delay", "delay"}).error().text == "effect 'delay' is named twice");
}

TEST_CASE("effects: starts lie within the bounds and have a value for each parameter") {
  const Catalogue effects = catalogue().value();
  for (const auto& effect : effects) {
    const auto parameters = effect->parameters();
    for (const Eigen::VectorXd& start : effect->starts({1e-3, 20, 4, 0.8})) {
      REQUIRE(static_cast<std::size_t>(start.size()) == parameters.size());
      for (std::size_t i = 0; i < parameters.size(); ++i) {
        CHECK(beyond(parameters[i], start[static_cast<Eigen::Index>(i)]).empty());
        const double v = start[static_cast<Eigen::Index>(i)];
        CHECK(value(parameters[i], coordinate(parameters[i], v)) == Approx(v).margin(1e-15));
      }
    }
  }
}

TEST_CASE("effects: what is stored in addition has the slope that it says") {
  const auto effects = catalogue({"saturation"}).value();
  const double p[] = {0.7, 5.0, 2.5}, h = 1e-6;
  for (const double flux : {-0.9, -0.2, 0.05, 0.4, 1.3}) {
    const double wanted = (effects[0]->extra_stored(p, flux + h).value - effects[0]->extra_stored(p, flux - h).value) / (2 * h);
    CHECK(effects[0]->extra_stored(p, flux).slope == Approx(wanted).epsilon(1e-6));
    CHECK(effects[0]->extra_stored(p, -flux).value == -effects[0]->extra_stored(p, flux).value);
  }
}

TEST_CASE("effects: a dead time takes its voltage in the direction of the current, and less where it would turn it around") {
  const auto effects = catalogue({"dead_time"}).value();
  const double p[] = {10.0, 0.01};
  CHECK(effects[0]->effort_lost(p, 1.0, 0.002) == 10.0);
  CHECK(effects[0]->effort_lost(p, -1.0, 0.002) == -10.0);
  CHECK(effects[0]->effort_lost(p, 0.015, 0.002) == Approx(5.0));
}
