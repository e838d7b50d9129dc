#include "motor_standstill.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <bodeflow/numerics/fft.hpp>
#include <cmath>
#include <numbers>

#include "records/signals.hpp"

namespace bodeflow::residual {
namespace {

using Complex = std::complex<double>;

// Values of a band-limited input for each sample of a simulation.
constexpr int kFine = 10;
constexpr int kReweightings = 4;
constexpr double kTwoPi = 2.0 * std::numbers::pi;

double sinc(double x) { return x == 0.0 ? 1.0 : std::sin(x) / x; }

/// What a mode r / (s - p) has reached after t with a constant input of 1.
double charged(double residue, double pole, double t) { return residue * std::expm1(pole * t) / pole; }

/// A band-limited input as kFine held values a sample: those of its spectrum in the middle of each step, divided by the response
/// of the hold, so that what drives the model has the spectrum of the input.
Eigen::VectorXd fine_input(const Experiment& e) {
  const Eigen::VectorXcd lines = numerics::half_dft(e.input);
  const Eigen::Index length = e.period * kFine;
  Eigen::VectorXcd full = Eigen::VectorXcd::Zero(length);
  for (Eigen::Index k = 0; k < (e.period + 1) / 2; ++k) {
    const double half_step = std::numbers::pi * static_cast<double>(k) / static_cast<double>(length);
    const Complex value = std::polar(static_cast<double>(kFine) / sinc(half_step), half_step) * lines[k];
    full[k] = value;
    if (k > 0) full[length - k] = std::conj(value);
  }
  return numerics::inverse_dft(full).real();
}

/// The largest magnitude of a period whose Fourier coefficients these are.
double peak_of(const Eigen::VectorXcd& lines, Eigen::Index period) {
  Eigen::VectorXcd full = Eigen::VectorXcd::Zero(period);
  full[0] = lines[0] * static_cast<double>(period);
  for (Eigen::Index k = 1; k < lines.size(); ++k) {
    full[k] = lines[k] * static_cast<double>(period);
    full[period - k] = std::conj(full[k]);
  }
  return numerics::inverse_dft(full).real().cwiseAbs().maxCoeff();
}

/// The excited lines of all experiments with the measured response, the declared hold and delay taken off.
struct Measured {
  std::vector<Complex> s, response;
  std::vector<double> weight;
};

/// (b1 s + b0) / (s^2 + a1 s + a0) by linear least squares, reweighted with the denominator before (Sanathanan & Koerner, 1963);
/// s in units of `scale`.
Eigen::Vector4d linearised_fit(const Measured& m, double scale) {
  const auto lines = static_cast<Eigen::Index>(m.s.size());
  Eigen::MatrixXd a(2 * lines, 4);
  Eigen::VectorXd right(2 * lines);
  Eigen::Vector4d x(0.0, 0.0, 0.0, 0.0);  // a1, a0, b1, b0
  for (int round = 0; round < kReweightings; ++round) {
    for (Eigen::Index k = 0; k < lines; ++k) {
      const auto at = static_cast<std::size_t>(k);
      const Complex s = m.s[at] / scale, g = m.response[at];
      const Complex before = round == 0 ? Complex(1.0) : s * s + x[0] * s + x[1];
      const Complex w = m.weight[at] / before;
      const Complex row[] = {g * s * w, g * w, -s * w, -w};
      for (Eigen::Index c = 0; c < 4; ++c) {
        a(k, c) = row[c].real();
        a(lines + k, c) = row[c].imag();
      }
      right[k] = -(g * s * s * w).real();
      right[lines + k] = -(g * s * s * w).imag();
    }
    x = a.colPivHouseholderQr().solve(right);
  }
  return {x[0] * scale, x[1] * scale * scale, x[2] * scale, x[3] * scale * scale};
}

}  // namespace

MotorStandstill::MotorStandstill(MotorInput input, double computation_delay_s)
    : input_(input), computation_delay_s_(computation_delay_s) {}

std::vector<Parameter> MotorStandstill::parameters() const {
  return {{"gamma", "1/s", 0.0, 1e9, true, 1.0},
          {"alpha", "1/s", 0.0, 1e9, true, 1.0},
          {"Lm_beta", "1", 0.0, 1e6, true, 1.0},
          {"sigma", "H", 0.0, 1e6, true, 1.0}};
}

std::vector<std::string> MotorStandstill::conventions() const {
  std::vector<std::string> texts = {"amplitude-invariant Clarke transform, one axis, Ls = Lr"};
  if (input_ == MotorInput::command) {
    texts.push_back("the input is the command, held over each sample (zero-order hold) and applied " +
                    records::short_number(1e6 * computation_delay_s_) + " us after it (computation delay)");
  } else if (input_ == MotorInput::period_mean) {
    texts.push_back("the input is the mean terminal voltage of each sample period");
  } else {
    texts.push_back("the input is the terminal voltage, sampled without aliasing");
  }
  return texts;
}

Complex MotorStandstill::response(const Eigen::Vector4d& values, double frequency_hz, double sample_time_s,
                                  double extra_delay_s) const {
  const MotorModes modes = motor_modes(values);
  const double omega = kTwoPi * frequency_hz, delay_s = declared_delay_s() + extra_delay_s;
  Complex sum = 0.0;
  if (!held()) {
    for (int i = 0; i < 2; ++i) sum += modes.residue[i] / (Complex(0.0, omega) - modes.pole[i]);
    return sum * std::polar(1.0, -omega * delay_s);
  }
  const double whole = std::floor(delay_s / sample_time_s), offset = sample_time_s - (delay_s - whole * sample_time_s);
  const Complex z = std::polar(1.0, omega * sample_time_s);
  for (int i = 0; i < 2; ++i) {
    const double pole = modes.pole[i], residue = modes.residue[i];
    sum += std::exp(pole * offset) * charged(residue, pole, sample_time_s) / (z - std::exp(pole * sample_time_s)) +
           charged(residue, pole, offset);
  }
  return sum * std::polar(1.0, -omega * sample_time_s * (whole + 1.0));
}

Eigen::VectorXd MotorStandstill::simulate_experiment(const Experiment& e, const Eigen::VectorXd& values,
                                                     const Extension& extension) const {
  Timing timing{e.sample_time_s(), held() ? 1 : kFine, declared_delay_s() + delay_s(extension), 1};
  for (const AddedEffect& added : extension)
    timing.steps_per_sample = std::max(timing.steps_per_sample, added.effect->steps_per_sample());
  return simulate(values, timing, held() ? e.input : fine_input(e), extension);
}

Eigen::VectorXcd MotorStandstill::steady_state(const Experiment& e, const Eigen::VectorXd& values,
                                               const Extension& extension) const {
  if (!(values[0] > values[1] * values[2])) {  // Rs is not above 0
    return Eigen::VectorXcd::Constant(e.lines(), std::numeric_limits<double>::quiet_NaN());
  }
  if (!is_linear(extension)) {
    const Eigen::VectorXd current = simulate_experiment(e, values, extension);
    return numerics::half_dft(current).head(e.lines()) / static_cast<double>(e.period);
  }
  const Eigen::VectorXcd input = numerics::half_dft(e.input) / static_cast<double>(e.period);
  const double extra_s = delay_s(extension);
  Eigen::VectorXcd output(e.lines());
  for (Eigen::Index k = 0; k < e.lines(); ++k)
    output[k] = response(values, e.frequency_hz[k], e.sample_time_s(), extra_s) * input[k];
  return output;
}

Expected<Eigen::VectorXd> MotorStandstill::start(std::span<const Experiment> experiments) const {
  Measured m;
  double log_sum = 0.0;
  for (const Experiment& e : experiments) {
    for (Eigen::Index k = 1; k < e.lines(); ++k) {
      if (e.kind[static_cast<std::size_t>(k)] != Kind::excited) continue;
      const double omega = kTwoPi * e.frequency_hz[k], half = omega * e.sample_time_s() / 2.0;
      const Complex path = std::polar(held() ? sinc(half) : 1.0, -(held() ? half : 0.0) - omega * declared_delay_s());
      m.s.emplace_back(0.0, omega);
      m.response.push_back(e.output[k] / (e.input_lines[k] * path));
      m.weight.push_back(std::abs(e.input_lines[k]) / std::sqrt(e.variance[k]));
      log_sum += std::log(omega);
    }
  }
  if (m.s.size() < 2) return refused("the base model needs at least 2 excited lines, found " + std::to_string(m.s.size()));
  const double middle = std::exp(log_sum / static_cast<double>(m.s.size()));
  const Eigen::Vector4d x = linearised_fit(m, middle);
  const double sigma = 1.0 / x[2], alpha = x[3] / x[2], gamma = x[0] - alpha, lm_beta = (gamma - x[1] / alpha) / alpha;
  const Eigen::Vector4d found(gamma, alpha, lm_beta, sigma);
  if (found.allFinite() && (found.array() > 0.0).all() && x[1] > 0.0) return Eigen::VectorXd(found);
  // A circuit of the band's own scale, with the resistance of the first and the inductance of the last line.
  const double rs = 0.7 * (1.0 / m.response.front()).real(),
               last = std::abs((1.0 / m.response.back()).imag()) / m.s.back().imag();
  if (!(rs > 0.0) || !(last > 0.0))
    return refused("the measured response has no positive resistance: check the signs of the signals");
  return Eigen::VectorXd(Eigen::Vector4d(rs / last + 0.5 * middle, 0.1 * middle, 5.0, last));
}

Expected<std::vector<Eigen::VectorXd>> MotorStandstill::starts(std::span<const Experiment> experiments) const {
  std::vector<Eigen::VectorXd> all;
  const auto together = start(experiments);
  if (!together) return tl::unexpected(together.error());
  all.push_back(*together);
  for (const Experiment& e : experiments)
    if (const auto alone = start({&e, 1}); alone && experiments.size() > 1) all.push_back(*alone);
  return all;
}

Scales MotorStandstill::scales(std::span<const Experiment> experiments, const Eigen::VectorXd& values) const {
  const TCircuit c = t_circuit(values);
  Scales s;
  double power = 0.0;
  for (const Experiment& e : experiments) {
    const Eigen::VectorXcd current = steady_state(e, values, {});
    Eigen::VectorXcd flux(e.lines());  // lm i_m, with the rotor current that the rotor's equation gives
    for (Eigen::Index k = 0; k < e.lines(); ++k) {
      const Complex jw(0.0, kTwoPi * e.frequency_hz[k]);
      flux[k] = current[k] * c.lm * (c.rr + jw * c.leakage) / (c.rr + jw * (c.leakage + c.lm));
    }
    s.sample_time_s = e.sample_time_s();
    s.flow = std::max(s.flow, peak_of(current, e.period));
    s.stored = std::max(s.stored, peak_of(flux, e.period));
    power = std::max(power, e.input.squaredNorm() / static_cast<double>(e.period));
  }
  s.effort = std::sqrt(power);
  return s;
}

void MotorStandstill::describe(const Eigen::VectorXd& v, const Extension& extension, records::ModelData& model) const {
  const MotorModes modes = motor_modes(v);
  model.form = "physical";
  model.order = 2;
  model.delay_s = declared_delay_s() + delay_s(extension);
  model.numerator = Eigen::Vector2d(1.0 / v[3], v[1] / v[3]);
  model.denominator = Eigen::Vector3d(1.0, v[0] + v[1], v[1] * (v[0] - v[1] * v[2]));
  model.poles = modes.pole.cast<Complex>();
  model.zeros = Eigen::VectorXcd::Constant(1, Complex(-v[1], 0.0));
}

}  // namespace bodeflow::residual
