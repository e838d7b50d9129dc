#include "effects/interharmonic.hpp"

#include <limits>

#include "effects/mains.hpp"
#include "effects/words.hpp"

namespace bodeflow::residual {

void Interharmonic::describe(DescribeEffect& effect) {
  effect.id("residual.interharmonic")
      .summary("A tone in the output that neither the input nor the mains make")
      .doc(
          "Amplitude and phase are free in every record, the frequency is one. Sought where tones stand out between the lines; "
          "near 50 and 60 Hz a tone is called hum.")
      .acts(Acts::tone);
}

std::vector<FitParameter> Interharmonic::parameters(const Situation& s) const {
  return {real("tone_frequency", "Hz", 0.1 / size_or_one(s.duration_s))
              .between(0.0, std::numeric_limits<double>::infinity())
              .says("of the tone")};
}

std::vector<std::vector<double>> Interharmonic::starts(const Situation& s) const {
  std::vector<std::vector<double>> starts;
  for (const double f : s.peaks_hz) {
    if (starts.size() < 3 && f > 0.0 && mains_of(f) <= 0.0) starts.push_back({f});
  }
  return starts.empty() ? std::vector<std::vector<double>>{{1.0 / size_or_one(s.duration_s)}} : starts;
}

std::string Interharmonic::sentence(std::span<const double> value, std::span<const double> std, const Situation&) const {
  return "tone of " + quantity(value[0], std[0], "Hz") + " that the input does not make";
}

std::string Interharmonic::refuses(const Situation& s) const {
  for (const double f : s.peaks_hz) {
    if (f > 0.0 && mains_of(f) <= 0.0) return {};
  }
  return "no tone between the lines beside those of the mains";
}

std::vector<double> Interharmonic::tones_hz(const double* p) const { return {p[0]}; }

}  // namespace bodeflow::residual
