#include "bodeflow/numerics/linear_system.hpp"

#include <Eigen/Dense>
#include <limits>

#include "bodeflow/numerics/frequency_response.hpp"
#include "bodeflow/numerics/polynomial.hpp"
#include "catch.hpp"

using namespace bodeflow::numerics;
using Complex = std::complex<double>;

namespace {

Eigen::VectorXd vector(std::initializer_list<double> values) {
  return Eigen::Map<const Eigen::VectorXd>(values.begin(), static_cast<Eigen::Index>(values.size()));
}

Eigen::VectorXcd complex_vector(std::initializer_list<Complex> values) {
  return Eigen::Map<const Eigen::VectorXcd>(values.begin(), static_cast<Eigen::Index>(values.size()));
}

Eigen::VectorXd logarithmic(double first, double last, Eigen::Index count) {
  return Eigen::VectorXd::LinSpaced(count, std::log10(first), std::log10(last)).unaryExpr([](double x) {
    return std::pow(10.0, x);
  });
}

double worst_relative(const std::vector<Eigen::MatrixXcd>& found, const Eigen::VectorXcd& expected) {
  double worst = 0;
  for (Eigen::Index k = 0; k < expected.size(); ++k) {
    worst = std::max(worst, std::abs(found[static_cast<std::size_t>(k)](0, 0) - expected[k]) / std::abs(expected[k]));
  }
  return worst;
}

// Five lightly damped modes from 1 Hz to 10 kHz with zeros between them: order 10.
ZeroPoleGain five_modes() {
  ZeroPoleGain zpk;
  zpk.poles.resize(10);
  zpk.zeros.resize(8);
  for (Eigen::Index m = 0; m < 5; ++m) {
    const double omega = 2 * 3.141592653589793 * std::pow(10.0, static_cast<double>(m));
    zpk.poles[2 * m] = omega * Complex(-0.01, std::sqrt(1 - 1e-4));
    zpk.poles[2 * m + 1] = std::conj(zpk.poles[2 * m]);
    if (m == 4) continue;
    zpk.zeros[2 * m] = 3 * omega * Complex(-0.01, std::sqrt(1 - 1e-4));
    zpk.zeros[2 * m + 1] = std::conj(zpk.zeros[2 * m]);
  }
  zpk.gain = 42.0;
  return zpk;
}

}  // namespace

TEST_CASE("a second-order transfer function keeps its coefficients in the canonical form") {
  const auto ss = to_state_space(TransferFunction{vector({2, 0, 3}), vector({2, 4, 10})});
  REQUIRE(ss);
  Eigen::MatrixXd a(2, 2);
  a << -2, -5, 1, 0;
  CHECK(ss->A == a);
  CHECK(ss->B == Eigen::Vector2d(1, 0));
  CHECK(ss->C == Eigen::RowVector2d(-2, -3.5));
  CHECK(ss->D(0, 0) == 1.0);
}

TEST_CASE("a transfer function without poles is a gain") {
  const auto ss = to_state_space(TransferFunction{vector({0, 6}), vector({2})});
  REQUIRE(ss);
  CHECK(ss->states() == 0);
  CHECK(ss->D(0, 0) == 3.0);
  CHECK(ss->has_feedthrough());
}

TEST_CASE("a cascade of order 10 has the response of its poles and zeros to 1e-11 on five decades") {
  const ZeroPoleGain zpk = five_modes();
  const auto ss = to_state_space(zpk);
  REQUIRE(ss);
  REQUIRE(ss->states() == 10);
  CHECK_FALSE(ss->has_feedthrough());
  const Eigen::VectorXd f = logarithmic(0.01, 1e5, 301);
  CHECK(worst_relative(frequency_response(*ss, f), frequency_response(zpk, f)) < 1e-11);
}

TEST_CASE("a transfer function of order 10 has the same response as a state space to 1e-10 on five decades") {
  const auto tf = to_transfer_function(five_modes());
  REQUIRE(tf);
  const auto ss = to_state_space(*tf);
  REQUIRE(ss);
  REQUIRE(ss->states() == 10);
  const Eigen::VectorXd f = logarithmic(0.01, 1e5, 301);
  CHECK(worst_relative(frequency_response(*ss, f), frequency_response(*tf, f)) < 1e-10);
}

TEST_CASE("every split of poles and zeros into pairs and single roots gives a proper cascade") {
  const std::vector<Eigen::VectorXcd> poles = {
      complex_vector({-1, -20, -300}), complex_vector({-1, -20, -300, -4}), complex_vector({{-1, 2}, {-1, -2}, -3}),
      complex_vector({{-1, 2}, {-1, -2}, {-5, 9}, {-5, -9}}), complex_vector({0, 0, -7, -9, -2})};
  const std::vector<Eigen::VectorXcd> zeros = {Eigen::VectorXcd(), complex_vector({-2}), complex_vector({{-2, 5}, {-2, -5}}),
                                               complex_vector({{0.5, 5}, {0.5, -5}, -6})};
  const Eigen::VectorXd f = logarithmic(0.01, 100, 21);
  for (const auto& p : poles) {
    for (const auto& z : zeros) {
      const ZeroPoleGain zpk{z, p, 2.5};
      const auto ss = to_state_space(zpk);
      REQUIRE(ss);
      CHECK(ss->states() == p.size());
      CHECK(ss->has_feedthrough() == (z.size() == p.size()));
      CHECK(worst_relative(frequency_response(*ss, f), frequency_response(zpk, f)) < 1e-13);
    }
  }
}

TEST_CASE("discrete responses are taken on the unit circle") {
  const TransferFunction delay_of_two{vector({1}), vector({1, 0, 0}), 0.01};
  const Eigen::VectorXd f = vector({0, 12.5, 25, 50});
  const Eigen::VectorXcd expected = complex_vector({1, {0, -1}, -1, 1});
  const Eigen::VectorXcd found = frequency_response(delay_of_two, f);
  CHECK((found - expected).cwiseAbs().maxCoeff() < 1e-15);
  const auto ss = to_state_space(delay_of_two);
  REQUIRE(ss);
  CHECK(worst_relative(frequency_response(*ss, f), expected) < 1e-15);
}

TEST_CASE("a state space with two inputs and two outputs gives a matrix a line") {
  Eigen::MatrixXd a = Eigen::Vector2d(-1, -2).asDiagonal();
  const auto ss = make_state_space(a, Eigen::MatrixXd::Identity(2, 2), Eigen::MatrixXd::Ones(2, 2), Eigen::MatrixXd());
  REQUIRE(ss);
  const auto g = frequency_response(*ss, vector({0, 1}));
  REQUIRE(g.size() == 2);
  CHECK(std::abs(g[0](1, 0) - 1.0) < 1e-15);
  CHECK(std::abs(g[0](0, 1) - 0.5) < 1e-15);
  CHECK(std::abs(g[1](1, 1) - 1.0 / Complex(2, 2 * 3.141592653589793)) < 1e-15);
}

TEST_CASE("a series connection multiplies responses") {
  const TransferFunction g1{vector({1, 3}), vector({1, 1})};
  const TransferFunction g2{vector({2}), vector({1, 0.2, 4})};
  const Eigen::VectorXd f = logarithmic(0.01, 10, 31);
  const StateSpace both = series(*to_state_space(g1), *to_state_space(g2));
  const Eigen::VectorXcd expected = frequency_response(g1, f).cwiseProduct(frequency_response(g2, f));
  CHECK(worst_relative(frequency_response(both, f), expected) < 1e-13);
}

TEST_CASE("systems that cannot be realised are refused with what was found") {
  CHECK(to_state_space(TransferFunction{vector({1, 0, 0}), vector({1, 1})}).error().text ==
        "the system is improper: degree 2 above degree 1");
  CHECK(to_state_space(TransferFunction{vector({1}), vector({0, 0})}).error().text == "the denominator is zero");
  CHECK(to_state_space(ZeroPoleGain{complex_vector({1}), {}, 1.0}).error().text ==
        "the system is improper: degree 1 above degree 0");
  CHECK(to_state_space(ZeroPoleGain{{}, complex_vector({{-1, 1}}), 1.0}).error().text ==
        "poles: the root -1+1i stands without its conjugate -1-1i");
  const Eigen::MatrixXd one = Eigen::MatrixXd::Ones(1, 1);
  const Eigen::MatrixXd wide = Eigen::MatrixXd::Ones(1, 2);
  const Eigen::MatrixXd none;
  CHECK(make_state_space(wide, one, one, none).error().text == "A is 1 x 2, it must be square");
  CHECK(make_state_space(one, wide.transpose(), one, none).error().text == "B is 2 x 1, it must have as many rows as A (1)");
  CHECK(make_state_space(one, one, wide, none).error().text == "C is 1 x 2, it must have as many columns as A (1)");
  CHECK(make_state_space(one, one, one, wide).error().text == "D is 1 x 2, it must be 1 x 1");
  CHECK(make_state_space(none, none, none, none).error().text == "a system needs A, B and C, or D");
  CHECK(make_state_space(one * std::numeric_limits<double>::infinity(), one, one, none).error().text ==
        "an entry of A, B, C or D is not a finite number");
}
