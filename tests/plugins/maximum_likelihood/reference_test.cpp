// The motor of the reference file: its errors-in-variables estimate was computed by an independent program.

#include "../reference_file.hpp"
#include "catch.hpp"
#include "simulated.hpp"

using namespace bodeflow;
using namespace bodeflow::test;
using namespace bodeflow::maximum_likelihood;

namespace {

// Mean spectra of both bands, variances pooled over the 8 windows.
Spectra motor_spectra(const Json& file) {
  const Eigen::VectorXd omega = vector_of(file["omega"]);
  Spectra s = spectra_of(omega, Eigen::MatrixXcd::Zero(48, 1), Eigen::MatrixXd::Zero(48, 1));
  Eigen::Index at = 0;
  for (const std::string band : {"lo", "hi"}) {
    const Json& pooled = file["spectra_and_frisch"][band + "_pooled"];
    const double windows = pooled["windows"].get<double>();
    s.input.segment(at, 24) = complex_vector_of(pooled["Ubar"]);
    s.output.col(0).segment(at, 24) = complex_vector_of(pooled["Ybar"]);
    s.input_variance.segment(at, 24).setConstant(pooled["var_u"].get<double>() / windows);
    s.output_variance.col(0).segment(at, 24).setConstant(pooled["var_y"].get<double>() / windows);
    at += 24;
  }
  return s;
}

// gamma, alpha, Lm beta, sigma of (s + alpha)/sigma / (s^2 + s (gamma + alpha) + alpha (gamma - alpha Lm_beta)).
Eigen::Vector4d physical(const Eigen::VectorXd& c) {
  const double sigma = 1.0 / c[0], alpha = c[1] * sigma, gamma = c[2] - alpha;
  return {gamma, alpha, (gamma - c[3] / alpha) / alpha, sigma};
}

}  // namespace

TEST_CASE("maximum likelihood: the motor of the reference file to 1e-5") {
  const Json file = reference_file("errors_in_variables/frisch_motor.json");
  const auto id = identify(motor_spectra(file), settings(Domain::s, 2));
  REQUIRE(id);
  const Coefficients c =
      coefficients_of(id->fit.lines, id->fit.structure, id->fit.minimum.estimate, 0, id->fit.models[0], id->covariance_root);
  const Eigen::Vector4d found = physical(c.values), expected = vector_of(file["eiv_ml"]["p"]);
  CHECK((found - expected).cwiseQuotient(expected).cwiseAbs().maxCoeff() < 1e-5);
  CHECK(id->test.cost == Approx(file["eiv_ml"]["cost"].get<double>()).epsilon(1e-8));
  CHECK(id->test.expected == 46.0);

  // Standard deviations by the slopes of the physical parameters; the file's are those of J^T J with the noise of the input in J.
  REQUIRE(id->covariance_kind == CovarianceKind::information);
  Eigen::Matrix4d slope;
  for (Eigen::Index i = 0; i < 4; ++i) {
    Eigen::VectorXd up = c.values, down = c.values;
    const double step = 1e-5 * c.values[i];
    up[i] += step;
    down[i] -= step;
    slope.col(i) = (physical(up) - physical(down)) / (2.0 * step);
  }
  const Eigen::Vector4d deviation = (slope * c.covariance * slope.transpose()).diagonal().cwiseSqrt();
  const Eigen::Vector4d expected_deviation = vector_of(file["eiv_ml"]["std"]);
  CHECK((deviation - expected_deviation).cwiseQuotient(expected_deviation).cwiseAbs().maxCoeff() < 0.1);
}
