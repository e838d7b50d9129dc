// Example 2 of D. A. Jue realised from poles and least-squares residues, and reduced.

#include <bodeflow/numerics/balanced_truncation.hpp>

#include "catch.hpp"
#include "sanathanan_koerner/fit.hpp"
#include "systems.hpp"

using namespace bodeflow;

namespace {

const Eigen::VectorXd& omega() {
  static const Eigen::VectorXd w = test::geometric(0.5, 600.0, 1200);
  return w;
}

const Eigen::VectorXd& hertz() {
  static const Eigen::VectorXd f = omega() / (2.0 * std::numbers::pi);
  return f;
}

Eigen::MatrixXcd response(const numerics::StateSpace& system) { return subspace::response_of(system, omega()); }

/// A realisation from poles alone: residues by least squares on the data, of whatever rank.
numerics::StateSpace realised(const Eigen::VectorXcd& poles, double tolerance) {
  const auto data = numerics::frequency_response(test::example_2(), hertz());
  const auto residues = numerics::residues_by_least_squares(poles, hertz(), data, {});
  REQUIRE(residues);
  const auto system = numerics::gilbert_realisation(*residues, tolerance);
  REQUIRE(system);
  return *system;
}

}  // namespace

TEST_CASE("180 states come from 90 modes by their residues' ranks, and from a realisation with more by truncation [A5]",
          "[long]") {
  const Eigen::MatrixXcd data = test::lines_of(test::example_2(), omega()).response;
  const numerics::StateSpace minimal = realised(test::example_2().poles, 1e-5);
  CHECK(minimal.states() == 180);
  CHECK(test::relative(response(minimal), data) <= 1e-7);

  // Ranks down to rounding: twice the states, of which half are hardly seen.
  const numerics::StateSpace large = realised(test::example_2().poles, 0.0);
  CHECK(large.states() == 360);
  const auto reduced = numerics::balanced_truncation(large, 180);
  REQUIRE(reduced);
  const Eigen::VectorXd& sigma = reduced->hankel_singular_values;
  INFO("Hankel singular values 180 and 181: " << sigma[179] << ", " << sigma[180]);
  CHECK(sigma[180] < 1e-4 * sigma[179]);
  CHECK(test::relative(response(reduced->system), response(large)) <= 1e-9);
}

TEST_CASE("118 poles are 236 states, which 180 states replace to 0.1 % [A5]", "[long]") {
  using namespace sanathanan_koerner;
  const subspace::Lines lines = test::lines_of(test::example_2(), omega());
  FitSettings settings;
  settings.order = 118;
  const auto found = fit(Data{lines.omega_rad_s, lines.response, lines.weight}, {127.0, 0.0}, settings);
  REQUIRE(found);
  const auto poles = numerics::upper_poles(found->poles);
  REQUIRE(poles);
  const numerics::StateSpace large = realised(*poles, 1e-4);
  CHECK(large.states() == 236);
  const Eigen::MatrixXcd full = response(large);
  CHECK(test::relative(full, lines.response) <= 1.3e-3);
  const auto reduced = numerics::balanced_truncation(large, 180);
  REQUIRE(reduced);
  CHECK(test::relative(response(reduced->system), full) <= 1e-3);
}
