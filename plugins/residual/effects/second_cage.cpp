#include "effects/second_cage.hpp"

#include "effects/response_words.hpp"

namespace bodeflow::residual {

void SecondCage::describe(DescribeEffect& effect) {
  effect.id("residual.second_cage")
      .summary("The rotor has a second cage.")
      .doc(
          "Two cages of resistance and leakage in parallel are the impedance R1 + s L1 + R s L / (R + s L). The base model has "
          "R1 and the whole "
          "leakage L1 + L that is seen at low frequencies; added is -k s^2 / (1 + s T), T = L / R, k = R T^2. Far below 1 / T "
          "this is a "
          "resistance that grows with the square of the frequency, as that of skin effect, and T can't be told.")
      .reference("P. L. Alger, Induction Machines, 2nd ed. 1970, chapter 8")
      .acts(Acts::immittance, {"rotor"});
}

std::vector<FitParameter> SecondCage::parameters(const Situation&) const {
  return {
      positive("second_cage_rise", "ohm s^2").says("growth of the rotor's resistance with the square of the angular frequency"),
      positive("second_cage_time", "s").says("leakage over resistance of the added branch")};
}

std::vector<std::vector<double>> SecondCage::starts(const Situation& s) const {
  const double resistance = lines::coefficient_of(s), highest = lines::highest_omega(s), middle = lines::middle_omega(s);
  std::vector<std::vector<double>> starts;
  for (const double omega : {2.0 * highest, std::sqrt(highest * middle), middle})
    starts.push_back({resistance / (omega * omega), 1.0 / omega});
  return starts;
}

std::string SecondCage::sentence(std::span<const double> value, std::span<const double> std, const Situation&) const {
  return "second cage of the rotor, time constant " + lines::time_words(value[1], std[1]) + ", " +
         lines::number(value[0] / (value[1] * value[1])) + " ohm";
}

std::complex<double> SecondCage::transfer(const double* p, std::complex<double> s) const {
  return -p[0] * s * s / (1.0 + s * p[1]);
}

}  // namespace bodeflow::residual
