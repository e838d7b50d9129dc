#include "experiment.hpp"

#include <bodeflow/numerics/random.hpp>
#include <cmath>
#include <numbers>

#include "catch.hpp"
#include "simple_bench.hpp"

using namespace bodeflow;
using namespace bodeflow::residual;

namespace {

constexpr Eigen::Index kPeriod = 256;

/// A gain of 2 on lines 3 and 7 of a period, with noise at the output and, where asked for, at the input.
records::Recording gain_of_two(double input_noise, std::int64_t periods = 8) {
  numerics::Random random(5);
  records::Recording r;
  r.sample_rate_hz = 1000;
  r.period = kPeriod;
  r.skip = 1;
  r.periods = periods;
  r.input_signals = {{"u"}, {"V"}};
  r.output_signals = {{"y"}, {"A"}};
  const Eigen::Index samples = kPeriod * (periods + 1);
  r.input.resize(samples, 1);
  r.output.resize(samples, 1);
  for (Eigen::Index n = 0; n < samples; ++n) {
    const double t = 2 * std::numbers::pi * static_cast<double>(n) / static_cast<double>(kPeriod);
    const double u = std::cos(3 * t) + 0.5 * std::sin(7 * t) + 0.5 * std::cos(100 * t);
    r.input(n, 0) = u + input_noise * random.normal();
    r.output(n, 0) = 2 * u + 0.01 * random.normal();
  }
  return r;
}

std::string refusal(const records::Recording& r) { return experiment_of(r, "x").error().text; }

}  // namespace

TEST_CASE("experiment: mean lines, kinds and the noise on them") {
  const Experiment e = experiment_of(gain_of_two(0), "x").value();
  CHECK(e.lines() == 126);
  CHECK(std::abs(e.output[3] - 1.0) < 2e-3);
  CHECK(std::abs(e.output[7] - std::complex<double>(0, -0.5)) < 2e-3);
  CHECK(e.kind[0] == Kind::dc);
  CHECK(e.kind[3] == Kind::excited);
  CHECK(e.kind[5] == Kind::odd);
  CHECK(e.kind[8] == Kind::even);
  // White noise of 0.01 over 8 periods of 256 samples.
  CHECK(e.variance.mean() == Approx(1e-4 / (8 * 256)).epsilon(0.15));
  CHECK(e.input.isApprox(gain_of_two(0).input.col(0).head(kPeriod), 1e-12));
}

TEST_CASE("experiment: a measured input adds its noise to the excited lines and drives nothing else") {
  const Experiment e = experiment_of(gain_of_two(0.02), "x").value();
  CHECK(e.kind[3] == Kind::excited);
  CHECK(e.kind[4] == Kind::even);
  // 4 var(u) + var(y) over var(y) = 17.
  CHECK(e.variance[3] / e.variance[4] == Approx(17).epsilon(0.3));
  Eigen::VectorXd wanted(kPeriod);
  for (Eigen::Index n = 0; n < kPeriod; ++n) {
    const double t = 2 * std::numbers::pi * static_cast<double>(n) / static_cast<double>(kPeriod);
    wanted[n] = std::cos(3 * t) + 0.5 * std::sin(7 * t) + 0.5 * std::cos(100 * t);
  }
  CHECK((e.input - wanted).norm() < 0.1 * 0.02 * std::sqrt(double(kPeriod)));
}

TEST_CASE("experiment: refuses what has no periodic excitation, no noise, or too little of it") {
  auto r = gain_of_two(0);
  r.period = 0;
  CHECK(refusal(r) == "the recording states no period; the tracer needs a periodic excitation");
  CHECK(refusal(gain_of_two(0, 1)) ==
        "the recording has 1 period after the skipped ones, allowed: 2 or more, so that the noise shows between the lines");
  r = gain_of_two(0);
  r.output = 2 * r.input;
  CHECK(refusal(r) == "output 'y' holds no noise between the lines, so there is nothing to judge a residual by");
  r = gain_of_two(0);
  r.input.setZero();
  CHECK(refusal(r) == "the input excites no line");
  r = gain_of_two(0);
  r.input.conservativeResize(Eigen::NoChange, 2);
  r.input_signals.names.push_back("v");
  r.input_signals.units.push_back("V");
  CHECK(refusal(r) == "the tracer takes one input and one output, the recording has 2 inputs and 1 output");
  r = gain_of_two(0);
  r.excited_lines = {3, 120};
  CHECK(refusal(r) == "the last excited line is 120 of 128 below the Nyquist frequency; allowed: up to 0.8 of it, sample faster");
}
