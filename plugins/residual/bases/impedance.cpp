#include "impedance.hpp"

#include <cmath>
#include <limits>

#include "declared_timing.hpp"
#include "impedance_start.hpp"

namespace bodeflow::residual {
namespace {

using Complex = std::complex<double>;

Place place(const char* name, const char* kind, const char* flow, const char* stored, const char* reaction) {
  Place p;
  p.name = name;
  p.kind = kind;
  p.flow_unit = flow;
  p.stored_unit = stored;
  p.reaction_unit = reaction;
  return p;
}

}  // namespace

void Impedance::describe(Describe& d) {
  d.id("residual.impedance")
      .summary("A loudspeaker, shaker or voice coil at its terminals, or a plain winding.")
      .doc(
          "V = (R + s L) I + Bl v, (m + added_mass) s v + r v + k v / s = Bl I. Records state `added_mass`; two different ones, "
          "or a "
          "declared force factor, make Bl, m, r and k known each. Effects act at the coil (over the current) and the spring "
          "(over the "
          "velocity).")
      .reference("R. H. Small, Direct-radiator loudspeaker system analysis, J. Audio Eng. Soc. 20 (1972) 383");
  d.parameter("quantity", "impedance")
      .choices({"impedance", "admittance"})
      .doc("what is measured: voltage over current, or current over voltage");
  d.parameter("motion", "driver").choices({"driver", "none"}).doc("a driver that moves, or a winding that does not");
  d.optional<double>("force_factor").unit("N/A").above(0.0).doc("Bl where it is known; it is not fitted then");
  describe_timing(d, Hold::band_limited);
}

void Impedance::configure(const Parameters& p) {
  admittance_ = p.text("quantity") == "admittance";
  motion_ = p.text("motion") == "driver";
  if (p.has("force_factor")) force_factor_ = p.number("force_factor");
  if (!motion_ && force_factor_) fail("force_factor belongs to a driver; motion is 'none'");
  timing_ = read_timing(p);
}

std::vector<FitParameter> Impedance::parameters() const {
  std::vector<FitParameter> all = {positive("resistance", "ohm").says("of the coil, at direct current"),
                                   real("inductance", "H", 1e-3)
                                       .between(0.0, std::numeric_limits<double>::infinity())
                                       .says("of the coil; it may vanish beside what effects add")};
  if (!motion_) return all;
  if (!force_factor_) all.push_back(positive("force_factor", "N/A").says("Bl, force for a unit of current"));
  all.push_back(positive("mass", "kg").says("that moves, with the air that moves along, without added_mass"));
  all.push_back(positive("mechanical_resistance", "N*s/m").says("force for a unit of velocity"));
  all.push_back(positive("stiffness", "N/m").says("of the suspension, one over the compliance"));
  return all;
}

std::vector<FitParameter> Impedance::known() const {
  if (!motion_) return {};
  return {real("added_mass", "kg", 0.01).says("fixed to what moves, in that record")};
}

std::vector<Place> Impedance::places() const {
  if (!motion_) return {place("coil", "coil", "A", "A*s", "V"), place("winding", "winding", "A", "A*s", "V")};
  return {place("coil", "coil", "A", "A*s", "V"), place("spring", "spring", "m/s", "m", "N")};
}

std::vector<std::string> Impedance::conventions() const {
  std::vector<std::string> words = {admittance_ ? "the response is the admittance, current over voltage"
                                                : "the response is the impedance, voltage over current"};
  if (force_factor_) words.push_back("the force factor is declared, " + short_text(*force_factor_) + " N/A");
  if (admittance_)
    for (std::string& text : timing_words(timing_)) words.push_back(std::move(text));
  return words;
}

Impedance::Values Impedance::values_of(const double* v, const double* known) const {
  Values x{v[0], v[1], 0.0, 1.0, 1.0, 1.0};
  if (!motion_) return x;
  const double* next = v + 2;
  x.force_factor = force_factor_ ? *force_factor_ : *next++;
  x.mass = next[0] + (known == nullptr ? 0.0 : known[0]);
  x.mechanical_resistance = next[1];
  x.stiffness = next[2];
  return x;
}

bool Impedance::valid(const Values& x) const {
  for (const double value : {x.resistance, x.mass, x.mechanical_resistance, x.stiffness})
    if (!(value > 0.0) || !std::isfinite(value)) return false;
  return x.inductance >= 0.0 && std::isfinite(x.inductance) && std::isfinite(x.force_factor);
}

std::vector<std::vector<double>> Impedance::starts(std::span<const MeasuredResponse> measured) const {
  const std::vector<ImpedanceLines> records = impedance_lines(measured, admittance_);
  std::vector<std::vector<double>> all;
  for (const double inductance : coil_inductances(records)) {
    std::vector<double> v = {coil_resistance(records), inductance};
    if (motion_) {
      const DriverStart d = driver_start(records, v[0], force_factor_);
      if (!force_factor_) v.push_back(d.force_factor);
      v.insert(v.end(), {d.mass, d.mechanical_resistance, d.stiffness});
    }
    all.push_back(std::move(v));
  }
  return all;
}

bool Impedance::state_space(const double* v, const double* known, LinearPlant& plant) const {
  const Values x = values_of(v, known);
  if (!admittance_ || !valid(x) || !(x.inductance > 0.0)) return false;
  const double per_l = 1.0 / x.inductance, per_m = 1.0 / x.mass;
  if (!motion_) {
    plant.resize(1, 1, 2);
    plant.A = {-x.resistance * per_l};
    plant.B = {per_l};
    plant.E = {-per_l, -per_l};
    plant.Cf = {1.0, 1.0};
    plant.C = {1.0};
    return true;
  }
  plant.resize(3, 1, 2);  // states: current, velocity, displacement
  plant.A = {-x.resistance * per_l,
             -x.force_factor * per_l,
             0.0,  //
             x.force_factor * per_m,
             -x.mechanical_resistance * per_m,
             -x.stiffness * per_m,
             0.0,
             1.0,
             0.0};
  plant.B = {per_l, 0.0, 0.0};
  plant.E = {-per_l, 0.0, 0.0, -per_m, 0.0, 0.0};
  plant.Cf = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0};
  plant.Cs = {0.0, 0.0, 0.0, 0.0, 0.0, 1.0};
  plant.C = {1.0, 0.0, 0.0};
  return true;
}

bool Impedance::response(const double* v, const double* known, Complex s, Complex* matrix) const {
  const Values x = values_of(v, known);
  if (!valid(x)) return false;
  const Complex mobility = motion_ ? s / (s * s * x.mass + s * x.mechanical_resistance + x.stiffness) : 0.0;
  const Complex transfer = x.force_factor * mobility;  // velocity for a unit of current
  const Complex total = x.resistance + s * x.inductance + x.force_factor * transfer;
  // Rows: output, flow of coil, flow of spring or winding; columns: input, reaction of coil, reaction of spring or winding.
  if (!motion_) {
    const Complex y = 1.0 / total;
    for (int row = 0; row < 3; ++row) {
      const bool voltage = !admittance_ && row == 0;
      matrix[3 * row] = voltage ? total : admittance_ ? y : 1.0;
      matrix[3 * row + 1] = matrix[3 * row + 2] = voltage ? 1.0 : admittance_ ? -y : 0.0;
    }
    return true;
  }
  if (!admittance_) {
    const Complex all[] = {total, 1.0, -transfer, 1.0, 0.0, 0.0, transfer, 0.0, -mobility};
    for (int i = 0; i < 9; ++i) matrix[i] = all[i];
    return true;
  }
  const Complex y = 1.0 / total, by_force = transfer * y;
  const Complex all[] = {y, -y, by_force, y, -y, by_force, transfer * y, -transfer * y, transfer * by_force - mobility};
  for (int i = 0; i < 9; ++i) matrix[i] = all[i];
  return true;
}

}  // namespace bodeflow::residual
