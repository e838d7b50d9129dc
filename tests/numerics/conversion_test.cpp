// Conversions between polynomials, roots, residues and state spaces, continuous and discrete.

#include <Eigen/Dense>

#include "bodeflow/numerics/bilinear.hpp"
#include "bodeflow/numerics/discretise.hpp"
#include "bodeflow/numerics/frequency_response.hpp"
#include "bodeflow/numerics/pole_residue.hpp"
#include "bodeflow/numerics/polynomial.hpp"
#include "bodeflow/numerics/random.hpp"
#include "catch.hpp"

using namespace bodeflow::numerics;
using Complex = std::complex<double>;

namespace {

const double kTwoPi = 2 * 3.14159265358979323846;

/// Four modes, `zeros` zeros and a real pole more.
ZeroPoleGain plant(Eigen::Index zeros) {
  ZeroPoleGain zpk;
  zpk.poles.resize(9);
  for (Eigen::Index m = 0; m < 4; ++m) {
    const double omega = std::pow(3.0, static_cast<double>(m));
    zpk.poles[2 * m] = omega * Complex(-0.05, 1.0);
    zpk.poles[2 * m + 1] = std::conj(zpk.poles[2 * m]);
  }
  zpk.poles[8] = -4.0;
  zpk.zeros.resize(zeros);
  for (Eigen::Index i = 0; i < zeros; ++i) zpk.zeros[i] = -0.7 - 1.3 * static_cast<double>(i);
  zpk.gain = -2.5;
  return zpk;
}

Eigen::VectorXd lines() { return Eigen::VectorXd::LinSpaced(40, std::log(0.1), std::log(90.0)).array().exp() / kTwoPi; }

double difference(const std::vector<Eigen::MatrixXcd>& found, const Eigen::VectorXcd& expected) {
  double worst = 0.0;
  for (Eigen::Index k = 0; k < expected.size(); ++k)
    worst = std::max(worst, std::abs(found[static_cast<std::size_t>(k)](0, 0) / expected[k] - 1.0));
  return worst;
}

StateSpace mixed(const StateSpace& s) {
  Random random(11);
  Eigen::MatrixXd T(s.states(), s.states());
  for (double& x : T.reshaped()) x = random.normal();
  return {T.lu().solve(s.A * T), T.lu().solve(s.B), s.C * T, s.D, s.sample_time};
}

}  // namespace

TEST_CASE("zeros, poles and gain come back from a state space of any relative degree") {
  for (const Eigen::Index zeros : {0, 1, 3, 6, 8, 9}) {
    INFO("zeros: " << zeros);
    const ZeroPoleGain given = plant(zeros);
    const auto ss = to_state_space(given);
    REQUIRE(ss);
    // Mixed coordinates leave rounding that many deflations amplify: there a relative degree of 6 is the limit.
    const auto found = to_zero_pole_gain(zeros < 3 ? *ss : mixed(*ss));
    REQUIRE(found);
    REQUIRE(found->zeros.size() == zeros);
    CHECK(found->gain == Approx(given.gain).epsilon(1e-6));
    const Eigen::VectorXcd expected = frequency_response(given, lines());
    CHECK((frequency_response(*found, lines()).cwiseQuotient(expected).array() - 1.0).abs().maxCoeff() < 1e-7);
  }
}

TEST_CASE("a system that passes nothing has the gain zero and no zeros") {
  const StateSpace s{-Eigen::MatrixXd::Identity(2, 2), Eigen::Vector2d(1, 0), Eigen::RowVector2d(0, 1),
                     Eigen::MatrixXd::Zero(1, 1), 0.0};
  const auto zpk = to_zero_pole_gain(s);
  REQUIRE(zpk);
  CHECK(zpk->gain == 0.0);
  CHECK(zpk->zeros.size() == 0);
}

TEST_CASE("residues of a transfer function give its response and its Gilbert realisation") {
  for (const Eigen::Index zeros : {3, 9}) {
    const auto tf = to_transfer_function(plant(zeros));
    REQUIRE(tf);
    const auto parts = to_pole_residue(*tf);
    REQUIRE(parts);
    const Eigen::VectorXcd expected = frequency_response(plant(zeros), lines());
    CHECK(difference(frequency_response(*parts, lines()), expected) < 1e-9);
    const auto ss = gilbert_realisation(*parts);
    REQUIRE(ss);
    CHECK(ss->states() == 9);
    CHECK(difference(frequency_response(*ss, lines()), expected) < 1e-9);
  }
}

TEST_CASE("the bilinear map keeps the response at its own frequencies, and comes back") {
  const auto ss = to_state_space(plant(5));
  REQUIRE(ss);
  const double T = 0.02, a = prewarped(9.0, T);
  const auto z = bilinear(*ss, a, T);
  REQUIRE(z);
  const Eigen::VectorXd at = Eigen::VectorXd::Constant(1, 9.0 / kTwoPi);
  CHECK(std::abs(frequency_response(*z, at)[0](0, 0) / frequency_response(*ss, at)[0](0, 0) - 1.0) < 1e-12);
  const auto back = undo_bilinear(*z, a);
  REQUIRE(back);
  CHECK(difference(frequency_response(*back, lines()), frequency_response(plant(5), lines())) < 1e-12);
}

TEST_CASE("a zero-order hold is undone") {
  const auto ss = to_state_space(plant(5));
  REQUIRE(ss);
  const auto held = zero_order_hold(*ss, 0.02);
  REQUIRE(held);
  const auto back = undo_zero_order_hold(held->model);
  REQUIRE(back);
  CHECK(difference(frequency_response(*back, lines()), frequency_response(plant(5), lines())) < 1e-9);
  const StateSpace negative{-0.5 * Eigen::MatrixXd::Identity(1, 1), Eigen::MatrixXd::Ones(1, 1), Eigen::MatrixXd::Ones(1, 1),
                            Eigen::MatrixXd::Zero(1, 1), 0.1};
  CHECK(undo_zero_order_hold(negative).error().text ==
        "a pole at z = -0.500000: no continuous-time system of as many states has it");
}

TEST_CASE("Hessenberg solves give the response of a mixed realisation") {
  const auto ss = to_state_space(plant(9));
  REQUIRE(ss);
  CHECK(difference(hessenberg_response(mixed(*ss), lines()), frequency_response(plant(9), lines())) < 1e-9);
}

TEST_CASE("Hessenberg solves give the response of a system whose eigenvectors are nearly dependent") {
  // Ten poles at -1 and one after the other: the response is 1/(s + 1)^10.
  StateSpace s;
  s.A = -Eigen::MatrixXd::Identity(10, 10);
  s.A.diagonal(-1).setOnes();
  s.B = Eigen::VectorXd::Unit(10, 0);
  s.C = Eigen::RowVectorXd::Unit(10, 9);
  s.D = Eigen::MatrixXd::Zero(1, 1);
  const Eigen::VectorXd frequency = lines();
  Eigen::VectorXcd expected(frequency.size());
  for (Eigen::Index k = 0; k < frequency.size(); ++k) expected[k] = std::pow(1.0 / Complex(1.0, kTwoPi * frequency[k]), 10);
  CHECK(difference(hessenberg_response(s, frequency), expected) < 1e-12);
  CHECK(difference(frequency_response(s, frequency), expected) < 1e-12);
}
