#pragma once

#include <bodeflow/base_model.hpp>
#include <optional>

namespace bodeflow::residual {

/// An electrodynamic driver (loudspeaker, shaker, voice coil) at its terminals, by resistance R, inductance L, force factor Bl,
/// and a moving mass m on a spring k with the mechanical resistance r:
///   V = (R + s L) I + Bl v,   (m + added_mass) s v + r v + k v / s = Bl I
/// Or a winding R + s L alone (`motion: none`). The impedance V / I or the admittance I / V is what is measured; only the latter
/// has a state space. Bl, m, r and k belong to one factor that a single impedance leaves free: two records with different
/// `added_mass`, or a declared force factor, fix it.
class Impedance final : public BaseModel {
 public:
  static void describe(Describe& d);

  void configure(const Parameters& p) override;
  std::vector<FitParameter> parameters() const override;
  std::vector<Place> places() const override;
  std::vector<FitParameter> known() const override;
  Timing timing() const override { return timing_; }
  std::string response_unit() const override { return admittance_ ? "S" : "ohm"; }
  std::vector<std::string> conventions() const override;
  std::vector<std::vector<double>> starts(std::span<const MeasuredResponse> measured) const override;
  bool state_space(const double* v, const double* known, LinearPlant& plant) const override;
  bool has_state_space() const override { return admittance_; }
  bool response(const double* v, const double* known, std::complex<double> s, std::complex<double>* matrix) const override;

 private:
  struct Values {
    double resistance, inductance, force_factor, mass, mechanical_resistance, stiffness;
  };
  Values values_of(const double* v, const double* known) const;
  bool valid(const Values& v) const;

  bool admittance_ = false, motion_ = true;
  std::optional<double> force_factor_;
  Timing timing_;
};

}  // namespace bodeflow::residual
