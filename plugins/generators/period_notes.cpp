#include "period_notes.hpp"

#include <bodeflow/numerics/fft.hpp>

#include "multisine.hpp"

namespace bodeflow::generators {
namespace {

constexpr double kExcited = 1e-6;
constexpr std::size_t kMostLines = 100000;

}  // namespace

void note_period(StreamFacts& facts, std::span<const double> period) {
  const auto size = static_cast<double>(period.size());
  const double period_s = size / facts.rate.hz();
  facts.notes["excitation.period"] = {period_s};
  facts.notes["excitation.crest_factor"] = {crest_factor(period)};
  const Eigen::Map<const Eigen::VectorXd> samples(period.data(), static_cast<Eigen::Index>(period.size()));
  Eigen::VectorXd amplitudes = numerics::half_dft(samples).cwiseAbs() * (2 / size);
  amplitudes[0] = 0;
  if (period.size() % 2 == 0) amplitudes[amplitudes.size() - 1] *= 0.5;
  const double least = kExcited * amplitudes.maxCoeff();
  std::vector<double> frequencies, excited;
  for (Eigen::Index k = 1; k < amplitudes.size(); ++k) {
    if (!(amplitudes[k] > least)) continue;
    frequencies.push_back(static_cast<double>(k) / period_s);
    excited.push_back(amplitudes[k]);
  }
  if (frequencies.size() > kMostLines) return;
  facts.notes["excitation.frequencies"] = std::move(frequencies);
  facts.notes["excitation.amplitudes"] = std::move(excited);
}

}  // namespace bodeflow::generators
