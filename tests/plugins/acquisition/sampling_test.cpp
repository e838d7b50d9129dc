#include "acquisition/sampling.hpp"

#include <cmath>
#include <random>

#include "catch.hpp"

using namespace bodeflow;
using acquisition::Sampling;

namespace {

/// Times of `count` samples from 5 s on, with white jitter of up to `jitter`.
Sampling sampled(double interval, int count, double jitter, std::uint64_t seed, double* first_last = nullptr) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-jitter, jitter);
  Sampling s;
  double first = 0.0, last = 0.0;
  for (int n = 0; n < count; ++n) {
    const double t = 5.0 + interval * n + (jitter > 0.0 ? uniform(random) : 0.0);
    if (n == 0) first = t;
    last = t;
    const auto wrong = s.add(t);
    if (wrong) FAIL(*wrong);
  }
  if (first_last != nullptr) *first_last = (last - first) / (count - 1);
  return s;
}

}  // namespace

TEST_CASE("sampling: the interval of jittered times has the spread of a least-squares line") {
  constexpr double kInterval = 1.0 / 1003.0, kJitter = 0.04 * kInterval;
  constexpr int kCount = 1000, kRuns = 400;
  double square = 0.0, square_first_last = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    double first_last = 0.0;
    const Sampling s = sampled(kInterval, kCount, kJitter, 100 + static_cast<std::uint64_t>(run), &first_last);
    square += std::pow(s.interval_s() - kInterval, 2) / kRuns;
    square_first_last += std::pow(first_last - kInterval, 2) / kRuns;
  }
  const double expected = kJitter / std::sqrt(3.0) * std::sqrt(12.0 / std::pow(kCount, 3));
  CHECK(std::sqrt(square) == Approx(expected).epsilon(0.1));  // three standard deviations of 400 runs
  CHECK(std::sqrt(square_first_last) > 10.0 * expected);      // sqrt(kCount / 6) = 12.9 times
}

TEST_CASE("sampling: the rate of jittered times is rounded no further than they tell") {
  const Sampling round = sampled(1e-3, 20000, 4e-5, 1);
  CHECK(round.rate(0.0) == Rate(1000, 1));
  const Sampling odd = sampled(1.0 / 1003.0, 20000, 4e-5, 2);
  CHECK(odd.rate(0.0) == Rate(1003, 1));
  const Sampling few = sampled(1.0 / 1003.0, 30, 4e-5, 3);  // known to 0.5 Hz: no 1000 Hz
  CHECK(few.rate(0.0).hz() == Approx(1003.0).margin(2.0));
  CHECK(few.rate(0.0).hz() != Approx(1000.0).margin(0.5));
}

TEST_CASE("sampling: a long regular record gives its exact rate, wherever it begins") {
  for (const double rate : {2500.0, 44100.0, 48000.0, 1000.0 / 3.0, 51200.0}) {
    INFO(rate);
    CHECK(sampled(1.0 / rate, 200000, 0.0, 0).rate(0.0) == Rate::from_hz(rate));
  }
}
