#include "response/response_measurement.hpp"

#include <Eigen/Dense>
#include <bodeflow/numerics/random.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "../declared_base.hpp"
#include "bases/impedance.hpp"
#include "catch.hpp"
#include "effects/semi_inductance.hpp"
#include "linear_effects.hpp"
#include "model/simulate.hpp"
#include "response/hold_out_bands.hpp"
#include "response/line_statistics.hpp"

using namespace bodeflow;
using namespace bodeflow::residual;
using records::ResponseData;

namespace {

using Complex = std::complex<double>;

constexpr double kTwoPi = 2.0 * std::numbers::pi;

/// A winding of 2 ohm and 3 mH at lines from 10 Hz to 1 kHz.
const Eigen::Vector2d kWinding(2.0, 3e-3);

std::shared_ptr<const Impedance> winding() { return declared_base<Impedance>({{"motion", std::string("none")}}); }

ResponseData winding_response(int lines = 40) {
  ResponseData r;
  r.input_names = {"current"};
  r.output_names = {"voltage"};
  r.response_units = {"ohm"};
  r.frequency_hz.resize(lines);
  r.response.resize(lines, 1);
  for (int k = 0; k < lines; ++k) {
    r.frequency_hz[k] = 10.0 * std::pow(100.0, k / (lines - 1.0));
    r.response(k, 0) = {kWinding[0], kTwoPi * r.frequency_hz[k] * kWinding[1]};
  }
  return r;
}

/// The same with circular normal noise of that deviation, whose variance is stated exactly, or estimated with nu degrees.
ResponseData noisy(ResponseData r, std::uint64_t seed, double nu = std::numeric_limits<double>::infinity()) {
  numerics::Random random(seed);
  r.variance.resize(r.response.rows(), 1);
  for (Eigen::Index k = 0; k < r.response.rows(); ++k) {
    const double deviation = 0.01 * (1.0 + 0.02 * static_cast<double>(k));
    r.response(k, 0) += deviation / std::sqrt(2.0) * Complex(random.normal(), random.normal());
    double square = 2.0 * nu;
    if (std::isfinite(nu)) {
      square = 0.0;
      for (int i = 0; i < static_cast<int>(2.0 * nu); ++i) {
        const double normal = random.normal();
        square += normal * normal;
      }
    }
    r.variance(k, 0) = deviation * deviation * (std::isfinite(nu) ? square / (2.0 * nu) : 1.0);
  }
  if (std::isfinite(nu)) r.degrees_of_freedom = nu;
  return r;
}

std::shared_ptr<const Measurement> measured(const ResponseData& r) {
  const auto m = response_measurement(r, "fit 1", {}, *winding());
  INFO((m ? "" : m.error().text));
  REQUIRE(m);
  return *m;
}

JointModel model_of(std::shared_ptr<const BaseModel> base) {
  JointModel m;
  m.base = std::move(base);
  return m;
}

Eigen::MatrixXd jacobian(const Measurement& m, const JointModel& model, const Eigen::VectorXd& at) {
  Eigen::MatrixXd j(m.rows(), at.size());
  for (Eigen::Index i = 0; i < at.size(); ++i) {
    Eigen::VectorXd moved = at;
    moved[i] *= 1.0 + 1e-6;
    j.col(i) = (m.residual(model, moved) - m.residual(model, at)) / (1e-6 * at[i]);
  }
  return j;
}

std::string refusal(const ResponseData& r, const BaseModel& base, const std::vector<double>& known = {}) {
  const auto m = response_measurement(r, "fit 1", known, base);
  return m ? "taken" : m.error().text;
}

}  // namespace

TEST_CASE("measured response: the model that made it leaves nothing, and the error of another is relative to the magnitude") {
  const auto m = measured(winding_response());
  const JointModel model = model_of(winding());
  CHECK(m->residual(model, kWinding).norm() < 1e-10);
  CHECK_FALSE(m->floor_known());
  CHECK(m->rows() == 80);
  // A tenth more of everything is an error of a tenth at each line.
  const HeldOutError error = m->error(m->residual(model, 1.1 * kWinding));
  CHECK(error.error == Approx(10.0));  // %
  CHECK(m->facts().unit_of_error() == "%");
  CHECK_FALSE(error.floor_known());
  CHECK(m->picture(m->residual(model, 1.1 * kWinding)).residual[7] == Approx(0.1 * std::abs(winding_response().response(7, 0))));
}

TEST_CASE("measured response: an effect counts, and the impedance of the base is what a base's own start says") {
  const auto m = measured(winding_response());
  JointModel model = model_of(winding());
  Addition more;
  const testing::Linear semi = testing::linear<SemiInductance>();
  more.what = semi.what;
  more.effect = semi.effect;
  more.place = 0;
  more.parameters = semi.effect->parameters({});
  model.additions = {more};
  const Eigen::Vector4d values(kWinding[0], kWinding[1], 1.0, 0.5);
  const Eigen::VectorXd r = m->residual(model, values);
  const ResponseData data = winding_response();
  const Complex expected = -std::sqrt(Complex(0.0, data.frequency_hz[3] / 1000.0)) / std::abs(data.response(3, 0)) / 1e-3;
  CHECK(std::abs(Complex(r[6], r[7]) - expected) < 1e-9 * std::abs(expected));
  CHECK_FALSE(m->residual(model, Eigen::Vector4d(-1.0, 1e-3, 1.0, 0.5)).allFinite());
  const auto starts = winding()->starts(m->response());
  CHECK(starts.front()[0] == Approx(2.0).epsilon(0.05));
  CHECK(starts.front()[1] == Approx(3e-3).epsilon(0.05));
}

TEST_CASE("measured response: chi2 is chi-squared where the variance is stated, and the tests are uniform") {
  const JointModel model = model_of(winding());
  double sum = 0.0;
  int low = 0, low_held_out = 0, low_white = 0;
  constexpr int kRuns = 400;
  for (int run = 0; run < kRuns; ++run) {
    const auto m = measured(noisy(winding_response(), 1000u + static_cast<unsigned>(run)));
    const Eigen::VectorXd r = m->residual(model, kWinding);
    sum += r.squaredNorm();
    const Eigen::MatrixXd none = Eigen::MatrixXd::Zero(r.size(), 1), no = Eigen::MatrixXd::Zero(1, 1);
    const auto tests = m->tests(r, none, no, true);
    REQUIRE(tests.size() == 2);
    low += tests[0].p < 0.1;
    low_white += tests[1].p < 0.1;
    low_held_out += m->tests(r, none, no, false)[0].p < 0.1;
  }
  const double expected = 80.0 * kRuns;
  CHECK(sum == Approx(expected).margin(4.0 * std::sqrt(2.0 * expected)));
  for (const int count : {low, low_held_out, low_white})
    CHECK(count == Approx(0.1 * kRuns).margin(4.0 * std::sqrt(0.09 * kRuns)));
}

TEST_CASE("measured response: the test holds its level where the variance has few degrees of freedom") {
  const JointModel model = model_of(winding());
  for (const double nu : {1.0, 3.0, 11.0}) {
    int low = 0;
    constexpr int kRuns = 300;
    for (int run = 0; run < kRuns; ++run) {
      const auto m = measured(noisy(winding_response(), 5000u + static_cast<unsigned>(run), nu));
      const Eigen::VectorXd r = m->residual(model, kWinding);
      low += m->tests(r, Eigen::MatrixXd::Zero(r.size(), 1), Eigen::MatrixXd::Zero(1, 1), true)[0].p < 0.1;
    }
    INFO("nu " << nu);
    CHECK(low == Approx(0.1 * kRuns).margin(4.0 * std::sqrt(0.09 * kRuns)));
  }
}

TEST_CASE("measured response: uncertain parameters do not make a held-out record look wrong") {
  const JointModel model = model_of(winding());
  int low = 0;
  constexpr int kRuns = 300;
  for (int run = 0; run < kRuns; ++run) {
    // Parameters as a fit to another record of the same kind would give them.
    const auto other = measured(noisy(winding_response(), 20000u + static_cast<unsigned>(run)));
    const Eigen::MatrixXd j_other = jacobian(*other, model, kWinding);
    const Eigen::MatrixXd covariance = (j_other.transpose() * j_other).inverse();
    const Eigen::VectorXd found = kWinding - covariance * j_other.transpose() * other->residual(model, kWinding);
    const auto m = measured(noisy(winding_response(), 40000u + static_cast<unsigned>(run)));
    low += m->tests(m->residual(model, found), jacobian(*m, model, found), covariance, false)[0].p < 0.05;
  }
  CHECK(low == Approx(0.05 * kRuns).margin(4.0 * std::sqrt(0.0475 * kRuns)));
}

TEST_CASE("measured response: floor, highest and lowest error hold the noise") {
  const JointModel model = model_of(winding());
  double squares = 0.0, floor = 0.0;
  for (unsigned run = 0; run < 200; ++run) {
    const auto m = measured(noisy(winding_response(), 700u + run));
    const HeldOutError e = m->error(m->residual(model, kWinding));
    squares += e.error * e.error;
    floor = e.floor;
    CHECK(e.at_floor());
    CHECK_FALSE(e.leak());
  }
  CHECK(std::sqrt(squares / 200.0) == Approx(floor).epsilon(0.02));
  const auto m = measured(noisy(winding_response(), 1));
  CHECK_FALSE(m->error(m->residual(model, 1.05 * kWinding)).at_floor());
  CHECK(m->error(0.1 * m->residual(model, kWinding)).leak());
}

TEST_CASE("measured response: a gain counts lines that err alike as one") {
  constexpr Eigen::Index kLines = 400;
  numerics::Random random(3);
  Eigen::VectorXd white(2 * kLines), smooth(2 * kLines);
  for (Eigen::Index k = 0; k < kLines; ++k) {
    white.segment<2>(2 * k) << random.normal(), random.normal();
    const double turn = kTwoPi * static_cast<double>(k) / 100.0;
    smooth.segment<2>(2 * k) << std::sin(turn), std::cos(turn);
  }
  CHECK(likeness_length(white, 1) < 2.0);
  CHECK(likeness_length(smooth, 1) > 20.0);
  CHECK(likeness_tail(smooth, 1) < 1e-10);
  CHECK(likeness_tail(white, 1) > 0.01);
  CHECK(block_deviate(smooth, 0.5 * smooth, 1) > 5.0);
  CHECK(block_deviate(smooth, smooth, 1) == 0.0);
  // A fall in one place alone is no fall by blocks.
  Eigen::VectorXd once = smooth;
  once.segment(100, 10).setZero();
  CHECK(block_deviate(smooth, once, 1) < 1.5);
}

TEST_CASE("measured response: gains of known and of unknown floor") {
  const JointModel model = model_of(winding());
  const auto known = measured(noisy(winding_response(), 9));
  const Eigen::VectorXd before = known->residual(model, 1.1 * kWinding), after = known->residual(model, kWinding);
  const Gain g = known->gain(before, after);
  CHECK(g.likelihood == Approx(before.squaredNorm() - after.squaredNorm()));
  CHECK(std::isinf(g.block_z));
  ResponseData shared = noisy(winding_response(), 9);
  shared.correlated_lines = 2;
  CHECK(measured(shared)->gain(before, after).likelihood == Approx(g.likelihood / 5.0));
  const auto unknown = measured(winding_response());
  const Gain same = unknown->gain(before, before);
  CHECK(same.likelihood == Approx(0.0).margin(1e-12));
  CHECK(unknown->gain(before, 0.5 * before).likelihood > 0.0);
}

TEST_CASE("measured response: units are converted, and what is no impedance is refused by name") {
  const auto base = winding();
  ResponseData milli = winding_response();
  milli.response *= 1000.0;
  milli.response_units = {"mohm"};
  CHECK(measured(milli)->residual(model_of(base), kWinding).norm() < 1e-9);
  ResponseData r = winding_response();
  r.response_units = {"S"};
  CHECK(refusal(r, *base) == "it is in S, the base model needs ohm: check what is declared, and which way round it is");
  r.response_units = {""};
  CHECK(refusal(r, *base) == "it states no unit; the base model needs ohm");
  r.response_units = {"dB"};
  CHECK(refusal(r, *base) == "it is in dB; needed: the complex response in the unit of output over input");
  r.response_units = {"deg"};
  r.response = r.response.real().cast<Complex>().eval();
  CHECK(refusal(r, *base) == "it is real and in deg, a phase alone; needed: the complex response");
}

TEST_CASE("measured response: lines and values that can't be used are refused by name") {
  const auto base = winding();
  ResponseData r = winding_response();
  r.response(4, 0) = 0.0;
  CHECK(refusal(r, *base).find("its response is 0 at ") == 0);
  r = winding_response();
  r.response(4, 0) = std::numeric_limits<double>::quiet_NaN();
  CHECK(refusal(r, *base).find("its response is not finite at ") == 0);
  r = noisy(winding_response(), 1);
  r.variance(2, 0) = 0.0;
  CHECK(refusal(r, *base).find("its variance is 0 at ") == 0);
  r = winding_response();
  r.frequency_hz[5] = r.frequency_hz[4];
  CHECK(refusal(r, *base).find("a line is there twice: ") == 0);
  r.frequency_hz[5] = 1.0;
  CHECK(refusal(r, *base).find("its lines are not in order: 1 Hz after ") == 0);
  r = winding_response(2);
  r.frequency_hz[0] = 0.0;
  CHECK(refusal(r, *base) == "it has 1 line above 0 Hz, too few for 2 parameters");
  r = winding_response();
  r.output_names.push_back("second");
  CHECK(refusal(r, *base) == "it has 2 outputs; needed: one, the one that the model describes");
  r = winding_response();
  r.input_names.push_back("second");
  CHECK(refusal(r, *base) == "it has 2 inputs, the base model 1 input");
  CHECK(refusal(winding_response(), *base, {0.01}) == "1 known values, the base model has 0");
  const auto held = declared_base<Impedance>({{"motion", std::string("none")}, {"hold", std::string("zero_order")}});
  CHECK(refusal(winding_response(), *held).find("it states no sample rate") == 0);
}

TEST_CASE("held-out bands: whole bands, every third, no line lost") {
  const ResponseData r = noisy(winding_response(200), 2);
  const auto parts = hold_out_bands(r, 1.0 / 3.0, 3);
  REQUIRE(parts);
  CHECK(parts->kept.frequency_hz.size() + parts->held_out.frequency_hz.size() == 200);
  CHECK(parts->held_out.variance.rows() == parts->held_out.frequency_hz.size());
  for (const double f : parts->held_out.frequency_hz) CHECK(static_cast<int>(std::floor(3.0 * std::log2(f / 10.0))) % 3 == 1);
  CHECK_FALSE(hold_out_bands(r, 1.0 / 3.0, 1));
  CHECK_FALSE(hold_out_bands(r, 0.0, 3));
  CHECK(hold_out_bands(r, 10.0, 3).error().text ==
        "its 200 lines are too near to each other for bands of 10 octaves of which every 3th is held out");
}
