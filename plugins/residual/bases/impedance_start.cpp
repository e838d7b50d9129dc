#include "impedance_start.hpp"

#include <algorithm>
#include <bodeflow/error.hpp>
#include <cmath>

namespace bodeflow::residual {
namespace {

using Complex = std::complex<double>;

/// The resonance of a record.
struct Resonance {
  double omega = 0.0;
  double height = 0.0;  ///< of the real part above the coil's resistance [ohm]
  double width = 0.0;   ///< between the points of half that height [rad/s]
  double added_mass = 0.0;
};

/// Where the reactance falls through 0 first; else the highest impedance between the ends of the record.
std::optional<std::size_t> resonant_line(const ImpedanceLines& r) {
  const auto& z = r.impedance;
  for (std::size_t k = 1; k < z.size(); ++k)
    if (z[k - 1].imag() > 0.0 && z[k].imag() <= 0.0) return z[k].real() > z[k - 1].real() ? k : k - 1;
  std::optional<std::size_t> best;
  for (std::size_t k = 1; k + 1 < z.size(); ++k) {
    const double own = std::abs(z[k]);
    if (own > std::abs(z[k - 1]) && own > std::abs(z[k + 1]) && (!best || own > std::abs(z[*best]))) best = k;
  }
  return best;
}

/// The frequency at which the real part passes `level` between lines k and k + step.
double passing(const ImpedanceLines& r, std::size_t inside, std::size_t outside, double level) {
  const double a = r.impedance[inside].real(), b = r.impedance[outside].real();
  const double share = std::abs(a - b) > 0.0 ? std::clamp((a - level) / (a - b), 0.0, 1.0) : 0.0;
  return r.omega[inside] + share * (r.omega[outside] - r.omega[inside]);
}

std::optional<Resonance> resonance_of(const ImpedanceLines& r, double resistance) {
  const auto peak = resonant_line(r);
  if (!peak) return std::nullopt;
  Resonance found;
  found.added_mass = r.added_mass;
  found.omega = r.omega[*peak];
  if (*peak > 0 && r.impedance[*peak - 1].imag() > 0.0 && r.impedance[*peak].imag() <= 0.0) {
    const double a = r.impedance[*peak - 1].imag(), b = r.impedance[*peak].imag();
    found.omega = r.omega[*peak - 1] + a / (a - b) * (r.omega[*peak] - r.omega[*peak - 1]);
  }
  found.height = r.impedance[*peak].real() - resistance;
  if (!(found.height > 0.0)) return std::nullopt;
  const double level = resistance + 0.5 * found.height;
  std::size_t low = *peak, high = *peak;
  while (low > 0 && r.impedance[low].real() > level) --low;
  while (high + 1 < r.omega.size() && r.impedance[high].real() > level) ++high;
  const double left = low < *peak ? passing(r, low + 1, low, level) : r.omega[low];
  const double right = high > *peak ? passing(r, high - 1, high, level) : r.omega[high];
  found.width = right - left;
  return found.width > 0.0 ? std::optional(found) : std::nullopt;
}

}  // namespace

std::vector<ImpedanceLines> impedance_lines(std::span<const MeasuredResponse> measured, bool admittance) {
  std::vector<ImpedanceLines> records;
  for (const MeasuredResponse& m : measured) {
    ImpedanceLines lines;
    lines.added_mass = m.known.empty() ? 0.0 : m.known[0];
    for (std::size_t k = 0; k < m.frequency_hz.size(); ++k) {
      if (!(m.frequency_hz[k] > 0.0)) continue;
      if (!(std::abs(m.response[k]) > 0.0)) fail("a measured response of 0 is no impedance");
      lines.omega.push_back(6.283185307179586 * m.frequency_hz[k]);
      lines.impedance.push_back(admittance ? 1.0 / m.response[k] : m.response[k]);
    }
    if (lines.omega.empty()) fail("a record has no line above frequency 0");
    records.push_back(std::move(lines));
  }
  if (records.empty()) fail("the base model needs at least one record");
  return records;
}

double coil_resistance(const std::vector<ImpedanceLines>& records) {
  double least = std::numeric_limits<double>::infinity();
  for (const ImpedanceLines& r : records)
    for (const Complex& z : r.impedance) least = std::min(least, z.real());
  if (least > 0.0 && std::isfinite(least)) return 0.98 * least;
  fail("the measured impedance has a negative resistance: check the signs of the signals, and whether it is an admittance");
}

std::vector<double> coil_inductances(const std::vector<ImpedanceLines>& records) {
  const ImpedanceLines& r = records.front();
  std::size_t first = r.omega.size() - 1;  // of the lines up to the end whose reactance is positive
  while (first > 0 && r.impedance[first - 1].imag() > 0.0) --first;
  std::vector<double> found;
  for (const std::size_t k : {r.omega.size() - 1, (first + r.omega.size() - 1) / 2})
    if (r.impedance[k].imag() > 0.0) found.push_back(r.impedance[k].imag() / r.omega[k]);
  if (found.empty()) found.push_back(0.1 * std::abs(r.impedance.back()) / r.omega.back());
  return found;
}

DriverStart driver_start(const std::vector<ImpedanceLines>& records, double resistance, std::optional<double> force_factor) {
  std::vector<Resonance> found;
  for (const ImpedanceLines& r : records)
    if (const auto resonance = resonance_of(r, resistance)) found.push_back(*resonance);
  if (found.empty()) fail("no record shows a resonance of the impedance; a winding that does not move is motion: none");
  const auto lighter = [](const Resonance& a, const Resonance& b) { return a.added_mass < b.added_mass; };
  const Resonance& a = *std::min_element(found.begin(), found.end(), lighter);
  const Resonance& b = *std::max_element(found.begin(), found.end(), lighter);
  if (force_factor) {
    const double mechanical = *force_factor * *force_factor / a.height,
                 mass = std::max(mechanical / a.width - a.added_mass, 1e-9);
    return {*force_factor, mass, mechanical, (mass + a.added_mass) * a.omega * a.omega};
  }
  if (!(b.added_mass > a.added_mass))
    fail(
        "all records with a resonance have the same added_mass: the force factor and all that moves are known up to one factor; "
        "state the added_mass of a second record, or declare force_factor");
  const double square_a = a.omega * a.omega, square_b = b.omega * b.omega;
  const double mass = (b.added_mass * square_b - a.added_mass * square_a) / (square_a - square_b);
  if (!(square_a > square_b) || !(mass > 0.0))
    fail("the added mass does not lower the resonance as a mass does: check which record has which added_mass");
  const double mechanical = 0.5 * (a.width * (mass + a.added_mass) + b.width * (mass + b.added_mass));
  const double height = 0.5 * (a.height + b.height);
  return {std::sqrt(mechanical * height), mass, mechanical, (mass + a.added_mass) * square_a};
}

}  // namespace bodeflow::residual
