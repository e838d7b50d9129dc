#include "effects/skin_effect.hpp"

#include "effects/response_words.hpp"

namespace bodeflow::residual {
namespace {

/// -45 (r coth r - 1 - x / 3) / x^2 with r = sqrt(x): 1 at x = 0.
std::complex<double> bar_shape(std::complex<double> x) {
  constexpr double kSeries = 0.05;  // below it the difference loses more digits than the series leaves out
  if (std::abs(x) < kSeries)
    return 1.0 + x * (-2.0 / 21.0 + x * (1.0 / 105.0 + x * (-2.0 / 2079.0 + x * (1382.0 * 45.0 / 638512875.0))));
  const std::complex<double> root = std::sqrt(x), fall = std::exp(-2.0 * root);
  return -45.0 * (root * (1.0 + fall) / (1.0 - fall) - 1.0 - x / 3.0) / (x * x);
}

}  // namespace

void SkinEffect::describe(DescribeEffect& effect) {
  effect.id("residual.skin_effect")
      .summary("Skin effect: the resistance of the conductors grows with frequency.")
      .doc(
          "Bars of height h and conductivity c in slots: R x coth x with x^2 = s T, T = mu0 c h^2. The base model has the "
          "resistance and the "
          "leakage that are seen at low frequencies; added is R (x coth x - 1 - x^2 / 3). Far below 1 / T that is a resistance k "
          "w^2, "
          "k = R T^2 / 45, and T can't be told; far above it grows with the square root of the frequency.")
      .reference(
          "R. Richter, Elektrische Maschinen I, 3rd ed. 1967, section on current displacement; P. L. Alger, Induction Machines, "
          "2nd ed. 1970, chapter 8")
      .acts(Acts::immittance, {"rotor", "winding"})
      .equivalent_to({"delay"},
                     "put a resistor in the place of the motor: a delay of the drive stays, a skin effect of the rotor does not");
}

std::vector<FitParameter> SkinEffect::parameters(const Situation&) const {
  return {positive("skin_effect_rise", "ohm s^2")
              .says("growth of the resistance with the square of the angular frequency, at low ones"),
          positive("skin_effect_time", "s").says("time in which the field diffuses into the conductor")};
}

std::vector<std::vector<double>> SkinEffect::starts(const Situation& s) const {
  const double resistance = lines::coefficient_of(s), highest = lines::highest_omega(s);
  std::vector<std::vector<double>> starts;
  for (const double depth : {1.0, 6.0, 30.0}) {
    const double time = depth / highest;
    starts.push_back({resistance * time * time / 45.0, time});
  }
  return starts;
}

std::string SkinEffect::sentence(std::span<const double> value, std::span<const double> std, const Situation& s) const {
  const std::complex<double> at_end = transfer(value.data(), {0.0, lines::highest_omega(s)});
  return "skin effect of the " + (s.place.name.empty() ? std::string("conductors") : s.place.name) +
         ": their resistance grows by " + lines::number(at_end.real(), 3) + " ohm up to " +
         lines::number(lines::highest_omega(s) / lines::kTwoPi, 3) + " Hz (time of diffusion " +
         lines::time_words(value[1], std[1]) + ")";
}

std::complex<double> SkinEffect::transfer(const double* p, std::complex<double> s) const {
  return -p[0] * s * s * bar_shape(s * p[1]);
}

}  // namespace bodeflow::residual
