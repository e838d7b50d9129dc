// Table 3 of the paper in the mean of 100 sets, and the coverage of intervals in 1000.

#include <Eigen/Dense>

#include "catch.hpp"
#include "frisch/corrected_response.hpp"
#include "motor.hpp"

using namespace bodeflow::frisch;
using bodeflow::numerics::Random;
using bodeflow::test::MotorBand;
using bodeflow::test::paper_motor;

namespace {

struct Statistics {
  Eigen::ArrayXd sum, squares;
  int count = 0;
  void add(const Eigen::ArrayXd& v) {
    if (count++ == 0) sum = Eigen::ArrayXd::Zero(v.size()), squares = sum;
    sum += v;
    squares += v.square();
  }
  Eigen::ArrayXd mean() const { return sum / count; }
  Eigen::ArrayXd std() const { return ((squares - sum.square() / count) / (count - 1)).sqrt(); }
};

PowerSpectra spectra_of(const bodeflow::test::MotorRecord& r, const MotorBand& band) {
  const auto w = bodeflow::test::windows(r, band, 16);
  return *power_spectra(w.input, w.output);
}

Eigen::VectorXcd frisch_response(const PowerSpectra& s, bool corrected) {
  return *corrected_response(s, corrected ? frisch_noise(s)->second : NoiseVariances{}, ResponseForm::output);
}

}  // namespace

TEST_CASE("frisch: Table 3 in 100 sets, biased without the scheme, less so with it, not with maximum likelihood") {
  const MotorBand low = bodeflow::test::low_band(1.0), high = bodeflow::test::high_band(0.85);
  const Eigen::VectorXd omega = bodeflow::test::stacked(low.omega(), high.omega()), ones = Eigen::VectorXd::Ones(48);
  const Eigen::Array4d truth = paper_motor().vector();
  Random random(7);
  Statistics without, with, likelihood, noise;
  for (int set = 0; set < 100; ++set) {
    const auto low_record = bodeflow::test::motor_record(low, random), high_record = bodeflow::test::motor_record(high, random);
    const PowerSpectra low_spectra = spectra_of(low_record, low), high_spectra = spectra_of(high_record, high);
    for (const bool corrected : {false, true}) {
      const Eigen::VectorXcd g =
          bodeflow::test::stacked(frisch_response(low_spectra, corrected), frisch_response(high_spectra, corrected));
      const auto fit = fit_motor(omega, g, ones);
      REQUIRE(fit);
      REQUIRE(fit->converged);
      (corrected ? with : without).add(fit->model.vector());
    }
    const MeanSpectra a = bodeflow::test::means(low_record, low), b = bodeflow::test::means(high_record, high);
    noise.add(8.0 * Eigen::Array4d(a.input_variance[0], a.output_variance[0], b.input_variance[0], b.output_variance[0]));
    const auto fit = fit_motor_likelihood(joined(a, b));
    REQUIRE(fit);
    REQUIRE(fit->converged);
    likelihood.add(fit->model.vector());
  }
  CAPTURE(without.mean().transpose(), with.mean().transpose(), likelihood.mean().transpose(), without.std().transpose(),
          with.std().transpose(), likelihood.std().transpose(), noise.mean().sqrt().transpose());
  CHECK(without.mean()[3] > 0.0335);
  CHECK(without.mean()[3] < 0.0357);
  CHECK(with.mean()[3] > 0.036);
  CHECK(with.mean()[3] < 0.040);
  CHECK(std::abs(with.mean()[3] - truth[3]) < std::abs(without.mean()[3] - truth[3]));
  CHECK(((likelihood.mean() - truth).abs() < 5.0 * likelihood.std() / 10.0).all());
  const Eigen::Array4d imposed(0.71, 0.22, 0.57, 0.117);
  CHECK((noise.mean().sqrt() / imposed - 1.0).abs().maxCoeff() < 0.02);
}

TEST_CASE("frisch: intervals of the maximum likelihood fit cover in .93 to .97 of 1000 sets") {
  const MotorBand low = bodeflow::test::low_band(1.0), high = bodeflow::test::high_band(0.85);
  const Eigen::Array4d truth = paper_motor().vector();
  Random random(8);
  Statistics estimates, bias, variances, cost, covered;
  for (int set = 0; set < 1000; ++set) {
    const auto low_record = bodeflow::test::motor_record(low, random), high_record = bodeflow::test::motor_record(high, random);
    const auto fit =
        fit_motor_likelihood(joined(bodeflow::test::means(low_record, low), bodeflow::test::means(high_record, high)));
    REQUIRE(fit);
    const Intervals in = intervals(*fit);
    Eigen::Array4d target = truth;
    target[2] += fit->bias[2];  // Lm_beta after its reported bias
    covered.add((target > in.lower.array() && target < in.upper.array()).cast<double>());
    estimates.add(fit->model.vector());
    bias.add(fit->bias);
    variances.add(fit->covariance.diagonal());
    cost.add(Eigen::ArrayXd::Constant(1, fit->cost));
  }
  const Eigen::ArrayXd found_bias = estimates.mean() - truth;
  CAPTURE(covered.mean().transpose(), estimates.std().transpose(), variances.mean().sqrt().transpose(), found_bias.transpose(),
          bias.mean().transpose(), cost.mean());
  CHECK((covered.mean() > 0.93).all());
  CHECK((covered.mean() < 0.97).all());
  CHECK(cost.mean()[0] == Approx(46.0).epsilon(0.05));
  // The reported bias is the one there is, to the precision of the mean of 1000 sets.
  CHECK(((found_bias - bias.mean()).abs() < 4.0 * estimates.std() / std::sqrt(1000.0)).all());
}
