#include "goertzel_block.hpp"

#include <algorithm>
#include <cmath>

#include "records.hpp"

namespace bodeflow::spectrum {
namespace {

// A frequency that is whole cycles in a window but for its decimal places.
constexpr double kWhole = 1e-9;

}  // namespace

void Goertzel::describe(Describe& d) {
  d.id("spectrum.goertzel")
      .summary("Gives amplitude and phase of a few frequencies, over a sliding window.")
      .realtime_safe()
      .cost_ns(5);
  d.doc(
      "X = 2/N sum of the newest N samples x[n] exp(-2 pi i m n / N), so that x[n] = A cos(2 pi m n / N + phi) has X = A exp(i "
      "phi), n counted from "
      "the first sample: constant in a steady state. Each frequency is m whole cycles in a window: an offset and the other such "
      "frequencies fall out; what lies between them leaks in (rectangular window, first side lobe -13 dB). One value each `hop` "
      "samples; the "
      "samples before the first count as zero, so the first whole window is value window / hop. Does not drift: every window the "
      "sum is "
      "begun anew, so a value depends on the newest 2 N samples only, to the bit, after 1e9 samples as after the first.");
  d.reference("G. Goertzel, An algorithm for the evaluation of finite trigonometric series, 1958, doi:10.2307/2310304");
  d.reference("E. Jacobsen, R. Lyons, The sliding DFT, 2003, doi:10.1109/MSP.2003.1184347");
  d.stream_in(in).doc("any number of channels");
  d.stream_out(out).doc("channel by channel one for each frequency");
  d.required<std::vector<double>>("frequencies").unit("Hz").above(0.0).doc("whole multiples of the sample rate / window");
  d.required<std::int64_t>("window").range(3, 1e8).doc("N, samples; the bandwidth is about the sample rate / N");
  d.parameter("hop", std::int64_t{1}).range(1, 1e8).doc("samples between two values; divides the window");
}

void Goertzel::configure(const Parameters& p) {
  frequencies_hz_ = p.numbers("frequencies");
  if (frequencies_hz_.empty()) fail("frequencies is empty");
  window_ = p.integer("window");
  hop_ = p.integer("hop");
  if (window_ < 3 || hop_ < 1) fail("window and hop are at least 3 and 1");
  if (window_ % hop_ != 0)
    fail("hop " + std::to_string(hop_) + " does not divide the window of " + std::to_string(window_) + " samples");
}

void Goertzel::resolve(Facts& f) {
  f.samples(in, hop_);
  const StreamFacts& x = f.in(in);
  if (!x.known) return;
  if (!x.rate.known()) fail("input 'in' has no sample rate");
  channels_ = static_cast<std::size_t>(x.channels);
  const double bin = x.rate.hz() / static_cast<double>(window_);
  cycles_.clear();
  for (const double frequency : frequencies_hz_) {
    const double cycles = std::round(frequency / bin);
    if (!(cycles >= 1.0) || !(2.0 * cycles < static_cast<double>(window_))) {
      fail("frequency " + short_number(frequency) + " Hz with a window of " + std::to_string(window_) + " samples at " +
           short_number(x.rate.hz()) + " Hz; allowed: " + short_number(bin) +
           " Hz and its multiples below half of the sample rate");
    }
    if (std::abs(frequency - cycles * bin) > kWhole * frequency) {
      fail("frequency " + short_number(frequency) + " Hz is " + short_number(frequency / bin) + " cycles in a window of " +
           std::to_string(window_) + " samples; nearest whole: " + short_number(cycles * bin) + " Hz");
    }
    cycles_.push_back(static_cast<std::int64_t>(cycles));
  }
  StreamFacts& y = f.out(out);
  y.known = true;
  y.channels = x.channels * static_cast<int>(frequencies_hz_.size());
  y.rate = x.rate.scaled(1, hop_);
  y.length = x.length < 0 ? -1 : x.length / hop_;
  y.clock = x.clock;
  y.unit = x.unit;
  y.channel_names.clear();
  y.channel_units.clear();
  const Signals signals = signals_of(x, "in");
  for (std::size_t c = 0; c < signals.names.size(); ++c) {
    for (const double frequency : frequencies_hz_) {
      y.channel_names.push_back(signals.names[c] + " at " + short_number(frequency) + " Hz");
      y.channel_units.push_back(signals.units[c]);
    }
  }
}

void Goertzel::activate(const Activation&) {
  tables_.clear();
  for (const std::int64_t cycles : cycles_) tables_.emplace_back(window_, cycles);
  sums_.assign(channels_, std::vector<SineWindow>(cycles_.size(), SineWindow(window_ / hop_)));
  reset();
}

void Goertzel::reset() {
  for (auto& channel : sums_) {
    for (SineWindow& sum : channel) sum.clear();
  }
  at_ = 0;
  samples_ = 0;
}

void Goertzel::process(Io& io) {
  const auto hop = static_cast<std::size_t>(hop_);
  for (std::size_t firing = 0; firing < io.count(); ++firing) {
    for (std::size_t c = 0; c < sums_.size(); ++c) {
      const auto x = io.read(in, static_cast<int>(c)).subspan(firing * hop, hop);
      for (std::size_t n = 0; n < hop; ++n) {
        if (!std::isfinite(x[n])) {
          fail("channel " + std::to_string(c + 1) + ": sample " + std::to_string(samples_ + n) + " is " +
               (std::isnan(x[n]) ? "not a number" : "infinite"));
        }
      }
      for (std::size_t k = 0; k < tables_.size(); ++k) {
        std::complex<double> sum = 0.0;
        for (std::size_t n = 0; n < hop; ++n) sum += x[n] * tables_[k][at_ + n];
        io.write(out, static_cast<int>(c * tables_.size() + k))[firing] = sums_[c][k].push(sum);
      }
    }
    samples_ += hop;
    at_ = (at_ + hop) % static_cast<std::size_t>(window_);
  }
}

void Goertzel::deactivate() {
  tables_.clear();
  sums_.clear();
}

}  // namespace bodeflow::spectrum
