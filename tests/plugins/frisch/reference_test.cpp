#include "../reference_file.hpp"
#include "catch.hpp"
#include "frisch/corrected_response.hpp"
#include "motor.hpp"

using namespace bodeflow::frisch;
using bodeflow::test::complex_vector_of;
using bodeflow::test::Json;
using bodeflow::test::reference_file;
using bodeflow::test::relative_difference;
using bodeflow::test::vector_of;

namespace {

PowerSpectra spectra_in(const Json& expected) {
  return {vector_of(expected["Phi_uu"]), vector_of(expected["Phi_yy"]), complex_vector_of(expected["Phi_yu"])};
}

std::vector<Eigen::Index> lines_in(const Json& band) { return band["lines"].get<std::vector<Eigen::Index>>(); }

void check_noise(const NoiseVariances& noise, const Json& expected) {
  CHECK(noise.input == Approx(expected["x1"].get<double>()).epsilon(1e-8));
  CHECK(noise.output == Approx(expected["x2"].get<double>()).epsilon(1e-8));
}

// The corrected response of both bands by a form, noise of the second pass or none.
Eigen::VectorXcd both_bands(const Json& file, const char* form) {
  const Json& low = file["spectra_and_frisch"]["lo_step128"][form];
  const Json& high = file["spectra_and_frisch"]["hi_step128"][form];
  return bodeflow::test::stacked(complex_vector_of(low), complex_vector_of(high));
}

}  // namespace

TEST_CASE("frisch: spectra, noise and corrected responses of the reference file to 1e-8") {
  const Json file = reference_file("errors_in_variables/frisch_motor.json");
  for (const std::string band : {"lo", "hi"}) {
    const Json& data = file["data"][band];
    for (const Eigen::Index step : {128, 16}) {
      CAPTURE(band, step);
      const Json& expected = file["spectra_and_frisch"][band + "_step" + std::to_string(step)];
      const auto u = window_spectra(vector_of(data["u"]), 128, step, lines_in(data));
      const auto y = window_spectra(vector_of(data["y"]), 128, step, lines_in(data));
      const auto s = power_spectra(*u, *y);
      REQUIRE(s);
      CHECK(relative_difference(s->uu, vector_of(expected["Phi_uu"])) < 1e-10);
      CHECK(relative_difference(s->yy, vector_of(expected["Phi_yy"])) < 1e-10);
      CHECK(relative_difference(s->yu, complex_vector_of(expected["Phi_yu"])) < 1e-10);
      const PowerSpectra given = spectra_in(expected);
      const auto noise = frisch_noise(given);
      REQUIRE(noise);
      check_noise(noise->first, expected["pass1"]);
      check_noise(noise->second, expected["pass2"]);
      CHECK(noise->first.cost == Approx(expected["pass1"]["cost"].get<double>()).epsilon(1e-8));
      CHECK(noise->removed == expected["pass2"]["removed"].get<std::vector<Eigen::Index>>());
      const auto check_form = [&](const NoiseVariances& n, ResponseForm form, const char* name) {
        const auto g = corrected_response(given, n, form);
        REQUIRE(g);
        CHECK(relative_difference(*g, complex_vector_of(expected[name])) < 1e-8);
      };
      check_form(noise->second, ResponseForm::output, "G_pass2_form_y");
      check_form(noise->second, ResponseForm::input, "G_pass2_form_u");
      check_form({}, ResponseForm::output, "G_raw_form_y");
    }
  }
}

TEST_CASE("frisch: pooled noise and mean spectra of the reference file to 1e-10") {
  const Json file = reference_file("errors_in_variables/frisch_motor.json");
  for (const std::string band : {"lo", "hi"}) {
    const Json& data = file["data"][band];
    const Json& expected = file["spectra_and_frisch"][band + "_pooled"];
    const auto u = window_spectra(vector_of(data["u"]), 128, 128, lines_in(data));
    const auto y = window_spectra(vector_of(data["y"]), 128, 128, lines_in(data));
    const auto noise = pooled_noise(*u, *y);
    REQUIRE(noise);
    CHECK(noise->input_variance == Approx(expected["var_u"].get<double>()).epsilon(1e-10));
    CHECK(noise->output_variance == Approx(expected["var_y"].get<double>()).epsilon(1e-10));
    CHECK(noise->degrees_of_freedom == 24.0 * 7.0);
    const auto means = mean_spectra(Eigen::VectorXd::Ones(24), *u, *y, *noise);
    CHECK(relative_difference(means->input, complex_vector_of(expected["Ubar"])) < 1e-10);
    CHECK(relative_difference(means->output, complex_vector_of(expected["Ybar"])) < 1e-10);
    CHECK(means->input_variance[3] == Approx(noise->input_variance / 8.0));
  }
}

TEST_CASE("frisch: least squares on the reference file's responses to 1e-5") {
  const Json file = reference_file("errors_in_variables/frisch_motor.json");
  const Eigen::VectorXd omega = vector_of(file["omega"]);
  const auto check_fit = [&](const char* form, const Json& expected) {
    const auto fit = fit_motor(omega, both_bands(file, form), Eigen::VectorXd::Ones(48));
    REQUIRE(fit);
    CHECK(fit->converged);
    CAPTURE(fit->model.vector().transpose());
    CHECK(fit->model.vector().cwiseQuotient(vector_of(expected["p"])).isApproxToConstant(1.0, 1e-5));
    CHECK(fit->cost == Approx(expected["cost"].get<double>()).epsilon(1e-8));
  };
  check_fit("G_pass2_form_y", file["nls_frisch"]);
  check_fit("G_raw_form_y", file["nls_raw"]);
}

TEST_CASE("frisch: maximum likelihood on the reference file's mean spectra to 1e-5, with its standard deviations") {
  const Json file = reference_file("errors_in_variables/frisch_motor.json");
  const Json& expected = file["eiv_ml"];
  const Eigen::VectorXd omega = vector_of(file["omega"]);
  const auto band = [&](const char* name, const Eigen::VectorXd& w) {
    const Json& pooled = file["spectra_and_frisch"][name];
    const Eigen::VectorXd ones = Eigen::VectorXd::Constant(24, 1.0 / 8.0);
    return MeanSpectra{w,
                       complex_vector_of(pooled["Ubar"]),
                       complex_vector_of(pooled["Ybar"]),
                       pooled["var_u"].get<double>() * ones,
                       pooled["var_y"].get<double>() * ones,
                       Eigen::VectorXcd::Zero(24)};
  };
  const auto fit = fit_motor_likelihood(joined(band("lo_pooled", omega.head(24)), band("hi_pooled", omega.tail(24))));
  REQUIRE(fit);
  CHECK(fit->converged);
  CAPTURE(fit->model.vector().transpose(), fit->covariance.diagonal().cwiseSqrt().transpose());
  CHECK(fit->model.vector().cwiseQuotient(vector_of(expected["p"])).isApproxToConstant(1.0, 1e-5));
  CHECK(fit->cost == Approx(expected["cost"].get<double>()).epsilon(1e-8));
  CHECK(fit->expected_cost == 46.0);
  CHECK(fit->covariance.diagonal().cwiseSqrt().cwiseQuotient(vector_of(expected["std"])).isApproxToConstant(1.0, 1e-5));
}
