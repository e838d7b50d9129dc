#include <Eigen/Eigenvalues>
#include <bodeflow/numerics/frequency_response.hpp>
#include <cmath>
#include <complex>
#include <numbers>

#include "catch.hpp"
#include "ladder.hpp"
#include "modes.hpp"

using namespace bodeflow;
using namespace bodeflow::plants;
using Complex = std::complex<double>;

namespace {

/// The ladder by complex impedances from its end to the terminal: another way to the same response.
Complex by_impedances(const Ladder& l, double f) {
  const Complex s(0.0, 2.0 * std::numbers::pi * f);
  Complex gain = 1.0, behind = l.pick_up_f > 0.0 ? 1.0 / (1.0 / (s * l.pick_up_f) + l.load_ohm) : 0.0;  // admittance
  if (l.pick_up_f > 0.0) gain = l.load_ohm / (1.0 / (s * l.pick_up_f) + l.load_ohm);
  for (std::size_t i = l.sections(); i-- > 0;) {
    const Complex node = behind + s * l.earth_capacitance_f[i] + l.earth_conductance_s[i];
    const Complex series = 1.0 / (l.resistance_ohm[i] + s * l.inductance_h[i]) + s * l.turn_capacitance_f[i];
    gain *= series / (series + node);
    behind = series * node / (series + node);
  }
  return gain;
}

Ladder some_ladder() {
  return {
      {1.5e-3, 2e-3, 1e-3}, {6.0, 5.0, 7.0}, {40e-12, 30e-12, 50e-12}, {600e-12, 500e-12, 700e-12}, {2e-6, 0.0, 1e-6}, 0.0, 50.0};
}

}  // namespace

TEST_CASE("ladder: the state space has the response of the chain of impedances, with and without pick-up") {
  for (const double pick_up : {0.0, 100e-12}) {
    Ladder l = some_ladder();
    l.pick_up_f = pick_up;
    const auto system = ladder_system(l);
    REQUIRE(system);
    CHECK(system->states() == (pick_up > 0.0 ? 7 : 6));
    CHECK(system->A.eigenvalues().real().maxCoeff() < 0.0);
    const Eigen::Vector4d f(50.0, 3e3, 9e4, 8e5);
    const auto g = numerics::frequency_response(*system, f);
    for (Eigen::Index k = 0; k < 4; ++k) {
      const Complex expected = by_impedances(l, f[k]);
      CHECK(std::abs(g[static_cast<std::size_t>(k)](0, 0) - expected) < 1e-9 * std::abs(expected));
    }
  }
}

TEST_CASE("ladder: sections that do not fit are refused by name") {
  Ladder l = some_ladder();
  l.resistance_ohm.pop_back();
  CHECK(ladder_system(l).error().text == "resistance has 2 values for 3 sections");
  l = some_ladder();
  l.inductance_h[1] = 0.0;
  CHECK(ladder_system(l).error().text == "inductance must be above 0");
}

TEST_CASE("modes: a table of two inputs and outputs gives the sum of its modes") {
  const auto modes = read_modes("wn,zeta,b1,b2,c1,c2\n10,0.02,1,2,3,4\r\n30,0.05,-1,0.5,2,1\n");
  REQUIRE(modes);
  const auto system = modal_system(*modes);
  REQUIRE(system);
  const double f = 2.0;
  const Complex s(0.0, 2.0 * std::numbers::pi * f);
  const auto mode = [&](double w, double z) { return w * w / (s * s + 2.0 * z * w * s + w * w); };
  const auto g = numerics::frequency_response(*system, Eigen::VectorXd::Constant(1, f)).front();
  CHECK(std::abs(g(1, 0) - (4.0 * 1.0 * mode(10, 0.02) + 1.0 * -1.0 * mode(30, 0.05))) < 1e-12);
  CHECK(std::abs(g(0, 1) - (3.0 * 2.0 * mode(10, 0.02) + 2.0 * 0.5 * mode(30, 0.05))) < 1e-12);
}

TEST_CASE("modes: a table that is wrong is refused with its line") {
  CHECK(read_modes("w,zeta,b,c\n").error().text ==
        "line 1: 'w,zeta,b,c'; needed: wn,zeta, then a column b of each input, then c of each output");
  CHECK(read_modes("wn,zeta,b,c\n1,2,3\n").error().text == "line 2: 3 values; needed: 4");
  CHECK(read_modes("wn,zeta,b,c\n1,2,x,4\n").error().text == "line 2: 'x' is no number");
  CHECK(read_modes("wn,zeta,b,c\n").error().text == "no modes below the heading");
  CHECK(modal_system(*read_modes("wn,zeta,b,c\n1,0,1,1\n")).error().text ==
        "mode 1: frequency and damping ratio must be above 0");
}
