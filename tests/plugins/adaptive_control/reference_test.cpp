#include "../reference_file.hpp"
#include "adaptive_control/largest_bandwidth.hpp"
#include "adaptive_control/pole_patterns.hpp"
#include "catch.hpp"
#include "loop.hpp"

using namespace bodeflow::test;
namespace numerics = bodeflow::numerics;

namespace {

Eigen::VectorXd coefficients(const ac::Coefficients& c, int n) { return Eigen::Map<const Eigen::VectorXd>(c.data(), n + 1); }

std::vector<std::complex<double>> complex_list(const Json& list) {
  std::vector<std::complex<double>> values;
  for (const Json& pair : list) values.emplace_back(pair[0].get<double>(), pair[1].get<double>());
  return values;
}

struct Nominal {
  explicit Nominal(const Json& c) : reference(c) {
    structure.sample_time = c["h"];
    structure.omega = c["Omega"].get<std::vector<double>>();
    structure.n_r = c["n_R"];
    structure.n_s = c["n_S"];
    structure.r_p = vector_of(c["R_p"]);
    structure.s_p = vector_of(c["S_p"]);
    desired = {vector_of(c["Am_s"]), vector_of(c["Ao_s"]), c["tau_m"].get<double>()};
    plant = {vector_of(c["plant"]["num"]), vector_of(c["plant"]["den"]), 0.0};
    delay = c["plant"]["tau"];
    response = *ac::sampled_response(plant, delay, structure.sample_time, structure.omega);
    const auto g_m = ac::desired_points(desired, structure.sample_time, structure.omega);
    design = *ac::RstDesign::make(structure, *g_m, *ac::sampled_observer(desired.a_o, structure.sample_time));
    REQUIRE(design->solve(response.data(), result));
  }

  const Json& reference;
  ac::RstStructure structure;
  ac::DesiredResponse desired;
  numerics::TransferFunction plant;
  double delay = 0.0;
  std::vector<std::complex<double>> response;
  std::optional<ac::RstDesign> design;
  ac::RstResult result;
};

double difference(const std::vector<std::complex<double>>& found, const Json& expected) {
  const auto wanted = complex_list(expected);
  double largest = 0.0;
  for (std::size_t j = 0; j < found.size(); ++j) largest = std::max(largest, std::abs(found[j] - wanted[j]));
  return largest;
}

}  // namespace

TEST_CASE("pole patterns: Bessel and Butterworth polynomials agree with the reference") {
  const Json file = reference_file("adaptive_control/polynomials.json");
  for (int n = 1; n <= 8; ++n) CHECK(relative_difference(ac::bessel(n, 1.0), vector_of(file["bess"][std::to_string(n)])) < 1e-13);
  CHECK(relative_difference(ac::bessel(2, 0.5), vector_of(file["bess_2_05"])) < 1e-13);
  const double pi = std::numbers::pi;
  CHECK(relative_difference(ac::butterworth(2, 1.0, pi / 4), vector_of(file["butt_2_1_pi4"])) < 1e-13);
  CHECK(relative_difference(ac::butterworth(3, 1.0, pi / 3), vector_of(file["butt_3_1_pi3"])) < 1e-13);
  CHECK(relative_difference(ac::butterworth(4, 0.5, pi / 3), vector_of(file["butt_4_05_60deg"])) < 1e-13);
}

TEST_CASE("recursive least squares in U D factors agrees with the reference to 1e-12") {
  const auto columns = csv_columns(BODEFLOW_TEST_DATA "/adaptive_control/rls_ud_lambda0.98_P0_100.csv");
  ac::UdLeastSquares ud(3, 100.0);
  double largest = 0.0;
  for (std::size_t k = 0; k < columns.at("y").size(); ++k) {
    const ac::Regressor phi{columns.at("phi0")[k], columns.at("phi1")[k], columns.at("phi2")[k]};
    const double error = columns.at("y")[k] - ud.prediction(phi);
    ud.measure(phi, 0.98);
    ud.correct(error);
    for (std::size_t i = 0; i < 3; ++i) {
      const double theta = columns.at("theta" + std::to_string(i))[k], p = columns.at("Pdiag" + std::to_string(i))[k];
      largest = std::max({largest, std::abs(ud.theta()[i] / theta - 1.0), std::abs(ud.covariance(i, i) / p - 1.0)});
    }
  }
  CHECK(largest < 1e-12);
}

TEST_CASE("designs with known plants agree with the reference: response 1e-12, coefficients 1e-9") {
  const Json file = reference_file("adaptive_control/nominal_designs.json");
  REQUIRE(file.size() == 14);
  for (const Json& c : file) {
    INFO(c["name"].get<std::string>());
    const Nominal n(c);
    const double tolerance = n.structure.n_r == 2 ? 1e-9 : 1e-8;
    CHECK(difference(n.response, c["G"]) < 1e-12);
    const ac::Rst& rst = n.result.rst;
    CHECK(relative_difference(coefficients(rst.r, rst.n_r), vector_of(c["R"])) < tolerance);
    CHECK(relative_difference(coefficients(rst.s, rst.n_s), vector_of(c["S"])) < tolerance);
    CHECK(relative_difference(coefficients(rst.t, rst.n_t), vector_of(c["T_used"])) < tolerance);
    CHECK(n.result.t0 == Approx(c["t0"].get<double>()).epsilon(tolerance));
    CHECK(n.result.residual == Approx(c["residual"].get<double>()).epsilon(1e-6).margin(1e-12));
  }
}

TEST_CASE("closed loops of the reference designs: poles, sensitivity and gain margin") {
  const Json file = reference_file("adaptive_control/nominal_designs.json");
  for (const Json& c : file) {
    INFO(c["name"].get<std::string>());
    const Nominal n(c);
    const auto plant = ac::sampled_plant(n.plant, n.delay, 1.0);
    REQUIRE(plant);
    CHECK(relative_difference(plant->b, vector_of(c["plant"]["B"])) < 1e-10);
    CHECK(relative_difference(plant->a, vector_of(c["plant"]["A"])) < 1e-12);
    const auto quality = ac::loop_quality(*plant, n.result.rst);
    REQUIRE(quality);
    CHECK(quality->largest_pole == Approx(c["cl_max"].get<double>()).epsilon(1e-8));
    CHECK((quality->largest_pole < 1.0) == c["stable"].get<bool>());
    CHECK(quality->sensitivity == Approx(c["Ms"].get<double>()).epsilon(1e-3));
    CHECK(quality->gain_margin == Approx(c["GM"].get<double>()).epsilon(5e-3));
  }
}

TEST_CASE("an interpolating design leaves no residual") {
  const Json file = reference_file("adaptive_control/nominal_designs.json");
  Nominal n(file[4]);
  n.structure.omega = {0.1, 0.3, 0.7};
  n.structure.n_s = 2;
  n.structure.n_r = 3;  // 6 unknowns, 3 points
  const auto g_m = ac::desired_points(n.desired, 1.0, n.structure.omega);
  const auto design = ac::RstDesign::make(n.structure, *g_m, *ac::sampled_observer(ac::bessel(2, 0.5), 1.0));
  REQUIRE(design);
  ac::RstResult result;
  REQUIRE(design->solve(n.response.data(), result));
  CHECK(result.residual < 1e-12);
}

TEST_CASE("the largest bandwidth of section 3.4 lies between 0.85 and 0.86 rad/s") {
  const Json file = reference_file("adaptive_control/nominal_designs.json");
  const Nominal n(file[0]);
  const auto limit = ac::largest_bandwidth(n.structure, n.desired, n.response, ac::sampled_plant(n.plant, 0.0, 1.0).value());
  REQUIRE(limit);
  CHECK(0.5 * limit->factor > 0.85);
  CHECK(0.5 * limit->factor < 0.86);
}
