#include "motor_standstill.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>

namespace bodeflow::residual {
namespace {

using Complex = std::complex<double>;
using Row = std::array<double, 4>;

constexpr int kReweightings = 4;

/// One phase as a T circuit.
struct TCircuit {
  double rs = 0.0;       ///< [ohm]
  double rr = 0.0;       ///< [ohm]
  double leakage = 0.0;  ///< of stator and rotor each [H]
  double lm = 0.0;       ///< [H]
};

TCircuit t_circuit(const double* p) {
  const double gamma = p[0], alpha = p[1], lm_beta = p[2], sigma = p[3];
  const double ls = sigma * (1.0 + lm_beta), lm = std::sqrt(ls * sigma * lm_beta);
  return {sigma * (gamma - alpha * lm_beta), alpha * ls, ls - lm, lm};
}

/// The excited lines of all records: s, response, one over its deviation.
struct Lines {
  std::vector<Complex> s, response;
  std::vector<double> weight;
};

/// The normal equations of a linear least-squares problem in four unknowns.
class Normal {
 public:
  void add(const Row& row, double right) {
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j < 4; ++j) a_[i][j] += row[i] * row[j];
      b_[i] += row[i] * right;
    }
  }

  /// By Cholesky's method, columns scaled to 1; not finite where the unknowns are not determined.
  Row solved() const {
    std::array<Row, 4> l{};
    Row scale{}, x{};
    for (std::size_t i = 0; i < 4; ++i) scale[i] = 1.0 / std::sqrt(a_[i][i]);
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j <= i; ++j) {
        double sum = a_[i][j] * scale[i] * scale[j];
        for (std::size_t k = 0; k < j; ++k) sum -= l[i][k] * l[j][k];
        l[i][j] = i == j ? std::sqrt(sum) : sum / l[j][j];
      }
      x[i] = b_[i] * scale[i];
      for (std::size_t k = 0; k < i; ++k) x[i] -= l[i][k] * x[k];
      x[i] /= l[i][i];
    }
    for (std::size_t i = 4; i-- > 0;) {
      for (std::size_t k = i + 1; k < 4; ++k) x[i] -= l[k][i] * x[k];
      x[i] /= l[i][i];
    }
    for (std::size_t i = 0; i < 4; ++i) x[i] *= scale[i];
    return x;
  }

 private:
  std::array<Row, 4> a_{};
  Row b_{};
};

/// a1, a0, b1, b0 of (b1 s + b0) / (s^2 + a1 s + a0) by linear least squares, reweighted with the denominator before (C. K.
/// Sanathanan, J. Koerner, Transfer function synthesis as a ratio of two complex polynomials, IEEE Trans. Automatic Control 8,
/// 1963); s in units of `scale`.
Row linearised_fit(const Lines& lines, double scale) {
  Row x{};
  for (int round = 0; round < kReweightings; ++round) {
    Normal normal;
    for (std::size_t k = 0; k < lines.s.size(); ++k) {
      const Complex s = lines.s[k] / scale, g = lines.response[k];
      const Complex w = lines.weight[k] / (round == 0 ? Complex(1.0) : s * s + x[0] * s + x[1]);
      const Complex terms[] = {g * s * w, g * w, -s * w, -w}, right = -g * s * s * w;
      normal.add({terms[0].real(), terms[1].real(), terms[2].real(), terms[3].real()}, right.real());
      normal.add({terms[0].imag(), terms[1].imag(), terms[2].imag(), terms[3].imag()}, right.imag());
    }
    x = normal.solved();
  }
  return {x[0] * scale, x[1] * scale * scale, x[2] * scale, x[3] * scale * scale};
}

Lines lines_of(std::span<const MeasuredResponse> measured) {
  Lines lines;
  for (const MeasuredResponse& m : measured) {
    for (std::size_t k = 0; k < m.frequency_hz.size(); ++k) {
      if (!(m.frequency_hz[k] > 0.0)) continue;
      lines.s.emplace_back(0.0, 2.0 * std::numbers::pi * m.frequency_hz[k]);
      lines.response.push_back(m.response[k]);
      lines.weight.push_back(m.weight.empty() ? 1.0 / std::abs(m.response[k]) : m.weight[k]);
    }
  }
  return lines;
}

/// gamma, alpha, Lm_beta, sigma near these lines.
std::vector<double> start(const Lines& lines) {
  if (lines.s.size() < 2) fail("the base model needs at least 2 excited lines, found " + std::to_string(lines.s.size()));
  double log_sum = 0.0;
  for (const Complex& s : lines.s) log_sum += std::log(s.imag());
  const double middle = std::exp(log_sum / static_cast<double>(lines.s.size()));
  const Row x = linearised_fit(lines, middle);
  const double sigma = 1.0 / x[2], alpha = x[3] / x[2], gamma = x[0] - alpha, lm_beta = (gamma - x[1] / alpha) / alpha;
  const std::vector<double> found = {gamma, alpha, lm_beta, sigma};
  if (x[1] > 0.0 && std::all_of(found.begin(), found.end(), [](double v) { return std::isfinite(v) && v > 0.0; })) return found;
  // A circuit of the band's own scale, with the resistance of the lowest and the inductance of the highest line.
  const auto by_frequency = [](const Complex& a, const Complex& b) { return a.imag() < b.imag(); };
  const auto low = std::min_element(lines.s.begin(), lines.s.end(), by_frequency) - lines.s.begin();
  const auto high = std::max_element(lines.s.begin(), lines.s.end(), by_frequency) - lines.s.begin();
  const double rs = 0.7 * (1.0 / lines.response[static_cast<std::size_t>(low)]).real();
  const double reactance = std::abs((1.0 / lines.response[static_cast<std::size_t>(high)]).imag());
  const double inductance = reactance / lines.s[static_cast<std::size_t>(high)].imag();
  if (!(rs > 0.0) || !(inductance > 0.0))
    fail("the measured response has no positive resistance: check the signs of the signals");
  return {rs / inductance + 0.5 * middle, 0.1 * middle, 5.0, inductance};
}

std::string short_number(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value, std::chars_format::general, 6).ptr};
}

Place place(const char* name, const char* kind, const char* flow, const char* stored, const char* reaction) {
  Place p;
  p.name = name;
  p.kind = kind;
  p.flow_unit = flow;
  p.stored_unit = stored;
  p.reaction_unit = reaction;
  return p;
}

double& at(std::vector<double>& matrix, int columns, int row, int column) {
  return matrix[static_cast<std::size_t>(row * columns + column)];
}

}  // namespace

void MotorStandstill::describe(Describe& d) {
  d.id("residual.motor_standstill")
      .summary("An induction motor at standstill, one phase, from voltage to current.")
      .doc(
          "G(s) = (s + alpha)/sigma / (s^2 + s (gamma + alpha) + alpha (gamma - alpha Lm_beta)); places of its T circuit with "
          "equal leakages: inverter, stator and rotor winding, core.")
      .reference(
          "P. Castaldi, M. Montanari, A. Tilli, Induction motor model identification via frequency-domain Frisch scheme, "
          "2002: equation (17)");
  d.parameter("input", "command")
      .choices({"command", "period_mean", "terminal"})
      .doc(
          "which voltage the recordings have as input: the command (held over each sample, applied after the computation delay), "
          "the mean terminal voltage of each sample period, or the terminal voltage sampled without aliasing");
  d.parameter("computation_delay", 0.0).unit("s").range(0, 1).doc("from the sample of a command to the instant it acts");
}

void MotorStandstill::configure(const Parameters& p) {
  input_ = p.text("input");
  computation_delay_s_ = p.number("computation_delay");
  if (input_ != "command" && computation_delay_s_ > 0.0)
    fail("computation_delay belongs to a command; input is '" + input_ + "', which is measured behind it");
}

std::vector<FitParameter> MotorStandstill::parameters() const {
  return {positive("gamma", "1/s").says("Rs/sigma + alpha Lm_beta"), positive("alpha", "1/s").says("Rr/Lr"),
          positive("Lm_beta", "1").says("Lm^2/(sigma Lr)"),
          positive("sigma", "H").says("Ls - Lm^2/Lr, the transient inductance")};
}

std::vector<Place> MotorStandstill::places() const {
  return {place("inverter", "inverter", "A", "A*s", "V"), place("stator_winding", "winding", "A", "A*s", "V"),
          place("rotor_winding", "rotor", "A", "A*s", "V"), place("core", "core", "V", "V*s", "A")};
}

Timing MotorStandstill::timing() const {
  return {input_ == "terminal" ? Hold::band_limited : Hold::zero_order, computation_delay_s_};
}

std::vector<std::string> MotorStandstill::conventions() const {
  std::vector<std::string> texts = {"amplitude-invariant Clarke transform, one axis, Ls = Lr"};
  if (input_ == "command") {
    texts.push_back("the input is the command, held over each sample (zero-order hold) and applied " +
                    short_number(1e6 * computation_delay_s_) + " us after it (computation delay)");
  } else if (input_ == "period_mean") {
    texts.push_back("the input is the mean terminal voltage of each sample period");
  } else {
    texts.push_back("the input is the terminal voltage, sampled without aliasing");
  }
  return texts;
}

std::vector<std::vector<double>> MotorStandstill::starts(std::span<const MeasuredResponse> measured) const {
  std::vector<std::vector<double>> all = {start(lines_of(measured))};
  for (const MeasuredResponse& m : measured) {
    if (measured.size() < 2) break;
    try {
      all.push_back(start(lines_of({&m, 1})));
    } catch (const Failure&) {
      // A record that says too little alone is no place to start from.
    }
  }
  return all;
}

bool MotorStandstill::state_space(const double* v, const double*, LinearPlant& plant) const {
  for (int i = 0; i < 4; ++i)
    if (!(v[i] > 0.0) || !std::isfinite(v[i])) return false;
  if (!(v[0] > v[1] * v[2])) return false;  // Rs is not above 0
  const TCircuit c = t_circuit(v);
  // States: flux linkages of stator and rotor, x_s = l i + psi and x_r = l i_r + psi. With the core's extra current w,
  // i + i_r = psi / Lm + w gives the main flux psi = p (x_s + x_r) - q w, q = 1 / (2 / l + 1 / Lm), p = q / l.
  enum { inverter, stator, rotor, core, kPlaces };
  plant.resize(2, 1, kPlaces);
  const double l = c.leakage, q = 1.0 / (2.0 / l + 1.0 / c.lm), p = q / l;
  const double own = (1.0 - p) / l, other = -p / l, by_core = q / l;  // currents by x_s, x_r and w
  const double current[2][2] = {{own, other}, {other, own}};
  const double resistance[2] = {c.rs, c.rr};
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) at(plant.A, 2, i, j) = -resistance[i] * current[i][j];
    at(plant.E, kPlaces, i, core) = -resistance[i] * by_core;
  }
  at(plant.B, 1, 0, 0) = 1.0;
  at(plant.E, kPlaces, 0, inverter) = at(plant.E, kPlaces, 0, stator) = -1.0;
  at(plant.E, kPlaces, 1, rotor) = -1.0;
  for (const int k : {inverter, stator, rotor}) {
    const int circuit = k == rotor ? 1 : 0;
    for (int j = 0; j < 2; ++j) at(plant.Cf, 2, k, j) = current[circuit][j];
    at(plant.Ff, kPlaces, k, core) = by_core;
  }
  // The core's voltage, p (dx_s/dt + dx_r/dt); what a change of w induces in the leakage, -q dw/dt, is left out.
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) at(plant.Cf, 2, core, j) += p * at(plant.A, 2, i, j);
    for (int j = 0; j < kPlaces; ++j) at(plant.Ff, kPlaces, core, j) += p * at(plant.E, kPlaces, i, j);
    at(plant.Df, 1, core, 0) += p * at(plant.B, 1, i, 0);
  }
  for (int j = 0; j < 2; ++j) at(plant.Cs, 2, core, j) = p;
  at(plant.Fs, kPlaces, core, core) = -q;
  for (int j = 0; j < 2; ++j) plant.C[static_cast<std::size_t>(j)] = current[0][j];
  plant.F[core] = by_core;
  return true;
}

}  // namespace bodeflow::residual
