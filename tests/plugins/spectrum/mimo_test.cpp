#include "catch.hpp"
#include "periodic.hpp"
#include "spectrum/averaging_dft.hpp"

using namespace bodeflow;
using namespace bodeflow::spectrum;
using namespace bodeflow::test;

namespace {

constexpr int kSamples = 64;
const std::vector<std::int64_t> kLines = lines_of(2, 30, 2);

/// Two outputs, three inputs.
Complex truth(int k, Eigen::Index i, Eigen::Index j) {
  return resonance(10.0 + 5.0 * double(i) + 3.0 * double(j), 0.1)(k) * (1.0 + double(j) - 0.5 * double(i));
}

Eigen::MatrixXd outputs(const Eigen::MatrixXd& u) {
  Eigen::MatrixXd y = Eigen::MatrixXd::Zero(kSamples, 2);
  for (Eigen::Index i = 0; i < 2; ++i) {
    for (Eigen::Index j = 0; j < u.cols(); ++j) y.col(i) += filtered(u.col(j), [=](int k) { return truth(k, i, j); });
  }
  return y;
}

Moments experiment(const Eigen::MatrixXd& u, double input_noise, double output_noise, int periods, numerics::Random& random) {
  const Eigen::MatrixXd y = outputs(u);
  AveragingDft average(kSamples, Layout{u.cols(), 2, 0});
  for (int p = 0; p < periods; ++p) {
    Eigen::MatrixXd frame(kSamples, u.cols() + 2);
    frame << u, y;
    for (Eigen::Index c = 0; c < frame.cols(); ++c) {
      frame.col(c) += noise(kSamples, c < u.cols() ? input_noise : output_noise, random);
    }
    average.add(frame);
  }
  return *average.moments();
}

double worst(const Estimate& e) {
  double largest = 0.0;
  for (std::size_t r = 0; r < e.lines.size(); ++r) {
    for (Eigen::Index i = 0; i < 2; ++i) {
      for (Eigen::Index j = 0; j < 3; ++j) {
        largest = std::max(
            largest, std::abs(e.response(static_cast<Eigen::Index>(r), 3 * i + j) - truth(static_cast<int>(e.lines[r]), i, j)));
      }
    }
  }
  return largest;
}

enum class Kind { independent, one_at_a_time };

Eigen::MatrixXd excitation(Kind kind, Eigen::Index e, numerics::Random& random) {
  Eigen::MatrixXd u = Eigen::MatrixXd::Zero(kSamples, 3);
  for (Eigen::Index j = 0; j < 3; ++j) {
    if (kind == Kind::independent || j == e) u.col(j) = random_multisine(kSamples, kLines, 1.0, random);
  }
  return u;
}

}  // namespace

TEST_CASE(
    "several inputs: exact on noise-free data, for independent excitations, one at a time, and more experiments than inputs") {
  numerics::Random random(4);
  for (const Kind kind : {Kind::independent, Kind::one_at_a_time}) {
    for (const Eigen::Index experiments : {3, 6}) {
      Measured m{{3, 2, 0}, kSamples, experiments, {}};
      for (Eigen::Index e = 0; e < experiments; ++e)
        m.parts.push_back(experiment(excitation(kind, e % 3, random), 0.0, 0.0, 2, random));
      const auto e = estimate_response(m, {kLines, 0.0}, Form::errors_in_variables);
      REQUIRE(e);
      CHECK(worst(*e) < 1e-12);
      CHECK(e->variance.maxCoeff() < 1e-24);
      // Equal rows in all experiments would count them all; one at a time only those that drive the input.
      if (kind == Kind::one_at_a_time) CHECK(e->degrees_of_freedom.maxCoeff() == Approx(double(experiments) / 3.0));
      CHECK(e->degrees_of_freedom.minCoeff() >= 1.0 - 1e-12);
      CHECK(e->degrees_of_freedom.maxCoeff() <= double(experiments) + 1e-12);
    }
  }
}

TEST_CASE("several inputs: the predicted variance matches Monte Carlo within 10 %") {
  const int runs = 600;
  numerics::Random fixed(1);
  std::vector<Eigen::MatrixXd> u;
  for (Eigen::Index e = 0; e < 3; ++e) u.push_back(excitation(Kind::independent, e, fixed));
  Eigen::MatrixXd actual = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(kLines.size()), 6), predicted = actual;
  numerics::Random random(2);
  for (int run = 0; run < runs; ++run) {
    Measured m{{3, 2, 0}, kSamples, 3, {}};
    for (Eigen::Index e = 0; e < 3; ++e) m.parts.push_back(experiment(u[static_cast<std::size_t>(e)], 0.03, 0.1, 4, random));
    const auto e = estimate_response(m, {kLines, 0.0}, Form::errors_in_variables);
    REQUIRE(e);
    predicted += e->variance / runs;
    for (Eigen::Index r = 0; r < actual.rows(); ++r) {
      for (Eigen::Index c = 0; c < 6; ++c)
        actual(r, c) +=
            std::norm(e->response(r, c) - truth(static_cast<int>(kLines[static_cast<std::size_t>(r)]), c / 3, c % 3)) / runs;
    }
  }
  // Each has a relative deviation of 1 / sqrt(600) = 4 %; the mean over 90 of them far less.
  CHECK(predicted.cwiseQuotient(actual).mean() == Approx(1.0).margin(0.03));
  for (Eigen::Index c = 0; c < 6; ++c) CHECK(predicted.col(c).sum() == Approx(actual.col(c).sum()).epsilon(0.1));
}

TEST_CASE("several inputs: experiments that do not tell the inputs apart are refused, units apart") {
  numerics::Random random(3);
  Measured m{{3, 2, 0}, kSamples, 3, {}};
  const Eigen::MatrixXd same = excitation(Kind::independent, 0, random);
  for (int e = 0; e < 3; ++e) m.parts.push_back(experiment(same, 0.0, 0.0, 2, random));
  const auto refused = estimate_response(m, {kLines, 0.0}, Form::errors_in_variables);
  REQUIRE_FALSE(refused);
  CHECK(
      refused.error().text ==
      "line 2: the experiments do not drive the inputs independently of each other; needed: as many experiments as inputs, with "
      "orthogonal or different excitations");
  Measured silent{{3, 2, 0}, kSamples, 3, {}};
  for (Eigen::Index e = 0; e < 3; ++e) {
    Eigen::MatrixXd u = excitation(Kind::independent, e, random);
    u.col(1).setZero();
    silent.parts.push_back(experiment(u, 0.0, 0.0, 2, random));
  }
  CHECK(estimate_response(silent, {kLines, 0.0}, Form::errors_in_variables).error().text ==
        "line 2: input 2 is zero in all experiments");
  // An input in nanometres beside one in volts is no bad condition.
  Measured scaled{{3, 2, 0}, kSamples, 3, {}};
  for (Eigen::Index e = 0; e < 3; ++e) {
    Eigen::MatrixXd u = excitation(Kind::one_at_a_time, e, random);
    u.col(2) *= 1e-9;
    scaled.parts.push_back(experiment(u, 0.0, 0.0, 2, random));
  }
  const auto fine = estimate_response(scaled, {kLines, 0.0}, Form::errors_in_variables);
  REQUIRE(fine);
  CHECK(fine->condition.maxCoeff() < 1.001);
}
