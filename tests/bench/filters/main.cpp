// A filter of 64 taps and a bank of 16 biquads beside GNU Radio and hand-written loops, interleaved in one run. Prints medians;
// the figures in tests/bench/README.md come from here.

#include <fmt/format.h>

#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "../runtime/engine.hpp"
#include "../runtime/interleave.hpp"
#include "hand.hpp"
#include "radio.hpp"

namespace {

std::string graph(const std::string& filter, std::size_t samples) {
  return fmt::format(
      "bodeflow: 1\nrun: {{duration: {} s}}\nblocks:\n  source: {{block: bench.source}}\n  filter: {}\n  sink: {{block: "
      "bench.sink}}\n"
      "connections:\n  - source -> filter -> sink\n",
      static_cast<double>(samples) / 1e6, filter);
}

std::string fir_block() {
  return fmt::format("{{block: filters.fir, method: given, coefficients: [{}]}}", fmt::join(bench::fir_coefficients(), ", "));
}

std::string bank_block() {
  std::string rows;
  for (const auto& c : bench::biquad_coefficients())
    rows += fmt::format("{}[{}, {}, {}, 1, {}, {}]", rows.empty() ? "" : ", ", c[0], c[1], c[2], c[3], c[4]);
  return fmt::format("{{block: filters.biquads, arrangement: bank, coefficients: [{}]}}", rows);
}

bench::Candidate engine(const std::string& name, const std::string& text) {
  auto made = std::make_shared<bench::Engine>(text, bench::EngineOptions{1, 1024, false});
  return {name, [made] { made->run(); }, {}, {}};
}

}  // namespace

int main(int count, char** arguments) {
  const int repeats = count > 1 ? std::atoi(arguments[1]) : 7;
  constexpr std::size_t kFirSamples = 10'240'000, kBankSamples = 2'048'000;
  std::vector<bench::Candidate> fir, bank;
  fir.push_back(engine("bodeflow, filters.fir", graph(fir_block(), kFirSamples)));
  fir.push_back({"hand-written loop", [] { bench::hand_fir(kFirSamples); }, {}, {}});
  fir.push_back({"GNU Radio, fir_filter_fff (float)", [] { bench::radio_fir(kFirSamples); }, {}, {}});
  bench::interleave(fir, kFirSamples, repeats);
  bench::print("64 taps, one channel", fir);
  bank.push_back(engine("bodeflow, filters.biquads", graph(bank_block(), kBankSamples)));
  bank.push_back({"hand-written loop, a channel each", [] { bench::hand_biquads_channels(kBankSamples); }, {}, {}});
  bank.push_back({"hand-written loop, frames of 16", [] { bench::hand_biquads_frames(kBankSamples); }, {}, {}});
  bank.push_back({"GNU Radio, 16 iir_filter_ffd", [] { bench::radio_biquads(kBankSamples); }, {}, {}});
  bench::interleave(bank, kBankSamples, repeats);
  bench::print("16 biquads side by side, one input", bank);
}
