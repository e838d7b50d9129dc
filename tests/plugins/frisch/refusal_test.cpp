#include <limits>

#include "catch.hpp"
#include "frisch/corrected_response.hpp"
#include "motor.hpp"

using namespace bodeflow::frisch;

namespace {
PowerSpectra two_lines() { return {Eigen::Vector2d(2, 3), Eigen::Vector2d(1, 2), Eigen::Vector2cd(1, 2)}; }
}  // namespace

TEST_CASE("frisch: windows that cannot be taken are refused with what was found") {
  const Eigen::VectorXd ten = Eigen::VectorXd::Ones(10);
  CHECK(window_spectra(ten, 12, 12, {1}).error().text == "the record has 10 samples, fewer than a period of 12");
  CHECK(window_spectra(ten, 8, 0, {1}).error().text == "period and step must be at least 1 sample");
  CHECK(window_spectra(ten, 8, 8, {4}).error().text == "line 4 is not within 1 .. 3");
  Eigen::VectorXd broken = ten;
  broken[9] = std::numeric_limits<double>::infinity();
  CHECK(window_spectra(broken, 8, 8, {1}).error().text == "sample 9 is not a finite number");
  const Eigen::MatrixXcd a = Eigen::MatrixXcd::Ones(2, 3), b = Eigen::MatrixXcd::Ones(2, 4), one = a.leftCols(1);
  CHECK(power_spectra(a, b).error().text == "spectra of input and output differ in size: 2 x 3 and 2 x 4");
  CHECK(pooled_noise(one, one).error().text == "at least 2 windows are needed; found 1");
  CHECK(mean_spectra(Eigen::VectorXd::Ones(3), a, a, {}).error().text == "3 frequencies for 2 lines");
}

TEST_CASE("frisch: spectra that are no covariances are refused by line") {
  PowerSpectra s = two_lines();
  s.yu[1] = 3.0;
  CHECK(noise_variances(s).error().text == "line 1 of the spectra is no covariance: |yu|^2 exceeds uu yy");
  s = two_lines();
  s.uu[0] = 0.0;
  CHECK(noise_variances(s).error().text == "line 0 of the spectra has no power");
  s.uu[0] = std::nan("");
  CHECK(noise_variances(s).error().text == "line 0 of the spectra is not finite");
  CHECK(noise_variances({}).error().text == "the spectra have no line");
  CHECK(frisch_noise(two_lines(), 1.0).error().text == "the fraction of lines to remove must be within 0 .. 1");
  CHECK(frisch_noise(two_lines(), 0.9).error().text == "the fraction of lines to remove leaves no line");
  CHECK(corrected_response(two_lines(), {2.5, 0, 0}, ResponseForm::input).error().text ==
        "line 0 of the spectra: the input power is not above its noise");
  s = two_lines();
  s.yu[0] = 0.0;
  CHECK(corrected_response(s, {}, ResponseForm::output).error().text ==
        "line 0 of the spectra: input and output are not correlated");
}

TEST_CASE("frisch: fits that cannot be made are refused with what was found") {
  const Eigen::Vector3d omega(1, 2, 3);
  const Eigen::VectorXcd g = response(bodeflow::test::paper_motor(), omega);
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(3);
  CHECK(fit_motor(omega, g.head(2), ones).error().text == "3 frequencies for 2 lines");
  CHECK(fit_motor(omega, g, ones.head(2)).error().text == "2 weights for 3 lines");
  CHECK(fit_motor(omega, g, -ones).error().text == "weights must be finite and at least 0");
  CHECK(fit_motor(omega.head(2), g.head(2), ones.head(2)).error().text == "the fit needs at least 3 lines; found 2");
  CHECK(motor_start(Eigen::Vector2d(0, 1), g.head(2)).error().text == "responses must be finite, frequencies finite and above 0");
  MeanSpectra s{omega, ones.cast<std::complex<double>>(), g, ones, ones, Eigen::VectorXcd::Zero(3)};
  s.input_variance[1] = s.output_variance[1] = 0.0;
  CHECK(fit_motor_likelihood(s).error().text ==
        "line 1 of the spectra: the noise variances must be finite, at least 0, and not both 0");
  s.input_variance[1] = 1.0;
  s.covariance[1] = 0.5;
  CHECK(fit_motor_likelihood(s).error().text == "line 1 of the spectra: the noise covariance exceeds what the variances allow");
  CHECK(motor_model(1, 1, 1, 1, 1).error().text == "Lm^2 must be below Ls Lr: the leakage is not positive");
  CHECK(motor_model(0, 1, 1, 1, 0.5).error().text == "resistances and inductances must be above 0 and finite");
}
