#include "../reference_file.hpp"
#include "catch.hpp"
#include "koopmans_levin/maximum_likelihood.hpp"
#include "koopmans_levin/poles.hpp"
#include "koopmans_levin/solution.hpp"
#include "koopmans_levin/time_domain.hpp"
#include "koopmans_levin/unknown_ratio.hpp"

using namespace bodeflow::koopmans_levin;
using bodeflow::test::Json;
using bodeflow::test::reference_file;
using bodeflow::test::relative_difference;
using bodeflow::test::vector_of;

namespace {

Lines lines_in(const Json& file, const char* input = "u", const char* output = "y", std::optional<Band> band = {}) {
  auto lines = lines_of(vector_of(file[input]), vector_of(file[output]), band);
  REQUIRE(lines);
  return *lines;
}

Solution solved(const Lines& lines, Eigen::Index order, double ratio, bool transient = true,
                NoiseMatrix noise = NoiseMatrix::exact) {
  const auto f = factors(lines, order, transient);
  REQUIRE(f);
  const auto s = solve(*f, ratio, noise);
  REQUIRE(s);
  return *s;
}

void compare(const Model& model, const Json& expected, double tolerance, double noise_tolerance) {
  CHECK(relative_difference(model.a.tail(model.order()), vector_of(expected["alpha"])) < tolerance);
  CHECK(relative_difference(model.b, vector_of(expected["beta"])) < tolerance);
  if (expected.contains("tau")) CHECK(relative_difference(model.tau, vector_of(expected["tau"])) < tolerance);
  CHECK(model.noise == Approx(expected["lambda_u"].get<double>()).epsilon(noise_tolerance));
}

}  // namespace

TEST_CASE("koopmans_levin: Example 1 of the reference file to 1e-9 for every ratio") {
  const Json file = reference_file("errors_in_variables/fdkl_ex1_N250.json");
  const Lines lines = lines_in(file);
  for (const auto& [ratio, expected] : file["result_by_rho"].items()) {
    CAPTURE(ratio);
    const Solution s = solved(lines, 2, std::stod(ratio));
    compare(s, expected, 1e-9, 1e-9);
    CHECK(relative_difference(s.squares, vector_of(expected["gen_sv2"])) < 1e-9);
  }
  compare(solved(lines, 2, 6.0, false), file["no_transient_rho6"], 1e-9, 1e-9);
}

TEST_CASE("koopmans_levin: the time-domain method of the reference file to 1e-10") {
  const Json file = reference_file("errors_in_variables/fdkl_ex1_N250.json");
  const auto f = time_domain_factors(vector_of(file["u"]), vector_of(file["y"]), 2);
  REQUIRE(f);
  compare(*solve(*f, 6.0), file["tdkl_rho6"], 1e-10, 1e-10);
}

TEST_CASE("koopmans_levin: maximum likelihood of the reference files, and no worse a likelihood") {
  const auto check = [](const Lines& lines, Eigen::Index order, const Json& expected) {
    const auto refined = maximum_likelihood(lines, solved(lines, order, 6.0));
    REQUIRE(refined);
    CHECK(refined->converged);
    // The file's search ended a little short of the minimum: its noise is 4e-10 above ours, its parameters 1e-4 away.
    CHECK(refined->model.noise <= expected["lambda_u"].get<double>());
    compare(refined->model, expected, 2e-4, 1e-8);
  };
  const Json one = reference_file("errors_in_variables/fdkl_ex1_N250.json");
  check(lines_in(one), 2, one["ml_known_rho6"]);
  const Json two = reference_file("errors_in_variables/fdkl_ex2_N2000.json");
  check(lines_in(two, "u", "y", Band{0, 199}), 4, two["results"]["window_ml"]);
}

TEST_CASE("koopmans_levin: covariance matching of the reference file") {
  const Json file = reference_file("errors_in_variables/fdkl_ex1_N250.json");
  const Json& expected = file["cm_unknown_rho"];
  const Lines lines = lines_in(file);
  const auto f = factors(lines, 2);
  const auto e = ratio_by_covariance_matching(lines, *f);
  REQUIRE(e);
  CHECK(e->lags == 2);
  CHECK(e->criterion == Approx(expected["J"].get<double>()).epsilon(1e-6));
  CHECK(e->ratio == Approx(expected["rho"].get<double>()).epsilon(1e-4));
  compare(e->solution, expected, 1e-4, 1e-4);
}

TEST_CASE("koopmans_levin: Example 2 of the reference file, window to 1e-6, all frequencies to 1e-9") {
  const Json file = reference_file("errors_in_variables/fdkl_ex2_N2000.json");
  const Lines window = lines_in(file, "u", "y", Band{0, 199});
  const Json& results = file["results"];
  compare(solved(window, 4, 6.0), results["window_exact_noise_matrix"], 1e-6, 1e-9);
  compare(solved(window, 4, 6.0, true, NoiseMatrix::identity), results["window_paper_identity"], 1e-6, 1e-6);
  compare(solved(lines_in(file), 4, 6.0), results["all_frequencies"], 1e-9, 1e-9);
  const auto f = factors(window, 4);
  const Eigen::MatrixXd T = f->noise.transpose() * f->noise;
  for (Eigen::Index i = 0; i < 5; ++i) {
    CHECK(relative_difference(T.row(i).transpose(), vector_of(file["T_W"][static_cast<std::size_t>(i)])) < 1e-12);
  }
}

TEST_CASE("koopmans_levin: Example 3 of the reference file, models to 1e-9, poles in rad/s") {
  const Json file = reference_file("errors_in_variables/fdkl_ex3_N4000.json");
  const Lines all = lines_in(file, "u_y3", "y_y1");
  const Lines window = lines_in(file, "u_y3", "y_y1", Band{0, 899});
  const auto check_poles = [&](const Model& model, const Json& expected) {
    const auto found = poles(model, Eigen::MatrixXd::Zero(4, 4), 1.0 / 400.0);
    REQUIRE(found);
    const Eigen::VectorXcd reference = bodeflow::test::complex_vector_of(expected["poles_rad_s"]);
    for (const auto& s : reference) {
      double nearest = 1e300;
      for (const Pole& p : *found) nearest = std::min(nearest, std::abs(p.s_rad_s - s));
      CHECK(nearest < 1e-5);
    }
  };
  const Json& results = file["results"];
  const Solution full = solved(all, 4, 1.0), tls = solved(all, 4, 1.0, false), narrow = solved(window, 4, 1.0);
  compare(full, results["fdkl"], 1e-9, 1e-9);
  compare(tls, results["tls_no_transient"], 1e-9, 1e-9);
  compare(narrow, results["fdkl_window_0_899_exact_noise"], 1e-9, 1e-9);
  check_poles(full, results["fdkl"]);
  check_poles(tls, results["tls_no_transient"]);
  check_poles(narrow, results["fdkl_window_0_899_exact_noise"]);
}
