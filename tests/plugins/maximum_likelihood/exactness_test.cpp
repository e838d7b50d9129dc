// Data without noise: the true model comes back.

#include <bodeflow/numerics/discretise.hpp>
#include <bodeflow/numerics/frequency_response.hpp>

#include "catch.hpp"
#include "simulated.hpp"

using namespace bodeflow;
using namespace bodeflow::test;
using namespace bodeflow::maximum_likelihood;

namespace {

// Relative noise of 1e-3 as the weights, and none in the data.
Spectra exact(const Rational& model, const Eigen::VectorXd& omega) {
  const Eigen::MatrixXcd g = response_of(model, omega);
  Spectra s = spectra_of(omega, g, 1e-6 * g.cwiseAbs2());
  s.sample_time_s = model.sample_time_s;
  return s;
}

}  // namespace

TEST_CASE("maximum likelihood: models of s of order 1 to 8 and 12 with a delay come back over four decades") {
  const Eigen::VectorXd omega = log_spaced(0.1, 1000.0, 150);
  for (const Eigen::Index order : {1, 2, 3, 4, 5, 6, 7, 8, 12}) {
    CAPTURE(order);
    const Rational truth = ladder(order, omega, 0.0, 250e-6);
    Settings s = settings(Domain::s, order);
    s.estimate_delay = true;
    s.starts = 2;
    const auto id = identify(exact(truth, omega), s);
    REQUIRE(id);
    CHECK(response_error(id->fit.models[0], truth, omega) < 1e-10);
    CHECK(root_error(id->fit.models[0].poles, truth.poles) < 1e-9);
    if (order > 1) CHECK(root_error(id->fit.models[0].zeros, truth.zeros) < 1e-8);
    CHECK(id->fit.models[0].delay_s == Approx(250e-6).epsilon(1e-8));
    CHECK(id->fit.minimum.converged);
  }
}

TEST_CASE("maximum likelihood: models of z of order 1 to 8 and 12 come back") {
  const double sample_time_s = 1e-3;
  const Eigen::VectorXd omega = even_spaced(20.0, 3000.0, 120);
  for (const Eigen::Index order : {1, 2, 3, 4, 5, 6, 7, 8, 12}) {
    CAPTURE(order);
    const Rational truth = ladder(order, omega, sample_time_s, 0.0);
    Settings s = settings(Domain::z, order);
    s.numerator_orders = {-1};
    s.starts = 2;
    const auto id = identify(exact(truth, omega), s);
    REQUIRE(id);
    CHECK(response_error(id->fit.models[0], truth, omega) < 1e-10);
    CHECK(root_error(id->fit.models[0].poles, truth.poles) < 1e-9);
  }
}

TEST_CASE("maximum likelihood: polynomials of the record are those of the model, in s") {
  // (5 s + 40) / (s^2 + 3 s + 200)
  const Eigen::VectorXd omega = log_spaced(0.2, 20.0, 40);
  const Rational truth{list({Complex(-1.5, std::sqrt(200.0 - 2.25)), Complex(-1.5, -std::sqrt(200.0 - 2.25))}), list({-8.0}), 5.0,
                       0.0, 0.0};
  const auto id = identify(exact(truth, omega), settings(Domain::s, 2));
  REQUIRE(id);
  const Coefficients c =
      coefficients_of(id->fit.lines, id->fit.structure, id->fit.minimum.estimate, 0, id->fit.models[0], id->covariance_root);
  CHECK(c.names == std::vector<std::string>{"b1", "b0", "a1", "a0"});
  const Eigen::Vector4d expected(5.0, 40.0, 3.0, 200.0);
  CHECK((c.values - expected).cwiseQuotient(expected).cwiseAbs().maxCoeff() < 1e-10);
}

TEST_CASE("maximum likelihood: two outputs share one denominator and one delay") {
  const Eigen::VectorXd omega = log_spaced(1.0, 200.0, 60);
  const Rational first = ladder(4, omega, 0.0, 1e-3);
  Rational second = first;
  second.zeros = list({-40.0});
  second.gain = 7.0;
  Eigen::MatrixXcd g(omega.size(), 2);
  g << response_of(first, omega), response_of(second, omega);
  Settings s = settings(Domain::s, 4);
  s.numerator_orders = {3, 1};
  s.estimate_delay = true;
  const auto id = identify(spectra_of(omega, g, 1e-6 * g.cwiseAbs2()), s);
  REQUIRE(id);
  CHECK(response_error(id->fit.models[0], first, omega) < 1e-10);
  CHECK(response_error(id->fit.models[1], second, omega) < 1e-10);
  CHECK(root_error(id->fit.models[1].poles, first.poles) < 1e-10);
  CHECK(root_error(id->fit.models[1].zeros, second.zeros) < 1e-9);
}

TEST_CASE("maximum likelihood: a model of s is found through the hold of its input, up to half the sample rate") {
  const double sample_time_s = 1e-3;
  const Eigen::VectorXd omega = even_spaced(30.0, 3000.0, 100);
  const Rational truth{list({Complex(-60.0, 900.0), Complex(-60.0, -900.0), -400.0}), list({-2000.0}), 5e5, 0.4e-3, 0.0};
  const auto system = numerics::to_state_space(numerics::ZeroPoleGain{truth.zeros, truth.poles, truth.gain, 0.0});
  const auto held = numerics::zero_order_hold(*system, sample_time_s, truth.delay_s);
  REQUIRE(held);
  const auto g = numerics::frequency_response(held->model, omega / (2.0 * std::numbers::pi));
  Eigen::MatrixXcd response(omega.size(), 1);
  for (Eigen::Index k = 0; k < omega.size(); ++k) response(k, 0) = g[static_cast<std::size_t>(k)](0, 0);
  Spectra data = spectra_of(omega, response, 1e-6 * response.cwiseAbs2());
  data.sample_time_s = sample_time_s;
  Settings s = settings(Domain::s, 3);
  s.numerator_orders = {1};
  s.estimate_delay = true;
  s.zero_order_hold = true;
  const auto id = identify(data, s);
  REQUIRE(id);
  CHECK(id->fit.minimum.converged);
  CHECK(root_error(id->fit.models[0].poles, truth.poles) < 1e-8);
  CHECK(root_error(id->fit.models[0].zeros, truth.zeros) < 1e-7);
  CHECK(id->fit.models[0].delay_s == Approx(0.4e-3).epsilon(1e-7));
  CHECK((id->fit.response - response).cwiseAbs().maxCoeff() < 1e-9 * response.cwiseAbs().maxCoeff());
  s.zero_order_hold = false;
  CHECK(root_error(identify(data, s)->fit.models[0].poles, truth.poles) > 1e-3);
}

TEST_CASE("maximum likelihood: what is fixed keeps its value, the rest is found") {
  const Eigen::VectorXd omega = log_spaced(1.0, 200.0, 60);
  // 30 s / (s^2 (s + 50) (s + 4)), written with the zero at 0.
  const Rational truth{list({0.0, 0.0, -4.0, -50.0}), list({0.0}), 30.0, 0.0, 0.0};
  Settings s = settings(Domain::s, 4);
  s.numerator_orders = {1};
  s.fixed_poles = list({0.0, 0.0});
  s.fixed = {{false, 0, 0, 0.0}, {true, 0, 2, 200.0}};
  const auto id = identify(exact(truth, omega), s);
  REQUIRE(id);
  CHECK(id->fit.parameters() == 2);
  const Rational& found = id->fit.models[0];
  CHECK(std::abs(found.poles[0]) == 0.0);
  CHECK(std::abs(found.poles[1]) == 0.0);
  CHECK(root_error(found.poles.tail(2), list({-4.0, -50.0})) < 1e-9);
  CHECK(std::abs(found.zeros[0]) < 1e-9);
  CHECK(found.denominator()[2] == Approx(200.0).epsilon(1e-10));
  CHECK(found.gain == Approx(30.0).epsilon(1e-9));
  const auto covariance =
      root_covariance(pole_slopes(id->fit.lines, id->fit.structure, id->fit.minimum.estimate, found).row(0), id->covariance_root);
  CHECK(covariance.isZero(0.0));
}

TEST_CASE("maximum likelihood: an order above the true one is not chosen on data without noise") {
  const Eigen::VectorXd omega = log_spaced(1.0, 200.0, 60);
  Settings s = settings(Domain::s, 3);
  s.order.reset();
  s.highest_order = 5;
  const auto id = identify(exact(ladder(3, omega, 0.0, 0.0), omega), s);
  REQUIRE(id);
  CHECK(id->fit.structure.order == 3);
  CHECK_FALSE(id->scan->still_falls);
}

TEST_CASE("maximum likelihood: lines at 0 and at half the sample rate count half") {
  const double sample_time_s = 0.01;
  const Eigen::VectorXd omega = even_spaced(0.0, std::numbers::pi / sample_time_s, 33);
  const Rational truth{list({0.8, 0.3}), list({-0.2}), 0.5, 0.0, sample_time_s};
  Spectra data = exact(truth, omega);
  CHECK(data.equations() == 32.0);
  Settings s = settings(Domain::z, 2);
  s.numerator_orders = {1};
  const auto id = identify(data, s);
  REQUIRE(id);
  CHECK(response_error(id->fit.models[0], truth, omega) < 1e-10);
  CHECK(id->test.degrees_of_freedom == 2.0 * 32.0 - 4.0);
}
