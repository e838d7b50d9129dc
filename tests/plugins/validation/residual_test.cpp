#include <cmath>

#include "catch.hpp"
#include "models.hpp"
#include "validation/autoregression.hpp"
#include "validation/residual_tests.hpp"

using namespace bodeflow;
using namespace bodeflow::test;
using namespace bodeflow::validation;

TEST_CASE("autoregression: Burg finds the coefficients and the order of a known filter") {
  // e[n] = 1.2 e[n-1] - 0.6 e[n-2] + w[n]
  Eigen::VectorXd e = white(20000, 11, 0.5);
  for (Eigen::Index n = 2; n < e.size(); ++n) e[n] += 1.2 * e[n - 1] - 0.6 * e[n - 2];
  const Autoregression noise = fit_autoregression(e, 20);
  REQUIRE(noise.coefficients.size() >= 2);
  CHECK(noise.coefficients.size() <= 6);  // AIC takes a few more now and then
  const Autoregression two = fit_autoregression(e, 2);
  const double std = std::sqrt((1.0 - 0.6 * 0.6) / 20000.0);  // of both, asymptotically
  CHECK(std::abs(two.coefficients[0] + 1.2) < 4.0 * std);
  CHECK(std::abs(two.coefficients[1] - 0.6) < 4.0 * std);
  CHECK(two.std == Approx(0.5).epsilon(0.02));
  CHECK(fit_autoregression(white(5000, 12), 20).coefficients.size() <= 2);
  CHECK(fit_autoregression(Eigen::VectorXd::Zero(100), 20).std == 0.0);
}

TEST_CASE("autoregression: predictions and their deviation by hand") {
  const Autoregression first{Eigen::VectorXd::Constant(1, -0.8), 2.0};  // e[n] = 0.8 e[n-1] + w
  const Eigen::VectorXd e = white(50, 5);
  const Eigen::VectorXd three = predict(first, e, 3);
  CHECK(three.head(3).isZero(0.0));
  for (Eigen::Index n = 3; n < 50; ++n) CHECK(three[n] == Approx(0.512 * e[n - 3]).epsilon(1e-14));
  CHECK(prediction_deviation(first, 1) == Approx(2.0));
  CHECK(prediction_deviation(first, 3) == Approx(2.0 * std::sqrt(1.0 + 0.64 + 0.4096)).epsilon(1e-14));

  // e[n] = 0.5 e[n-1] + 0.3 e[n-2] + w: two steps ahead 0.55 e[n-2] + 0.15 e[n-3].
  const Autoregression second{Eigen::Vector2d(-0.5, -0.3), 1.0};
  const Eigen::VectorXd two = predict(second, e, 2);
  CHECK(two[2] == Approx(0.55 * e[0]).epsilon(1e-14));
  for (Eigen::Index n = 3; n < 50; ++n) CHECK(two[n] == Approx(0.55 * e[n - 2] + 0.15 * e[n - 3]).margin(1e-14));
  CHECK(prediction_deviation(second, 3) == Approx(std::sqrt(1.0 + 0.25 + 0.55 * 0.55)).epsilon(1e-14));
}

TEST_CASE("residual tests: white noise stays within the band as often as stated, and its probability is uniform") {
  Eigen::Index outside = 0, unlikely = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const ResidualTests t = test_residual(white(1000, 2 * seed + 1), white(1000, 2 * seed + 2), 20, 0, 0.99);
    CHECK(t.autocorrelation[0] == Approx(1.0));
    outside += (t.autocorrelation.tail(20).array().abs() > t.autocorrelation_band).count();
    unlikely += t.whiteness_probability < 0.1 ? 1 : 0;
  }
  CHECK(outside <= 60);  // expected 40 of 4000
  CHECK(outside >= 20);
  CHECK(unlikely == Approx(20).margin(17));  // 4 standard deviations of a binomial
}

TEST_CASE("residual tests: the band of the cross-correlation holds for coloured residual and input") {
  Eigen::Index outside = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const ResidualTests t = test_residual(coloured(1000, 0.9, 2 * seed + 1), coloured(1000, 0.9, 2 * seed + 2), 20, 0, 0.99);
    outside += t.cross_outside;
    // sum 0.81^|k| = 1.81 / 0.19: three times the band of white noise
    CHECK(t.cross_correlation_band == Approx(2.576 * std::sqrt(9.53 / 1000.0)).epsilon(0.5));
  }
  CHECK(outside <= 126);  // 42 of 4200 expected, in runs of correlated lags
}

TEST_CASE("residual tests: what the model lacks stands at the lag at which it acts, feedback at negative lags") {
  const Eigen::VectorXd u = white(2000, 3), w = white(2000, 4, 0.5);
  Eigen::VectorXd lacks = w, fed_back = w;
  lacks.tail(1993) += 0.2 * u.head(1993);     // e[n] holds u[n - 7]
  fed_back.head(1995) += 0.2 * u.tail(1995);  // u[n] holds e[n - 5]
  const ResidualTests a = test_residual(lacks, u, 20, 0, 0.999), b = test_residual(fed_back, u, 20, 0, 0.999);
  Eigen::Index largest = 0;
  CHECK(a.cross_correlation.cwiseAbs().maxCoeff(&largest) > a.cross_correlation_band);
  CHECK(largest == 20 + 7);
  CHECK(a.cross_outside >= 1);
  CHECK(b.cross_correlation.cwiseAbs().maxCoeff(&largest) > b.cross_correlation_band);
  CHECK(largest == 20 - 5);
  CHECK(b.cross_outside == 0);
}

TEST_CASE("residual tests: a constant has no correlation") {
  const ResidualTests t = test_residual(Eigen::VectorXd::Constant(100, 0.1), white(100, 1), 5, 0, 0.99);
  CHECK(t.autocorrelation.isZero(0.0));
  CHECK(t.cross_correlation.isZero(0.0));
  CHECK(t.cross_outside == 0);
  CHECK(t.whiteness_probability == 1.0);
}
