#include "experiments.hpp"

#include <algorithm>
#include <cmath>

#include "crest_optimiser.hpp"
#include "orthogonal.hpp"

namespace bodeflow::generators {
namespace {

std::size_t signals(const Design& design) { return design.inputs * design.realisations; }

std::vector<double> phases_of(const Design& design, std::uint64_t seed, std::size_t index) {
  switch (design.phases) {
    case Phases::zero:
      return std::vector<double>(design.lines.size());
    case Phases::schroeder:
      return schroeder_phases(design.lines);
    case Phases::random:
      break;
    case Phases::optimised:
      if (signals(design) == 1) return schroeder_phases(design.lines);
  }
  return random_phases(design.lines.size(), numerics::Random::stream(seed, index));
}

std::vector<Line> lines_of(const Design& design, std::uint64_t seed, std::size_t index) {
  std::vector<Line> lines = design.lines;
  const auto take = [&lines](const std::vector<double>& phases) {
    for (std::size_t i = 0; i < lines.size(); ++i) lines[i].phase_rad = phases[i];
  };
  take(phases_of(design, seed, index));
  if (design.phases == Phases::optimised) take(optimise_phases(lines, kOptimiserPoints / signals(design)));
  return lines;
}

double peak_of(std::span<const double> x) {
  double peak = 0;
  for (const double value : x) peak = std::max(peak, std::abs(value));
  return peak;
}

}  // namespace

Experiments::Experiments(const Design& design, std::uint64_t seed)
    : period_(static_cast<std::size_t>(design.period)), inputs_(design.inputs), scales_(design.inputs, 1.0) {
  for (std::size_t index = 0; index < signals(design); ++index) {
    const auto z = synthesise_analytic(design.period, lines_of(design, seed, index));
    std::vector<double>& real = real_.emplace_back(z.size());
    std::transform(z.begin(), z.end(), real.begin(), [](std::complex<double> value) { return value.real(); });
    if (has_signs_only(inputs_)) continue;
    std::vector<double>& imaginary = imaginary_.emplace_back(z.size());
    std::transform(z.begin(), z.end(), imaginary.begin(), [](std::complex<double> value) { return value.imag(); });
  }
  scale(design);
}

void Experiments::copy(std::size_t realisation, std::size_t experiment, std::size_t channel, std::size_t at,
                       std::span<double> y) const {
  const std::complex<double> turn = orthogonal_entry(experiment, channel, inputs_);
  const std::size_t index = realisation * inputs_ + channel;
  const double* real = real_[index].data() + at;
  if (imaginary_.empty()) {
    for (std::size_t n = 0; n < y.size(); ++n) y[n] = turn.real() * real[n];
    return;
  }
  const double* imaginary = imaginary_[index].data() + at;
  for (std::size_t n = 0; n < y.size(); ++n) y[n] = turn.real() * real[n] - turn.imag() * imaginary[n];
}

double Experiments::values(const Design& design) {
  return static_cast<double>(signals(design)) * static_cast<double>(design.period) * (has_signs_only(design.inputs) ? 1 : 2);
}

bool Experiments::seeded(const Design& design) {
  return design.phases == Phases::random || (design.phases == Phases::optimised && signals(design) > 1);
}

std::vector<double> Experiments::period_of(std::size_t realisation, std::size_t experiment, std::size_t channel) const {
  std::vector<double> y(period_);
  copy(realisation, experiment, channel, 0, y);
  return y;
}

void Experiments::scale(const Design& design) {
  double power = 0;
  for (const Line& line : design.lines) power += 0.5 * line.amplitude * line.amplitude;
  // With signs alone all experiments of a realisation have the same peaks.
  const std::size_t experiments = imaginary_.empty() ? 1 : inputs_;
  for (std::size_t j = 0; j < inputs_; ++j) {
    double peak = 0;
    for (std::size_t m = 0; m < design.realisations; ++m) {
      for (std::size_t e = 0; e < experiments; ++e) {
        const std::vector<double> y = period_of(m, e, j);
        peak = std::max(peak, peak_of(y));
        crest_factor_ = std::max(crest_factor_, generators::crest_factor(y));
      }
    }
    if (!design.rms.empty()) scales_[j] = design.rms[j] / std::sqrt(power);
    if (!design.peak.empty()) scales_[j] = design.peak[j] / peak;
    if (scales_[j] == 1.0) continue;
    for (std::size_t m = 0; m < design.realisations; ++m) {
      for (auto* part : {&real_, &imaginary_}) {
        if (part->empty()) continue;
        for (double& value : (*part)[m * inputs_ + j]) value *= scales_[j];
      }
    }
  }
}

}  // namespace bodeflow::generators
