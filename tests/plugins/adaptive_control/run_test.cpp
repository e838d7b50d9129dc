#include "catch.hpp"
#include "loop.hpp"

using namespace bodeflow::test;

namespace {

/// Replays a reference run through the whole scheme and gives the largest differences to it.
struct Differences {
  double y = 0.0, u = 0.0, response = 0.0, coefficients = 0.0;
};

Differences replay(const std::string& name, double p0) {
  auto columns = csv_columns(std::string(BODEFLOW_TEST_DATA "/adaptive_control/") + name);
  Example e = example_1();
  without_nets(e);
  e.bank.point.p0 = p0;
  ac::AdaptiveController controller(*ac::EstimatorBank::make(e.bank), *ac::Designer::make(e.design), ac::RstController());
  SimulatedPlant plant(e.plant, e.delay);
  Differences d;
  for (std::size_t k = 0; k < columns["k"].size(); ++k) {
    const double y = plant.output() + (columns.count("e") != 0 ? columns["e"][k] : 0.0);
    const double u = controller.step(y, columns["uc"][k]);
    plant.input(u + columns["vl"][k]);
    d.y = std::max(d.y, std::abs(y - columns["y"][k]));
    d.u = std::max(d.u, std::abs(u - columns["u"][k]));
    if (k < 30) continue;
    for (std::size_t j = 0; j < 3; ++j) {
      const std::string n = std::to_string(j + 1);
      const std::complex<double> expected{columns["ReG" + n][k], columns["ImG" + n][k]};
      d.response = std::max(d.response, std::abs(controller.bank().response()[j] - expected));
    }
    if (k < 80) continue;
    const ac::Rst& rst = controller.rst();
    for (std::size_t i = 0; i < 3; ++i) {
      const std::string n = std::to_string(i);
      d.coefficients = std::max({d.coefficients, std::abs(rst.r[i] - columns["r" + n][k]),
                                 std::abs(rst.s[i] - columns["s" + n][k]), std::abs(rst.t[i] - columns["t" + n][k])});
    }
  }
  return d;
}

}  // namespace

TEST_CASE("the base line of example 1 follows the reference run to 1e-8 in every sample") {
  const Differences d = replay("ex1_base_closed_loop.csv", 1e6);
  CHECK(d.y < 1e-8);
  CHECK(d.u < 1e-8);
  CHECK(d.response < 1e-8);
  CHECK(d.coefficients < 1e-6);
}

TEST_CASE("the noisy run of example 1 follows the reference run to 1e-8") {
  const Differences d = replay("ex1_noise_sigma0.05_closed_loop.csv", 1e4);
  CHECK(d.y < 1e-8);
  CHECK(d.u < 1e-8);
  CHECK(d.response < 1e-8);
}
