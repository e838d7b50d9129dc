// The averaging DFT of two channels with power and covariance beside GNU Radio and a hand-written FFTW loop, interleaved in one
// run. Prints medians; the figures in tests/bench/README.md come from here.

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "../runtime/engine.hpp"
#include "../runtime/interleave.hpp"
#include "hand.hpp"
#include "radio.hpp"

namespace {

constexpr std::size_t kSize = 1024, kPeriods = 20'000;

std::string graph() {
  return fmt::format(
      "bodeflow: 1\nrun: {{duration: {} s}}\nblocks:\n"
      "  excitation: {{block: generators.multisine, sample_rate: 1 MHz, period: {}, lines: {{first: 1, last: {}}}}}\n"
      "  dft: {{block: spectrum.averaging_dft, period: {}, lines: {{first: 1, last: {}}}}}\n"
      "connections:\n  - excitation -> dft.input\n  - excitation -> dft.output\n",
      static_cast<double>(kSize * kPeriods) / 1e6, kSize, kSize / 2 - 1, kSize, kSize / 2 - 1);
}

std::vector<double> signal() {
  std::vector<double> x(kSize);
  for (std::size_t n = 0; n < kSize; ++n) x[n] = std::cos(0.7 * static_cast<double>(n * n % kSize));
  return x;
}

}  // namespace

int main(int count, char** arguments) {
  const int repeats = count > 1 ? std::atoi(arguments[1]) : 7;
  const std::vector<double> x = signal();
  const std::vector<float> single(x.begin(), x.end());
  auto engine = std::make_shared<bench::Engine>(graph(), bench::EngineOptions{1, 1024, false});
  std::vector<bench::Candidate> candidates;
  candidates.push_back({"bodeflow, spectrum.averaging_dft", [=] { engine->run(); }, {}, {}});
  candidates.push_back({"hand-written FFTW loop", [&] { bench::hand_sums(x, x, kPeriods); }, {}, {}});
  candidates.push_back({"GNU Radio (float)", [&] { bench::radio_sums(single, single, kPeriods); }, {}, {}});
  bench::interleave(candidates, kSize * kPeriods, repeats);
  bench::print("averaging DFT, 2 channels, 1024 points, power and covariance; per sample instant", candidates);
}
