#include "supply_block.hpp"

#include <cmath>
#include <numbers>

namespace bodeflow::drive {

void Supply::describe(Describe& d) {
  d.id("drive.supply")
      .summary("Feeds a machine from the mains or from a direct voltage: no inverter, for the classical tests.")
      .role("source")
      .realtime_safe()
      .cost_ns(30);
  d.doc(
      "With a frequency: balanced three-phase sines of positive sequence as two channels, alpha and beta, amplitude-invariant; "
      "each sample is the mean over its period, V sinc(pi f T) cos(2 pi f (n + 1/2) T) and the sine, V = sqrt(2) voltage. With "
      "frequency 0: one channel, the direct voltage of the alpha axis: 2/3 of what stands between terminal a and the terminals b "
      "and c together.");
  d.required<double>("sample_rate").unit("Hz").above(0).below(1e9).doc("samples per second");
  d.required<double>("voltage").unit("V").range(-1e6, 1e6).doc("rms, per phase of the star; the voltage itself at frequency 0");
  d.parameter("frequency", 50.0).unit("Hz").range(0, 1e6).doc("at most a tenth of the sample rate");
  d.stream_out(out).doc("mean voltage of each sample's period [V]");
}

void Supply::configure(const Parameters& p) {
  rate_ = Rate::from_hz(p.number("sample_rate"));
  if (!rate_.known()) fail("sample_rate is not a fraction of whole numbers that the engine can hold");
  voltage_ = p.number("voltage");
  frequency_hz_ = p.number("frequency");
  if (frequency_hz_ > 0.1 * rate_.hz()) fail("frequency is above a tenth of the sample_rate, allowed: up to it");
}

void Supply::resolve(Facts& f) {
  StreamFacts& y = f.out(out);
  y.known = true;
  y.channels = frequency_hz_ == 0 ? 1 : 2;
  y.rate = rate_;
  y.unit = "V";
  y.channel_names = {"u_alpha"};
  if (y.channels == 2) y.channel_names.emplace_back("u_beta");
}

void Supply::process(Io& io) {
  if (frequency_hz_ == 0) {
    for (double& u : io.write(out)) u = voltage_;
    return;
  }
  const double half = std::numbers::pi * frequency_hz_ / rate_.hz();
  const double peak = std::numbers::sqrt2 * voltage_ * std::sin(half) / half;
  const auto alpha = io.write(out, 0), beta = io.write(out, 1);
  for (std::size_t n = 0; n < alpha.size(); ++n) {
    const double cycles = frequency_hz_ * ((static_cast<double>(io.position() + n) + 0.5) / rate_.hz());
    const double angle = 2 * std::numbers::pi * (cycles - std::floor(cycles));
    alpha[n] = peak * std::cos(angle);
    beta[n] = peak * std::sin(angle);
  }
}

}  // namespace bodeflow::drive
