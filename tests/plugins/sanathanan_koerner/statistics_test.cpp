// Noise: what the covariance says against what happens, and what the refinement is good for.

#include <Eigen/LU>

#include "catch.hpp"
#include "sanathanan_koerner/identification.hpp"
#include "systems.hpp"

using namespace bodeflow;
using namespace bodeflow::sanathanan_koerner;

namespace {

const Eigen::VectorXd kOmega = test::geometric(1.0, 30.0, 100);

Eigen::MatrixXcd plant() {
  Eigen::MatrixXcd g(100, 1);
  for (Eigen::Index k = 0; k < 100; ++k) {
    const std::complex<double> s(0.0, kOmega[k]);
    g(k, 0) = 9.0 / (s * s + 0.3 * s + 9.0) + 4.0 / (s * s + 0.8 * s + 144.0) + 0.5 / (s + 5.0);
  }
  return g;
}

/// The plant with noise of 1 % of |G|, weighed by it.
Data measured(std::uint64_t seed) {
  numerics::Random random(seed);
  Data d = test::data_of(kOmega, plant());
  const Eigen::VectorXd deviation = 0.01 * d.response.col(0).cwiseAbs();
  for (Eigen::Index k = 0; k < 100; ++k) d.response(k, 0) += deviation[k] * test::complex_normal(random);
  d.weights = deviation.cwiseInverse();
  return d;
}

}  // namespace

TEST_CASE("covariance: poles lie in their 95 % regions as often as they should and the cost is chi-squared") {
  Settings s;
  s.order = 5;
  s.known_variance = true;
  s.refine = true;
  s.prewarp_rad_s = 12.0;
  const std::complex<double> truth(-0.15, std::sqrt(9.0 - 0.15 * 0.15));
  int within = 0;
  double cost = 0.0;
  constexpr int kRuns = 200;
  for (int run = 0; run < kRuns; ++run) {
    const auto found = identify(measured(static_cast<std::uint64_t>(run)), s);
    REQUIRE(found);
    REQUIRE(found->uncertainty);
    Eigen::Index nearest = 0;
    (found->poles.array() - truth).abs().minCoeff(&nearest);
    const Eigen::Vector2d off((found->poles[nearest] - truth).real(), (found->poles[nearest] - truth).imag());
    const Eigen::Matrix2d covariance = found->uncertainty->poles[static_cast<std::size_t>(nearest)];
    within += off.dot(covariance.inverse() * off) < 5.991;  // chi-squared with 2 degrees of freedom
    cost += found->cost / kRuns;
  }
  CHECK(within > 180);
  CHECK(within < 199);
  CHECK(cost == Approx(100.0 - 0.5 * 11.0).epsilon(0.03));  // deviation of the mean: 9.7 / sqrt(200) / 94.5 = .7 %
}

TEST_CASE("covariance: from the residuals it is that of the known variance within their scatter") {
  const Data data = measured(3);
  Settings s;
  s.order = 5;
  s.prewarp_rad_s = 12.0;
  s.known_variance = true;
  const auto known = identify(data, s);
  s.known_variance = false;
  const auto unknown = identify(data, s);
  REQUIRE(known);
  REQUIRE(unknown);
  CHECK(unknown->uncertainty->poles[0](0, 0) == Approx(known->uncertainty->poles[0](0, 0)).epsilon(0.4));
  REQUIRE(known->fractions);
  CHECK(known->fractions->names.size() == 11);
  CHECK(known->fractions->names.front() == "pole1_re");
  CHECK(known->uncertainty->covariance.rows() == 11);
}

TEST_CASE("refinement: it ends at a minimum where steps to either side raise the error") {
  const Data data = measured(7);
  const Eigen::Index order = 5;
  const auto start = fit(data, Plane{12.0, 0.0}, {order, 1.0, true, {}});
  REQUIRE(start);
  Settings s;
  s.order = order;
  s.prewarp_rad_s = 12.0;
  s.refine = true;
  const auto best = identify(data, s);
  REQUIRE(best);
  CHECK(best->error() <= start->error());
  const auto set = pole_set(best->poles);
  REQUIRE(set);
  for (const std::complex<double> move : {std::complex<double>(1e-4, 0), {-1e-4, 0}, {0, 1e-4}, {0, -1e-4}}) {
    PoleSet moved = *set;
    moved.pairs[0] += move;
    const auto other = fit_residues(data, moved);
    REQUIRE(other);
    CHECK(weighted_residual(data, response(*other, kOmega)).squaredNorm() > best->cost);
  }
}

TEST_CASE("fit: the same data give the same bits") {
  const Data data = measured(1);
  const auto a = fit_with_scan(data, {6, 1.0, true, {}}), b = fit_with_scan(data, {6, 1.0, true, {}});
  REQUIRE(a);
  REQUIRE(b);
  CHECK(a->response == b->response);
  CHECK(a->poles == b->poles);
}

TEST_CASE("vector fitting: the unit of frequency changes nothing") {
  const Data data = measured(5);
  Data fast = data;
  fast.omega_rad_s *= 0x1p36;
  const auto slow = vector_fit(data, {5, Spacing::linear, true, {}}), quick = vector_fit(fast, {5, Spacing::linear, true, {}});
  REQUIRE(slow);
  REQUIRE(quick);
  REQUIRE(slow->course.errors.size() == quick->course.errors.size());
  for (std::size_t i = 0; i < slow->course.errors.size(); ++i)
    CHECK(quick->course.errors[i] == Approx(slow->course.errors[i]).epsilon(1e-9));
}
