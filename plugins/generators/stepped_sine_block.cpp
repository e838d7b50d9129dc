#include "stepped_sine_block.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "source.hpp"

namespace bodeflow::generators {
namespace {

constexpr double kLeastTolerance = 1e-7;  // windows of 5e6 samples
constexpr std::int64_t kMostFrequencies = 100'000;
// Samples at one frequency: 11 days at 1 GHz.
constexpr std::int64_t kLongestDwell = 1'000'000'000'000'000;

std::vector<double> wanted_frequencies(const Parameters& p) {
  const bool grid = p.has("grid.first") || p.has("grid.last") || p.has("grid.count");
  if (p.has("frequencies")) {
    if (grid) fail("frequencies are given as a list as well as a grid; allowed: one of the two");
    if (p.numbers("frequencies").empty()) fail("frequencies is empty");
    return p.numbers("frequencies");
  }
  if (!p.has("grid.first") || !p.has("grid.last") || !p.has("grid.count"))
    fail("no frequencies: give a list 'frequencies', or 'grid' with first, last and count");
  const double first = p.number("grid.first"), last = p.number("grid.last");
  const std::int64_t count = p.integer("grid.count");
  if (count < 1 || count > kMostFrequencies)
    fail("grid.count is " + std::to_string(count) + ", allowed: 1 to " + std::to_string(kMostFrequencies));
  if (count > 1 && first == last) fail("grid: first and last are both " + hertz(first) + "; allowed: two frequencies");
  return frequency_grid(first, last, count, p.text("grid.spacing") == "logarithmic");
}

}  // namespace

void SteppedSine::describe(Describe& d) {
  d.id("generators.stepped_sine")
      .summary("Gives one sine after the other, each until it has been measured.")
      .role("source")
      .cost_ns(5);
  d.doc(
      "y[n] = amplitude sin(2 pi m n / N + phase). Each frequency is moved to the nearest m sample_rate / N that is within "
      "`tolerance`, so "
      "that m whole cycles are N whole samples and a correlation over N samples has no leakage. A record frequency_step with the "
      "index "
      "of the frequency that is on, such as spectrum.stepped_sine sends, goes on to the next; without one, `dwell` does. The "
      "stream "
      "ends after the last one. At the sample where a frequency begins, a record frequency_step tells what is on.");
  d.reference(
      "D. A. Jue, Frequency domain system identification with a rational, multi-band, curve-fitting approach, 1998, section 3.2");
  describe_source(d);
  d.optional<std::vector<double>>("frequencies").unit("Hz").above(0.0).doc("one by one, in the order in which they come");
  d.optional<double>("grid.first").unit("Hz").above(0.0).doc("first frequency of a grid, in place of a list; may be the highest");
  d.optional<double>("grid.last").unit("Hz").above(0.0).doc("last frequency");
  d.optional<std::int64_t>("grid.count").range(1, kMostFrequencies).doc("how many, both ends included");
  d.parameter("grid.spacing", "logarithmic").choices({"logarithmic", "linear"}).doc("constant ratio or constant distance");
  d.parameter("tolerance", 1e-3)
      .unit("1")
      .range(kLeastTolerance, 0.1)
      .doc("how far a frequency may be moved, relative; a smaller one makes longer windows");
  d.parameter("amplitude", std::vector<double>{1.0}).unit("").doc("peak: one value for all frequencies, or one a frequency");
  d.parameter("phase", "continuous")
      .choices({"continuous", "restart"})
      .doc("at a step: continuous goes on from the phase reached, restart begins the new sine at zero");
  d.parameter("silence", 0.0).unit("s").range(0, 1e9).doc("zeros before the first frequency, in which the noise can be measured");
  d.optional<double>("dwell").unit("s").above(0.0).doc(
      "longest time at a frequency, rounded up to whole windows; without it a frequency lasts until a record says so");
  d.message_in(step).optional().record_type("frequency_step").doc("attribute index: the frequency that has been measured");
  d.stream_out(out).doc("one channel");
  d.message_out(started)
      .record_type("frequency_step")
      .doc(
          "what begins: index, count, frequency and wanted_frequency [Hz], cycles, window [samples], sample_rate [Hz], "
          "amplitude");
}

void SteppedSine::configure(const Parameters& p) {
  rate_ = source_rate(p);
  unit_ = p.text("unit");
  continuous_ = p.text("phase") == "continuous";
  const double silence = p.number("silence") * rate_.hz();
  if (!(silence >= 0.0)) fail("silence is at least 0 s");
  silence_ = static_cast<std::int64_t>(std::min(std::round(silence), static_cast<double>(kLongestDwell)));
  dwell_s_ = p.has("dwell") ? p.number("dwell") : 0.0;
  configure_steps(p);
}

void SteppedSine::configure_steps(const Parameters& p) {
  const std::vector<double> wanted = wanted_frequencies(p);
  if (static_cast<std::int64_t>(wanted.size()) > kMostFrequencies)
    fail(std::to_string(wanted.size()) + " frequencies, allowed: " + std::to_string(kMostFrequencies));
  if (!(p.number("tolerance") >= kLeastTolerance)) fail("tolerance is at least 1e-7");
  auto steps = place_frequencies(wanted, rate_, p.number("tolerance"));
  if (!steps) fail(steps.error().text);
  steps_ = std::move(*steps);
  amplitudes_ = p.numbers("amplitude");
  if (amplitudes_.size() != 1 && amplitudes_.size() != steps_.size()) {
    fail("amplitude has " + std::to_string(amplitudes_.size()) + " values, allowed: 1, or one for each of the " +
         std::to_string(steps_.size()) + " frequencies");
  }
  for (const double amplitude : amplitudes_) {
    if (!std::isfinite(amplitude)) fail("an amplitude is not finite");
  }
  amplitudes_.resize(steps_.size(), amplitudes_.front());
}

/// Of the whole stream, if no record cuts a frequency short; -1: not known before.
std::int64_t SteppedSine::longest_length() const {
  if (!(dwell_s_ > 0.0)) return -1;
  std::int64_t length = silence_;
  for (const FrequencyStep& s : steps_) {
    if (length > kLongestDwell) return -1;
    length += dwell_samples(s);
  }
  return length;
}

/// -1: until a record says so.
std::int64_t SteppedSine::dwell_samples(const FrequencyStep& frequency) const {
  if (!(dwell_s_ > 0.0)) return -1;
  // A dwell that is whole windows but for rounding is not lengthened by one.
  const double windows = std::ceil(dwell_s_ * rate_.hz() / static_cast<double>(frequency.window) * (1.0 - 1e-12));
  const std::int64_t most = kLongestDwell / frequency.window;
  return (windows < static_cast<double>(most) ? static_cast<std::int64_t>(windows) : most) * frequency.window;
}

void SteppedSine::resolve(Facts& f) {
  StreamFacts facts = source_facts(rate_, unit_, 1, longest_length());
  for (const FrequencyStep& s : steps_) facts.notes["excitation.frequencies"].push_back(s.frequency_hz(rate_));
  facts.notes["excitation.amplitudes"] = amplitudes_;
  facts.notes["excitation.crest_factor"] = {std::numbers::sqrt2};
  f.out(out) = facts;
}

/// What the frequencies are, in a sentence.
std::string SteppedSine::summary() const {
  double farthest = 0.0;
  for (const FrequencyStep& s : steps_) farthest = std::max(farthest, std::abs(s.frequency_hz(rate_) / s.wanted_hz - 1.0));
  char moved[20];
  std::snprintf(moved, sizeof moved, "%.2g %%", 100.0 * farthest);
  return std::to_string(steps_.size()) + (steps_.size() == 1 ? " frequency from " : " frequencies from ") +
         hertz(steps_.front().frequency_hz(rate_)) + " to " + hertz(steps_.back().frequency_hz(rate_)) + ", moved by at most " +
         moved + " to fit the samples";
}

void SteppedSine::advise(const Facts&, Advice& a) {
  char time[40] = "";
  if (longest_length() >= 0)
    std::snprintf(time, sizeof time, "; at most %.4g s in all", static_cast<double>(longest_length()) / rate_.hz());
  a.tell(summary() + time);
}

void SteppedSine::activate(const Activation&) {
  log_info(summary());
  reset();
}

void SteppedSine::reset() {
  index_ = -1;
  left_ = silence_;
  phase_ = phase_step_ = Phase();
}

/// The next frequency begins `offset` samples after the beginning of the call; after the last one `index_` is their number.
void SteppedSine::begin_next(Io& io, std::uint64_t offset) {
  ++index_;
  const auto i = static_cast<std::size_t>(index_);
  if (i >= steps_.size()) return;
  const FrequencyStep& s = steps_[i];
  left_ = dwell_samples(s);
  // As many cycles as a rate of N samples: m / N cycles a sample, rounded to 2^-128.
  phase_step_ = Phase::step(static_cast<double>(s.cycles), Rate(s.window, 1));
  if (!continuous_) phase_ = Phase();
  RecordBuilder record("frequency_step");
  record.set("index", index_);
  record.set("count", static_cast<std::int64_t>(steps_.size()));
  record.set("frequency", s.frequency_hz(rate_));
  record.set("wanted_frequency", s.wanted_hz);
  record.set("cycles", s.cycles);
  record.set("window", s.window);
  record.set("sample_rate", rate_.hz());
  record.set("amplitude", amplitudes_[i]);
  io.emit(started, record, offset);
}

void SteppedSine::receive(int, const RecordView& record, Io& io) {
  const auto index = record.integer("index");
  if (record.type() != "frequency_step" || !index)
    fail("a record of type '" + std::string(record.type()) + "' on 'step'; needed: frequency_step with an integer 'index'");
  // One that comes after its frequency has ended by itself has nothing to say.
  if (*index == index_ && index_ >= 0 && !ended()) begin_next(io, 0);
}

void SteppedSine::process(Io& io) {
  const auto y = io.write(out);
  std::size_t n = 0;
  while (n < y.size()) {
    if (left_ == 0 && !ended()) begin_next(io, n);
    if (ended()) {
      std::fill(y.begin() + static_cast<std::ptrdiff_t>(n), y.end(), 0.0);
      io.end_after(n);
      return;
    }
    const std::size_t part = left_ < 0 ? y.size() - n : std::min(y.size() - n, static_cast<std::size_t>(left_));
    const double amplitude = index_ < 0 ? 0.0 : amplitudes_[static_cast<std::size_t>(index_)];
    for (const std::size_t end = n + part; n < end; ++n) {
      y[n] = amplitude * sine_of_cycles(phase_.cycles());
      phase_ += phase_step_;
    }
    if (left_ > 0) left_ -= static_cast<std::int64_t>(part);
  }
}

}  // namespace bodeflow::generators
