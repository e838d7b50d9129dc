#include "spectrum/distortion.hpp"

#include <iostream>

#include "catch.hpp"
#include "data.hpp"
#include "periodic.hpp"
#include "spectrum/averaging_dft.hpp"
#include "spectrum/response_checks.hpp"

using namespace bodeflow;
using namespace bodeflow::spectrum;
using namespace bodeflow::test;

namespace {

Measured bench(const Table& data, int period, int skip) {
  const auto signals = static_cast<Eigen::Index>(data.columns.size());
  AveragingDft average(period, signals - 1);
  for (std::int64_t p = skip; (p + 1) * period <= data.rows(); ++p) {
    Eigen::MatrixXd frame(period, signals);
    for (Eigen::Index c = 0; c < signals; ++c) {
      frame.col(c) = Eigen::Map<const Eigen::VectorXd>(data.columns[static_cast<std::size_t>(c)].data() + p * period, period);
    }
    average.add(frame);
  }
  return {{1, signals - 1, 0}, period, 1, {*average.moments()}};
}

}  // namespace

TEST_CASE("distortion: bench data B has odd distortion 17 times and even 6 times the noise of the motor angle") {
  const auto data = shared_table("motorbench_two_mass/multisine_B.csv", {"iq_A", "theta_motor_rad", "theta_load_rad"});
  if (!data) return;
  const Measured m = bench(*data, 2500, 1);
  LineChoice choice{lines_of(11, 250), 0.3};
  const auto e = estimate_response(m, choice, Form::errors_in_variables);
  REQUIRE(e);
  CHECK(e->lines.size() == 60);
  const Levels levels = levels_of(m, e->lines, 11, 250);
  const KindLevel odd = rms_of(levels, Levels::odd), even = rms_of(levels, Levels::even),
                  excited = rms_of(levels, Levels::excited);
  const Eigen::VectorXd noise = rms_noise(levels);
  CHECK(excited.lines == 60);
  CHECK(odd.lines == 60);
  CHECK(even.lines == 120);
  for (Eigen::Index i = 0; i < 2; ++i) {
    std::cout << "bench data B, " << (i == 0 ? "motor" : "load") << " angle: peak levels odd " << 2.0 * odd.level[i] << ", even "
              << 2.0 * even.level[i] << ", noise " << 2.0 * noise[i] << " rad; over noise odd " << odd.level[i] / noise[i]
              << ", even " << even.level[i] / noise[i] << "; odd over excited " << odd.level[i] / excited.level[i] << "\n";
  }
  // Published beside the data: 1.12e-4 and 6.6e-6 rad (peak values), 17 and 6 times, 1.9 % of the excited amplitude.
  CHECK(2.0 * odd.level[0] == Approx(1.12e-4).epsilon(0.01));
  CHECK(2.0 * noise[0] == Approx(6.6e-6).epsilon(0.01));
  CHECK(odd.level[0] / noise[0] == Approx(17.0).margin(0.5));
  CHECK(even.level[0] / noise[0] == Approx(6.0).margin(0.5));
  CHECK(odd.level[0] / excited.level[0] == Approx(0.019).margin(0.0005));

  const std::vector<std::string> warnings =
      response_warnings({m, *e, levels, Form::errors_in_variables, 1.0, {"iq", "motor", "load"}});
  REQUIRE(warnings.size() == 2);
  CHECK(
      warnings[0] ==
      "output 'motor': distortion at unexcited lines is odd 16.9 and even 6.35 times the noise, and not in the variance; measure "
      "several realisations (realisations: 7), or with another amplitude");
}

TEST_CASE("distortion: a square shows at even lines, a cube at odd ones, a linear plant at none") {
  const int N = 256;
  std::vector<std::int64_t> lines;
  for (const std::int64_t k : lines_of(1, 61, 2)) {
    if (k % 8 != 5) lines.push_back(k);
  }
  numerics::Random random(1);
  const Eigen::VectorXd u = random_multisine(N, lines, 0.2, random);
  const auto levels = [&](double square, double cube) {
    const Eigen::VectorXd y = u + square * u.cwiseAbs2() + cube * u.cwiseProduct(u).cwiseProduct(u);
    AveragingDft average(N, 1);
    for (int p = 0; p < 6; ++p) average.add(u, y + noise(N, 1e-3, random));
    const Measured m{{1, 1, 0}, N, 1, {*average.moments()}};
    return levels_of(m, lines, 1, 61);
  };
  const double usual = 1e-3 / std::sqrt(6.0 * N);
  const Levels linear = levels(0.0, 0.0), square = levels(0.1, 0.0), cube = levels(0.0, 0.1);
  CHECK(rms_noise(linear)[0] == Approx(usual).epsilon(0.1));
  CHECK(rms_of(linear, Levels::odd).level[0] == Approx(usual).epsilon(0.5));
  CHECK(rms_of(linear, Levels::even).level[0] == Approx(usual).epsilon(0.3));
  CHECK(rms_of(square, Levels::even).level[0] > 50.0 * usual);
  CHECK(rms_of(square, Levels::odd).level[0] == Approx(usual).epsilon(0.5));
  CHECK(rms_of(cube, Levels::odd).level[0] > 50.0 * usual);
  CHECK(rms_of(cube, Levels::even).level[0] == Approx(usual).epsilon(0.3));
  // Beside line 3 stand the unexcited lines 5 and nothing below; beside 7 lines 5 and 13.
  const Eigen::MatrixXd beside = level_beside(cube, {3, 7}, Levels::odd);
  const auto at = [&](std::int64_t k) { return cube.output_level(k - 1, 0); };
  CHECK(beside(0, 0) == Approx(at(5)).epsilon(1e-12));
  CHECK(beside(1, 0) == Approx(std::sqrt(0.5 * (at(5) * at(5) + at(13) * at(13)))).epsilon(1e-12));
  CHECK(level_beside(levels(0.0, 0.0), {3}, Levels::excited).size() == 1);
}
