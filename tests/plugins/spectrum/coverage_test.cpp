#include <algorithm>
#include <bodeflow/numerics/confidence.hpp>
#include <iostream>
#include <limits>

#include "catch.hpp"
#include "periodic.hpp"
#include "spectrum/averaging_dft.hpp"
#include "spectrum/transient_removal.hpp"

using namespace bodeflow;
using namespace bodeflow::spectrum;
using namespace bodeflow::test;

namespace {

constexpr int kSamples = 512;
constexpr double kInputNoise = 0.15, kOutputNoise = 0.2;

struct Seen {
  double covered = 0.0;                 // share of the circles that hold the truth
  double radius_over_f = 0.0;           // median radius over the F radius of the true variance
  double radius_over_normal = 0.0;      // and over the normal one
  double variance_times_periods = 0.0;  // mean of variance / true variance of one period
};

/// 95 % circles of `seeds` measurements of 240 lines with white noise on both signals.
Seen circles(int periods, int seeds) {
  const auto lines = lines_of(3, 242);
  const auto G = resonance(90.0, 0.15);
  numerics::Random phases(7);
  const Eigen::VectorXd u = random_multisine(kSamples, lines, 0.1, phases), y = filtered(u, G);
  const LineChoice choice{lines, 0.0};
  const double degrees = periods - 1.0, infinite = std::numeric_limits<double>::infinity();
  std::vector<double> over_f, over_normal;
  Seen seen;
  for (int seed = 0; seed < seeds; ++seed) {
    numerics::Random random = numerics::Random::stream(2026, static_cast<std::uint64_t>(seed));
    AveragingDft average(kSamples, 1);
    for (int p = 0; p < periods; ++p) {
      average.add(u + noise(kSamples, kInputNoise, random), y + noise(kSamples, kOutputNoise, random));
    }
    const auto e = average.estimate(choice, Form::errors_in_variables);
    REQUIRE(e);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      const Complex truth = G(static_cast<int>(lines[i]));
      const double one_period =
          (kOutputNoise * kOutputNoise + std::norm(truth) * kInputNoise * kInputNoise) / kSamples / (0.05 * 0.05);
      const double radius = numerics::confidence_radius(e->variance(row, 0), e->degrees_of_freedom(row, 0), 0.95);
      seen.covered += std::abs(e->response(row, 0) - truth) <= radius ? 1.0 : 0.0;
      over_f.push_back(radius / numerics::confidence_radius(one_period / periods, degrees, 0.95));
      over_normal.push_back(radius / numerics::confidence_radius(one_period / periods, infinite, 0.95));
      seen.variance_times_periods += e->variance(row, 0) * periods / one_period;
    }
  }
  const auto count = static_cast<double>(over_f.size());
  const auto median = [](std::vector<double>& v) {
    std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2), v.end());
    return v[v.size() / 2];
  };
  seen.covered /= count;
  seen.variance_times_periods /= count;
  seen.radius_over_f = median(over_f);
  seen.radius_over_normal = median(over_normal);
  return seen;
}

}  // namespace

TEST_CASE("averaged DFT: 95 % circles of 200 seeds and 240 lines cover the truth in 94 to 96 % at 4, 6 and 12 periods") {
  double one_period = 0.0;
  for (const int periods : {4, 6, 12}) {
    const Seen seen = circles(periods, 200);
    std::cout << "P = " << periods << ": coverage " << 100.0 * seen.covered
              << " %, median radius over that of the true variance: F " << seen.radius_over_f << ", normal "
              << seen.radius_over_normal << "; P x variance over the true one " << seen.variance_times_periods << "\n";
    CHECK(seen.covered == Approx(0.95).margin(0.01));
    CHECK(seen.variance_times_periods == Approx(1.0).margin(0.02));  // falls as 1/P
    if (one_period == 0.0) one_period = seen.variance_times_periods;
    CHECK(seen.variance_times_periods == Approx(one_period).epsilon(0.02));
    if (periods != 12) continue;
    // The median of s / sigma with 22 real degrees of freedom is sqrt(21.337 / 22) = 0.985.
    CHECK(seen.radius_over_f == Approx(0.985).margin(0.005));
    CHECK(seen.radius_over_f == Approx(1.0).margin(0.05));
    CHECK(seen.radius_over_normal == Approx(1.056).margin(0.006));
  }
}

TEST_CASE("averaged DFT: circles of two experiments for two inputs cover the truth with the degrees of freedom of both") {
  const auto lines = lines_of(3, 62);
  const int N = 128, P = 3;
  const auto G1 = resonance(20.0, 0.2), G2 = resonance(40.0, 0.3);
  int inside = 0, all = 0;
  for (int seed = 0; seed < 100; ++seed) {
    numerics::Random random = numerics::Random::stream(11, static_cast<std::uint64_t>(seed));
    const Eigen::VectorXd a = random_multisine(N, lines, 0.3, random);
    Measured measured{{2, 1, 0}, N, 2, {}};
    for (const double sign : {1.0, -1.0}) {
      const Eigen::VectorXd b = sign * a, y = filtered(a, G1) + filtered(b, G2);
      AveragingDft average(N, Layout{2, 1, 0});
      for (int p = 0; p < P; ++p) {
        Eigen::MatrixXd frame(N, 3);
        frame << a + noise(N, 0.1, random), b + noise(N, 0.1, random), y + noise(N, 0.2, random);
        average.add(frame);
      }
      measured.parts.push_back(*average.moments());
    }
    const auto e = estimate_response(measured, {lines, 0.0}, Form::errors_in_variables);
    REQUIRE(e);
    CHECK(e->degrees_of_freedom.minCoeff() == Approx(2.0 * (P - 1)).epsilon(0.2));
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      for (Eigen::Index j = 0; j < 2; ++j) {
        const Complex truth = (j == 0 ? G1 : G2)(static_cast<int>(lines[i]));
        const double radius = numerics::confidence_radius(e->variance(row, j), e->degrees_of_freedom(row, j), 0.95);
        inside += std::abs(e->response(row, j) - truth) <= radius ? 1 : 0;
        ++all;
      }
    }
  }
  CHECK(inside / double(all) == Approx(0.95).margin(0.01));
}

TEST_CASE("transient removal: circles at all lines, those at both ends of the band too, cover the truth at 2 and 4 periods") {
  const auto lines = lines_of(1, 30);
  const int N = 64;
  const double pole = 0.95;
  const auto G = [&](int k) { return 0.05 / (1.0 - pole * std::polar(1.0, -2.0 * M_PI * k / N)); };
  for (const int periods : {2, 4}) {
    int inside = 0, at_ends = 0;
    const int seeds = 300;
    for (int seed = 0; seed < seeds; ++seed) {
      numerics::Random random = numerics::Random::stream(12, static_cast<std::uint64_t>(seed));
      const Eigen::VectorXd u = random_multisine(N, lines, 1.0, random), steady = filtered(u, G);
      TransientRemoval removal(N, Layout{1, 1, 0});
      double transient = -steady[N - 1];  // from rest
      for (int p = 0; p < periods; ++p) {
        Eigen::MatrixXd frame(N, 2);
        frame << u, steady + noise(N, 0.3, random);
        for (int n = 0; n < N; ++n) frame(n, 1) += transient *= pole;
        removal.add(frame);
      }
      const auto e = estimate_response({{1, 1, 0}, N, 1, {*removal.moments()}}, {lines, 0.0}, Form::known_input);
      REQUIRE(e);
      for (Eigen::Index i = 0; i < 30; ++i) {
        const double radius = numerics::confidence_radius(e->variance(i, 0), e->degrees_of_freedom(i, 0), 0.95);
        const bool holds = std::abs(e->response(i, 0) - G(static_cast<int>(i) + 1)) <= radius;
        inside += holds ? 1 : 0;
        at_ends += holds && (i < 3 || i > 26) ? 1 : 0;
      }
    }
    std::cout << "transient removed, P = " << periods << ": coverage " << inside / (0.3 * seeds)
              << " %, at the three lines of each end " << at_ends / (0.06 * seeds) << " %\n";
    CHECK(inside / (30.0 * seeds) == Approx(0.95).margin(0.01));
    CHECK(at_ends / (6.0 * seeds) == Approx(0.95).margin(0.025));
  }
}
