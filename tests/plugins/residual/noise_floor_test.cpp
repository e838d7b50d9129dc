#include "noise_floor.hpp"

#include <bodeflow/numerics/random.hpp>
#include <cmath>

#include "catch.hpp"

using namespace bodeflow::residual;
using bodeflow::numerics::Random;

namespace {

/// Powers of `bins` bins of circular noise whose level is `level(f)`.
template <class Level>
std::pair<Eigen::VectorXd, Eigen::VectorXd> bins_of(Eigen::Index bins, std::uint64_t seed, Level level) {
  Random random(seed);
  Eigen::VectorXd frequency = Eigen::VectorXd::LinSpaced(bins, 0.1, 250), power(bins);
  for (Eigen::Index l = 0; l < bins; ++l) power[l] = -std::log(random.uniform()) * level(frequency[l]);
  return {frequency, power};
}

double white(double) { return 2e-6; }

}  // namespace

TEST_CASE("noise floor: its spread over realisations is the predicted one, and it is not biased") {
  const int runs = 200;
  double sum = 0, square = 0, predicted = 0;
  for (int n = 0; n < runs; ++n) {
    const auto [frequency, power] = bins_of(3000, 100 + n, white);
    const NoiseFloor floor = NoiseFloor::from_bins(frequency, power).value();
    const double relative = floor.at(frequency).mean() / 2e-6 - 1;
    sum += relative;
    square += relative * relative;
    predicted = floor.relative_variance(frequency);
  }
  CHECK(std::abs(sum / runs) < 4 * std::sqrt(predicted / runs) + 1e-3);
  CHECK(square / runs == Approx(predicted).epsilon(0.35));
}

TEST_CASE("noise floor: strong tones and skirts hardly move it") {
  auto [frequency, power] = bins_of(3000, 7, white);
  for (Eigen::Index l = 0; l < power.size(); l += 40) power[l] += 1e-2;
  const NoiseFloor floor = NoiseFloor::from_bins(frequency, power).value();
  CHECK(floor.at(frequency).mean() == Approx(2e-6).epsilon(0.12));
}

TEST_CASE("noise floor: follows noise that falls with frequency") {
  const auto falling = [](double f) { return 1e-6 * std::exp(-f / 100); };
  const auto [frequency, power] = bins_of(20000, 3, falling);
  const NoiseFloor floor = NoiseFloor::from_bins(frequency, power).value();
  for (const double f : {5.0, 100.0, 240.0}) CHECK(floor.at(f) == Approx(falling(f)).epsilon(0.06));
}

TEST_CASE("noise floor: refuses too few bins, and data without noise") {
  CHECK(NoiseFloor::from_bins(Eigen::VectorXd::LinSpaced(40, 1, 40), Eigen::VectorXd::Ones(40)).error().text ==
        "the noise floor needs at least 60 bins between the lines, found 40; record more periods");
  CHECK(NoiseFloor::from_bins(Eigen::VectorXd::LinSpaced(100, 1, 100), Eigen::VectorXd::Zero(100)).error().text ==
        "most of the bins between the lines are 0: there is no noise, and so no noise floor");
}
