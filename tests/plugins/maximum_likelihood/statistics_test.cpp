// Seeded Monte Carlo: bias, scatter beside what is claimed, coverage, costs.

#include <Eigen/Dense>

#include "catch.hpp"
#include "simulated.hpp"

using namespace bodeflow;
using namespace bodeflow::test;
using namespace bodeflow::maximum_likelihood;

namespace {

constexpr double kQuantile = 1.959964;

struct Runs {
  Eigen::MatrixXd values;      // runs x parameters
  Eigen::MatrixXd deviations;  // as claimed
  Eigen::VectorXd costs, probabilities, whiteness;
  double expected_cost = 0.0;
  Eigen::MatrixXd pole_hits;  // 1 where the 95 % ellipse holds the true pole

  double coverage(Eigen::Index p, double truth) const {
    return ((values.col(p).array() - truth).abs() < kQuantile * deviations.col(p).array()).cast<double>().mean();
  }
};

template <class Data>
Runs run(int count, const Settings& s, const Rational& truth, Data data) {
  Runs r;
  for (int n = 0; n < count; ++n) {
    numerics::Random random = numerics::Random::stream(20240611, static_cast<std::uint64_t>(n));
    const auto id = identify(data(random), s);
    REQUIRE(id);
    REQUIRE(id->fit.minimum.converged);
    const Coefficients c =
        coefficients_of(id->fit.lines, id->fit.structure, id->fit.minimum.estimate, 0, id->fit.models[0], id->covariance_root);
    if (n == 0) {
      r.values.resize(count, c.values.size());
      r.deviations.resize(count, c.values.size());
      r.costs.resize(count);
      r.probabilities.resize(count);
      r.whiteness.resize(count);
      r.pole_hits = Eigen::MatrixXd::Zero(count, 1);
    }
    // A delay at the end of its range is no parameter and has no deviation: it counts as a miss.
    REQUIRE(c.values.size() + (id->fit.delay_at_bound ? 1 : 0) == r.values.cols());
    r.values.row(n).setConstant(id->fit.models[0].delay_s);
    r.deviations.row(n).setZero();
    r.values.row(n).head(c.values.size()) = c.values;
    r.deviations.row(n).head(c.values.size()) = c.covariance.diagonal().cwiseSqrt();
    r.costs[n] = id->test.cost;
    r.probabilities[n] = id->test.probability.value_or(-1.0);
    r.whiteness[n] = id->whiteness[0]->probability;
    r.expected_cost = id->test.expected;
    const Rational& found = id->fit.models[0];
    Eigen::Index nearest = 0;
    (found.poles.array() - truth.poles[0]).abs().minCoeff(&nearest);
    const Complex away = found.poles[nearest] - truth.poles[0];
    const Eigen::Matrix2d covariance = root_covariance(
        pole_slopes(id->fit.lines, id->fit.structure, id->fit.minimum.estimate, found).row(nearest), id->covariance_root);
    const Eigen::Vector2d d(away.real(), away.imag());
    r.pole_hits(n, 0) = d.dot(covariance.inverse() * d) < 5.991 ? 1.0 : 0.0;
  }
  return r;
}

// (5 s + 40) / (s^2 + 3 s + 200) with a delay of 2 ms: b1, b0, a1, a0, delay.
const Rational kPlant{list({Complex(-1.5, std::sqrt(200.0 - 2.25)), Complex(-1.5, -std::sqrt(200.0 - 2.25))}), list({-8.0}), 5.0,
                      2e-3, 0.0};
const Eigen::VectorXd kTruth = (Eigen::VectorXd(5) << 5.0, 40.0, 3.0, 200.0, 2e-3).finished();

void check(const Runs& r, double worst_ratio) {
  const auto count = static_cast<double>(r.values.rows());
  for (Eigen::Index p = 0; p < r.values.cols(); ++p) {
    CAPTURE(p);
    const double mean = r.values.col(p).mean();
    const double scatter = std::sqrt((r.values.col(p).array() - mean).square().sum() / (count - 1.0));
    const double claimed = std::sqrt(r.deviations.col(p).cwiseAbs2().mean());
    CHECK(std::abs(mean - kTruth[p]) < 4.0 * scatter / std::sqrt(count));
    CHECK(scatter / claimed == Approx(1.0).margin(worst_ratio));
    CHECK(r.coverage(p, kTruth[p]) == Approx(0.95).margin(4.0 * std::sqrt(0.95 * 0.05 / count)));
  }
  CHECK(r.pole_hits.mean() == Approx(0.95).margin(4.0 * std::sqrt(0.95 * 0.05 / count)));
}

Settings with_delay() {
  Settings s = settings(Domain::s, 2);
  s.estimate_delay = true;
  s.delay_range_s = std::pair(0.0, 20e-3);
  s.numerator_orders = {1};
  s.starts = 1;
  return s;
}

}  // namespace

TEST_CASE("maximum likelihood: no bias, scatter and coverage as claimed, cost as expected, noise on both signals correlated") {
  const Eigen::VectorXd omega = even_spaced(1.0, 60.0, 60);
  const Runs r = run(400, with_delay(), kPlant, [&](numerics::Random& random) {
    return measured(kPlant, omega, {0.05, 0.03, 0.6}, random);
  });
  check(r, 0.15);
  CHECK(r.expected_cost == 57.5);
  CHECK(r.costs.mean() == Approx(57.5).margin(4.0 * std::sqrt(57.5 / 400.0)));
  const double scatter = std::sqrt((r.costs.array() - r.costs.mean()).square().mean());
  CHECK(scatter == Approx(std::sqrt(57.5)).epsilon(0.15));
  const double margin = 4.0 * std::sqrt(0.05 * 0.95 / 400.0);
  CHECK((r.probabilities.array() < 0.05).cast<double>().mean() == Approx(0.05).margin(margin));
  CHECK((r.whiteness.array() < 0.05).cast<double>().mean() == Approx(0.05).margin(margin));
}

TEST_CASE("maximum likelihood: variances from 6 periods raise expected cost and covariance as Pintelon and Schoukens tell") {
  const Eigen::VectorXd omega = even_spaced(1.0, 60.0, 60);
  const Runs r = run(400, with_delay(), kPlant, [&](numerics::Random& random) {
    return measured_over(6, kPlant, omega, {0.02, 0.03, 0.0}, random);
  });
  check(r, 0.15);
  CHECK(r.expected_cost == Approx(57.5 * 5.0 / 4.0));
  const double deviation = std::sqrt(57.5 * 125.0 / (16.0 * 3.0));
  CHECK(r.costs.mean() == Approx(r.expected_cost).margin(4.0 * deviation / 20.0));
  // Heavy tails: the scatter of a scatter is large here.
  CHECK(std::sqrt((r.costs.array() - r.costs.mean()).square().mean()) == Approx(deviation).epsilon(0.25));
}

TEST_CASE("maximum likelihood: a model of z scatters as claimed") {
  const double sample_time_s = 0.02;
  const Rational truth{list({Complex(0.85, 0.35), Complex(0.85, -0.35)}), list({0.4}), 0.5, 0.0, sample_time_s};
  const Eigen::VectorXd omega = even_spaced(3.0, 150.0, 50);
  Settings s = settings(Domain::z, 2);
  s.numerator_orders = {1};
  s.starts = 1;
  const Runs r = run(400, s, truth, [&](numerics::Random& random) { return measured(truth, omega, {0.02, 0.05, 0.0}, random); });
  const Eigen::Vector4d expected(0.5, -0.2, -1.7, 0.85 * 0.85 + 0.35 * 0.35);
  for (Eigen::Index p = 0; p < 4; ++p) {
    CAPTURE(p);
    const double mean = r.values.col(p).mean();
    const double scatter = std::sqrt((r.values.col(p).array() - mean).square().sum() / 399.0);
    CHECK(std::abs(mean - expected[p]) < 4.0 * scatter / 20.0);
    CHECK(r.coverage(p, expected[p]) == Approx(0.95).margin(4.0 * std::sqrt(0.95 * 0.05 / 400.0)));
  }
}

TEST_CASE("maximum likelihood: without variance the covariance comes from the residuals") {
  const Eigen::VectorXd omega = even_spaced(1.0, 60.0, 60);
  Settings s = with_delay();
  s.weighting = Weighting::relative;
  const Runs r = run(200, s, kPlant, [&](numerics::Random& random) {
    const Eigen::MatrixXcd g = response_of(kPlant, omega);
    Spectra data = spectra_of(omega, g, Eigen::MatrixXd::Zero(60, 1));
    for (Eigen::Index k = 0; k < 60; ++k) data.output(k, 0) *= 1.0 + 0.03 * normal(random);
    return data;
  });
  for (Eigen::Index p = 0; p < 5; ++p) {
    CAPTURE(p);
    CHECK(r.coverage(p, kTruth[p]) == Approx(0.95).margin(0.08));
  }
}

TEST_CASE("maximum likelihood: a delay of a plant without zeros lies in its interval, the numerator order not given") {
  // 200 / (s^2 + 3 s + 200), 3.7 ms: b1 s + b0 ~ b0 exp(s b1/b0) would leave the delay free.
  const Rational plant{kPlant.poles, list({}), 200.0, 3.7e-3, 0.0};
  const Eigen::VectorXd omega = even_spaced(1.0, 60.0, 60);
  Settings s = with_delay();
  s.numerator_orders.clear();
  const Runs r = run(100, s, plant, [&](numerics::Random& random) { return measured(plant, omega, {0.02, 0.01, 0.0}, random); });
  REQUIRE(r.values.cols() == 4);
  CHECK(r.deviations.col(3).maxCoeff() < 2e-3);
  CHECK(r.coverage(3, 3.7e-3) >= 0.90);
  CHECK(r.coverage(3, 3.7e-3) <= 0.99);
}
