#include "power_meter_block.hpp"

#include <cmath>
#include <numbers>

#include "records/signals.hpp"

namespace bodeflow::drive {
namespace {

using Complex = std::complex<double>;

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kLongestCycle = 1e9;  // samples

}  // namespace

void PowerMeter::describe(Describe& d) {
  d.id("drive.power_meter").summary("Measures voltage, current, power and impedance of a machine at one frequency.").role("sink");
  d.doc(
      "Phasors U and I (peak, per phase of the star) over all whole cycles after `skip`: of the positive sequence, the mean of "
      "(x_alpha + j x_beta) exp(-j w n T), with two channels; twice the mean of x_alpha exp(-j w n T) with one; plain means at "
      "frequency 0. A voltage that is the mean of its period and is held over it has U = U_dft (1 - exp(-j w T)) / (j w T) "
      "against currents sampled at the start of the periods. The images of the hold in the current are left out: a relative "
      "error of "
      "(pi f T)^2 / 3 L / L_h, L the inductance at f, L_h that at high frequencies (1e-3 for a motor without load at 50 Hz and "
      "10 "
      "kHz: sample faster). Powers are those of all three phases.");
  d.stream_in(voltage).doc("terminal voltage [V]: alpha, or alpha and beta, amplitude-invariant");
  d.stream_in(current).doc("current [A], as many channels");
  d.message_out(out)
      .record_type("power_measurement")
      .doc(
          "at the end: frequency, cycles, voltage and current (rms per phase; means at frequency 0), active_power, "
          "reactive_power, "
          "resistance and reactance of a phase");
  d.parameter("frequency", 50.0).unit("Hz").range(0, 1e6).doc("a cycle must be a whole number of samples; 0: direct current");
  d.parameter("skip", 0.0).unit("s").range(0, 1e6).doc("left out at the start");
  d.parameter("voltage_is", "period_mean")
      .choices({"period_mean", "sampled"})
      .doc("period_mean: held over the sample's period, as an inverter and drive.supply give it");
}

void PowerMeter::configure(const Parameters& p) {
  frequency_hz_ = p.number("frequency");
  skip_s_ = p.number("skip");
  holds_ = p.text("voltage_is") == "period_mean";
}

void PowerMeter::resolve(Facts& f) {
  const StreamFacts &u = f.in(voltage), &i = f.in(current);
  if (!u.known || !i.known) return;
  if (u.channels != i.channels || u.channels > 2) {
    fail("'voltage' has " + records::counted(u.channels, "channel") + ", 'current' " + std::to_string(i.channels) +
         "; allowed: both 1 (alpha), or both 2 (alpha, beta)");
  }
  channels_ = u.channels;
  rate_hz_ = u.rate.hz();
  const double least = frequency_hz_ == 0 ? 1.0 : 4.0, samples = frequency_hz_ == 0 ? 1.0 : rate_hz_ / frequency_hz_;
  if (!(samples >= least && samples <= kLongestCycle) || std::abs(samples - std::round(samples)) > 1e-9 * samples) {
    fail("a cycle of " + records::short_number(frequency_hz_) + " Hz has " + records::short_number(samples) +
         " samples, allowed: a whole number from 4 to 1e9");
  }
  cycle_ = static_cast<std::uint64_t>(std::round(samples));
  skip_ = static_cast<std::uint64_t>(std::ceil(skip_s_ * rate_hz_ - 1e-6));
}

void PowerMeter::process(Io& io) {
  for (std::size_t n = 0; n < io.count(); ++n) {
    const Complex u = sample(io, voltage, n), i = sample(io, current, n);
    const std::uint64_t at = io.position() + n;
    if (at < skip_) continue;
    const double angle = kTurn * static_cast<double>(at % cycle_) / static_cast<double>(cycle_);
    const Complex turn = frequency_hz_ == 0 ? Complex(1) : Complex(std::cos(angle), -std::sin(angle));
    cycle_u_ += u * turn;
    cycle_i_ += i * turn;
    if (++in_cycle_ < cycle_) continue;
    sum_u_ += cycle_u_;
    sum_i_ += cycle_i_;
    cycle_u_ = cycle_i_ = 0;
    in_cycle_ = 0;
    ++cycles_;
  }
}

std::complex<double> PowerMeter::sample(Io& io, In<double> port, std::size_t n) const {
  const Complex x(io.read(port, 0)[n], channels_ == 2 ? io.read(port, 1)[n] : 0.0);
  if (!std::isfinite(x.real()) || !std::isfinite(x.imag())) {
    fail(std::string("'") + port.name + "' is not finite at sample " + std::to_string(io.position() + n));
  }
  return x;
}

void PowerMeter::finish(Io& io) {
  if (cycles_ == 0) fail("no whole cycle of " + std::to_string(cycle_) + " samples after skip; allowed: one or more");
  const bool direct = frequency_hz_ == 0;
  const double scale = (channels_ == 1 && !direct ? 2.0 : 1.0) / static_cast<double>(cycles_ * cycle_);
  const double angle = kTurn * frequency_hz_ / rate_hz_;
  const Complex held = direct || !holds_ ? Complex(1) : (1.0 - std::exp(Complex(0, -angle))) / Complex(0, angle);
  const Complex u = sum_u_ * scale * held, i = sum_i_ * scale;
  if (i == 0.0) fail("no current at " + records::short_number(frequency_hz_) + " Hz, allowed: a machine that takes some");
  const Complex impedance = u / i;
  // A pulsating field, one channel, has half the power of a rotating one.
  const Complex power = (channels_ == 1 && !direct ? 0.75 : 1.5) * u * std::conj(i);
  const double rms = direct ? 1.0 : std::numbers::sqrt2 / 2;
  RecordBuilder r("power_measurement");
  r.set("frequency", frequency_hz_);
  r.set("cycles", cycles_);
  r.set("voltage", rms * std::abs(u));
  r.set("current", rms * std::abs(i));
  r.set("active_power", power.real());
  r.set("reactive_power", power.imag());
  r.set("resistance", impedance.real());
  r.set("reactance", impedance.imag());
  io.emit(out, r);
}

void PowerMeter::reset() {
  in_cycle_ = cycles_ = 0;
  cycle_u_ = cycle_i_ = sum_u_ = sum_i_ = 0;
}

}  // namespace bodeflow::drive
