// Gilbert realisation, residues, modal form, Hankel singular values and balanced truncation.

#include <Eigen/Dense>
#include <fstream>
#include <nlohmann/json.hpp>

#include "bodeflow/numerics/balanced_truncation.hpp"
#include "bodeflow/numerics/bilinear.hpp"
#include "bodeflow/numerics/discretise.hpp"
#include "bodeflow/numerics/frequency_response.hpp"
#include "bodeflow/numerics/pole_residue.hpp"
#include "bodeflow/numerics/random.hpp"
#include "catch.hpp"

using namespace bodeflow::numerics;
using Complex = std::complex<double>;
using Json = nlohmann::json;
using Responses = std::vector<Eigen::MatrixXcd>;

namespace {

const double kTwoPi = 2 * 3.14159265358979323846;

Json reference() { return Json::parse(std::ifstream(BODEFLOW_TEST_DATA "/rational_fits/gilbert_small.json")); }

Eigen::MatrixXd matrix(const Json& rows) {
  Eigen::MatrixXd m(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(rows.front().size()));
  for (Eigen::Index i = 0; i < m.rows(); ++i)
    for (Eigen::Index j = 0; j < m.cols(); ++j)
      m(i, j) = rows[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)].get<double>();
  return m;
}

Eigen::MatrixXcd complex_matrix(const Json& re, const Json& im) {
  Eigen::MatrixXcd m(matrix(re).rows(), matrix(re).cols());
  m.real() = matrix(re);
  m.imag() = matrix(im);
  return m;
}

PoleResidue reference_system() {
  const Json file = reference();
  PoleResidue system;
  system.poles.resize(3);
  for (Eigen::Index i = 0; i < 3; ++i) {
    const auto at = static_cast<std::size_t>(i);
    system.poles[i] = Complex(file["poles"]["re"][at].get<double>(), file["poles"]["im"][at].get<double>());
    const Json& M = file["M"][at];
    system.residues.push_back(M.is_object() ? complex_matrix(M["re"], M["im"]) : matrix(M).cast<Complex>());
  }
  system.D = matrix(file["D"]);
  return system;
}

double difference(const Responses& a, const Responses& b) {
  double worst = 0.0, largest = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    worst = std::max(worst, (a[k] - b[k]).cwiseAbs().maxCoeff());
    largest = std::max(largest, b[k].cwiseAbs().maxCoeff());
  }
  return worst / largest;
}

Eigen::VectorXd lines(double first, double last, Eigen::Index count) {
  return Eigen::VectorXd::LinSpaced(count, std::log(first), std::log(last)).array().exp() / kTwoPi;
}

/// Random modes with residues of rank 1, the strength falling by `decay` a mode.
PoleResidue random_modes(Eigen::Index modes, double decay) {
  Random random(7);
  PoleResidue system;
  system.poles.resize(modes);
  system.D = Eigen::MatrixXd::Zero(2, 3);
  double strength = 1.0;
  for (Eigen::Index i = 0; i < modes; ++i, strength *= decay) {
    const double omega = 1.0 + 3.0 * static_cast<double>(i);
    system.poles[i] = omega * Complex(-0.02, 1.0);
    Eigen::VectorXcd left(2);
    Eigen::RowVectorXcd right(3);
    for (Complex& x : left) x = Complex(random.normal(), random.normal());
    for (Complex& x : right) x = Complex(random.normal(), random.normal());
    system.residues.emplace_back(strength * left * right);
  }
  return system;
}

}  // namespace

TEST_CASE("a Gilbert realisation has the reference's states, response and Hankel singular values") {
  const Json file = reference();
  const auto ss = gilbert_realisation(reference_system(), 1e-9);
  REQUIRE(ss);
  CHECK(ss->states() == file["states"].get<Eigen::Index>());
  CHECK(ss->D == matrix(file["D"]));
  Eigen::VectorXd frequency(static_cast<Eigen::Index>(file["s_im"].size()));
  Responses expected;
  for (Eigen::Index k = 0; k < frequency.size(); ++k) {
    const auto at = static_cast<std::size_t>(k);
    frequency[k] = file["s_im"][at].get<double>() / kTwoPi;
    expected.push_back(complex_matrix(file["H"]["re"][at], file["H"]["im"][at]));
  }
  CHECK(difference(frequency_response(*ss, frequency), expected) < 1e-13);
  CHECK(difference(frequency_response(reference_system(), frequency), expected) < 1e-13);
  const auto hsv = hankel_singular_values(*ss);
  REQUIRE(hsv);
  for (std::size_t i = 0; i < 7; ++i)
    CHECK(hsv->coeff(static_cast<Eigen::Index>(i)) == Approx(file["hsv"][i].get<double>()).epsilon(1e-11));
}

TEST_CASE("residues come back from a realisation in any coordinates, and its modal form is the same system") {
  const PoleResidue system = random_modes(6, 0.8);
  auto ss = gilbert_realisation(system, 1e-9);
  REQUIRE(ss);
  REQUIRE(ss->states() == 12);
  Random random(3);
  Eigen::MatrixXd T(12, 12);
  for (double& x : T.reshaped()) x = random.normal();
  const StateSpace mixed{T.lu().solve(ss->A * T), T.lu().solve(ss->B), ss->C * T, ss->D, 0.0};
  const Eigen::VectorXd frequency = lines(0.3, 40, 50);
  const Responses expected = frequency_response(system, frequency);
  const auto back = to_pole_residue(mixed);
  REQUIRE(back);
  CHECK(back->poles.size() == 6);
  CHECK(difference(frequency_response(*back, frequency), expected) < 1e-10);
  const auto modal = modal_form(mixed);
  REQUIRE(modal);
  CHECK(difference(frequency_response(*modal, frequency), expected) < 1e-10);
  CHECK(modal->A.block(0, 2, 2, 10).isZero(0.0));
}

TEST_CASE("residues by least squares are exact on exact data") {
  PoleResidue system = random_modes(8, 0.7);
  system.poles.conservativeResize(9);
  system.poles[8] = -2.5;
  system.residues.emplace_back(Eigen::MatrixXcd::Constant(2, 3, 0.75));
  system.D.setConstant(0.125);
  const Eigen::VectorXd frequency = lines(0.3, 60, 80);
  const auto found = residues_by_least_squares(system.poles, frequency, frequency_response(system, frequency), {});
  REQUIRE(found);
  for (std::size_t i = 0; i < 9; ++i) CHECK((found->residues[i] - system.residues[i]).norm() < 1e-11);
  CHECK((found->D - system.D).norm() < 1e-12);
}

TEST_CASE("Hankel singular values show a gap far below the root of the rounding error") {
  const PoleResidue system = random_modes(10, 0.1);
  const auto minimal = gilbert_realisation(system, 1e-9);
  REQUIRE(minimal);
  auto doubled = *minimal;  // ten states more than needed, hidden by a change of coordinates
  const Eigen::Index n = minimal->states();
  doubled.A = Eigen::MatrixXd::Zero(n + 2, n + 2);
  doubled.A.topLeftCorner(n, n) = minimal->A;
  doubled.A.bottomRightCorner(2, 2) << -0.1, 2.0, -2.0, -0.1;
  doubled.B.conservativeResize(n + 2, 3);
  doubled.B.bottomRows(2).setOnes();
  doubled.C.conservativeResize(2, n + 2);
  doubled.C.rightCols(2).setZero();
  const auto hsv = hankel_singular_values(doubled);
  REQUIRE(hsv);
  INFO(hsv->transpose());
  CHECK((*hsv)[n - 1] / (*hsv)[0] > 1e-12);
  CHECK((*hsv)[n - 1] / (*hsv)[0] < 1e-10);
  CHECK((*hsv)[n] / (*hsv)[0] < 1e-15);
}

TEST_CASE("balanced truncation keeps its error bound, and a minimal part whole") {
  const auto ss = gilbert_realisation(random_modes(8, 0.4), 1e-9);
  REQUIRE(ss);
  const Eigen::VectorXd frequency = lines(0.1, 100, 200);
  const Responses full = frequency_response(*ss, frequency);
  for (const Eigen::Index states : {16, 12, 8, 4}) {
    const auto reduced = balanced_truncation(*ss, states);
    REQUIRE(reduced);
    CHECK(reduced->system.states() == states);
    const Responses part = frequency_response(reduced->system, frequency);
    double worst = 0.0;
    for (std::size_t k = 0; k < full.size(); ++k) worst = std::max(worst, Eigen::MatrixXcd(full[k] - part[k]).operatorNorm());
    INFO(states << " states: " << worst << " of " << reduced->error_bound);
    CHECK(worst <= reduced->error_bound + 1e-13 * reduced->hankel_singular_values[0]);
    if (states < 16) CHECK(worst >= 0.999 * reduced->hankel_singular_values[states]);
  }
}

TEST_CASE("a discrete-time system has the Hankel singular values of its bilinear map, and is truncated as such") {
  const auto ss = gilbert_realisation(random_modes(4, 0.5), 1e-9);
  REQUIRE(ss);
  const auto z = bilinear(*ss, 20.0, 0.05);
  REQUIRE(z);
  const auto of_s = hankel_singular_values(*ss), of_z = hankel_singular_values(*z);
  REQUIRE(of_s);
  REQUIRE(of_z);
  CHECK((*of_s - *of_z).norm() < 1e-12 * of_s->norm());
  const auto reduced = balanced_truncation(*z, 8);
  REQUIRE(reduced);
  CHECK(reduced->system.sample_time == 0.05);
  CHECK(difference(frequency_response(reduced->system, lines(0.1, 50, 30)), frequency_response(*z, lines(0.1, 50, 30))) < 1e-12);
}

TEST_CASE("a Gramian factor solves the Lyapunov equation") {
  const auto ss = gilbert_realisation(random_modes(5, 0.9), 1e-9);
  REQUIRE(ss);
  const auto L = gramian_factor(ss->A, ss->B);
  REQUIRE(L);
  const Eigen::MatrixXd P = *L * L->transpose();
  CHECK((ss->A * P + P * ss->A.transpose() + ss->B * ss->B.transpose()).norm() < 1e-13 * ss->A.norm() * P.norm());
}

TEST_CASE("realisation and reduction refuse what has no answer") {
  PoleResidue system = random_modes(2, 0.5);
  system.poles[1] = std::conj(system.poles[1]);
  CHECK(gilbert_realisation(system).error().text == "pole 2 has a negative imaginary part: of a pair the other one is listed");
  const StateSpace unstable{Eigen::MatrixXd::Identity(1, 1), Eigen::MatrixXd::Ones(1, 1), Eigen::MatrixXd::Ones(1, 1),
                            Eigen::MatrixXd::Zero(1, 1), 0.0};
  CHECK(hankel_singular_values(unstable).error().text == "the system is not stable: it has no Gramian");
  Eigen::MatrixXd jordan(2, 2);
  jordan << -1, 1, 0, -1;
  const StateSpace defective{jordan, Eigen::MatrixXd::Ones(2, 1), Eigen::MatrixXd::Ones(1, 2), Eigen::MatrixXd::Zero(1, 1), 0.0};
  CHECK(to_pole_residue(defective).error().text == "the poles are not simple: the eigenvectors are nearly dependent");
  CHECK(balanced_truncation(defective, 3).error().text == "3 states; allowed: 0 to 2");
}
