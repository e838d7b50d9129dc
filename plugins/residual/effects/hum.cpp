#include "effects/hum.hpp"

#include "effects/mains.hpp"
#include "effects/words.hpp"

namespace bodeflow::residual {

void Hum::describe(DescribeEffect& effect) {
  effect.id("residual.hum")
      .summary("Hum of the mains: 50 or 60 Hz and its third harmonic in the output")
      .doc(
          "Amplitudes and phases are free in every record, the frequency is one. Sought where a tone between the lines is near: "
          "hum that falls on a line of the excitation looks like part of the response.")
      .acts(Acts::tone);
}

std::vector<FitParameter> Hum::parameters(const Situation& s) const {
  return {real("hum_frequency", "Hz", 0.1 / size_or_one(s.duration_s)).between(48.0, 62.0).says("of the mains")};
}

std::vector<std::vector<double>> Hum::starts(const Situation& s) const {
  std::vector<std::vector<double>> starts;
  for (const double f : mains_peaks(s)) {
    if (starts.size() < 3) starts.push_back({f});
  }
  return starts.empty() ? std::vector<std::vector<double>>{{50.0}, {60.0}} : starts;
}

std::string Hum::sentence(std::span<const double> value, std::span<const double> std, const Situation&) const {
  return "hum of the mains, " + quantity(value[0], std[0], "Hz") + " and its third harmonic";
}

std::string Hum::refuses(const Situation& s) const {
  return mains_peaks(s).empty() ? "no tone between the lines near 50 or 60 Hz or three times that" : "";
}

std::vector<double> Hum::tones_hz(const double* p) const { return {p[0], 3.0 * p[0]}; }

}  // namespace bodeflow::residual
