#include "frisch/windows.hpp"

#include "catch.hpp"
#include "motor.hpp"

using namespace bodeflow::frisch;
using bodeflow::numerics::Random;

TEST_CASE("frisch: windows of a periodic signal agree whatever the step") {
  auto band = bodeflow::test::low_band(1.0);
  band.voltage_noise = band.current_noise = 0.0;
  Random random(1);
  const auto r = bodeflow::test::motor_record(band, random);
  for (const Eigen::Index step : {1, 16, 37, 128}) {
    const auto u = window_spectra(r.voltage, 128, step, band.lines);
    REQUIRE(u);
    CHECK(u->cols() == (1024 - 128) / step + 1);
    CHECK((u->colwise() - u->col(0)).cwiseAbs().maxCoeff() < 1e-12);
    CHECK(std::abs((*u)(3, 0)) == Approx(0.5 * std::sqrt(128.0)).epsilon(1e-12));
  }
}

TEST_CASE("frisch: pooled noise is unbiased, sees correlated noise, and white noise of variance v has power v") {
  Random random(2);
  const Eigen::Index periods = 4000;
  Eigen::VectorXd u(32 * periods), y(32 * periods);
  for (Eigen::Index t = 0; t < u.size(); ++t) {
    u[t] = 2.0 * random.normal();
    y[t] = 0.25 * u[t] + random.normal();
  }
  const std::vector<Eigen::Index> lines = {1, 3, 7, 15};
  const auto noise = pooled_noise(*window_spectra(u, 32, 32, lines), *window_spectra(y, 32, 32, lines));
  REQUIRE(noise);
  CHECK(noise->input_variance == Approx(4.0).epsilon(0.03));
  CHECK(noise->output_variance == Approx(1.25).epsilon(0.03));
  CHECK(noise->covariance.real() == Approx(1.0).epsilon(0.05));
  CHECK(std::abs(noise->covariance.imag()) < 0.07);
}
