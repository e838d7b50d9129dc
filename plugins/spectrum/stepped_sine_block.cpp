#include "stepped_sine_block.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace bodeflow::spectrum {
namespace {

// The standard deviation of so many samples is good to 7 %.
constexpr std::int64_t kLeastSilence = 100;
constexpr std::int64_t kLongestWindow = 100'000'000;

[[noreturn]] void refuse(const RecordView& record) {
  fail("a record of type '" + std::string(record.type()) +
       "' on 'started'; needed: frequency_step with index, count, cycles, window and sample_rate, as generators.stepped_sine "
       "sends");
}

/// Cycles and samples of the shortest whole window at `here` of one with `cycles` in `window` samples at `there`.
struct Window {
  std::int64_t cycles, samples;
};
std::optional<Window> at_rate(std::int64_t cycles, std::int64_t window, Rate there, Rate here) {
  const Rate ratio = here.scaled(there.den, there.num);  // samples here a sample there
  const std::int64_t repeats = ratio.den / std::gcd(window, ratio.den);
  if (repeats > kLongestWindow ||
      static_cast<double>(window) * static_cast<double>(repeats) * ratio.hz() > static_cast<double>(kLongestWindow))
    return std::nullopt;
  return Window{cycles * repeats, window * repeats / ratio.den * ratio.num};
}

}  // namespace

void SteppedSineBlock::describe(Describe& d) {
  d.id("spectrum.stepped_sine")
      .summary("Measures a frequency response one sine at a time, each for as long as it needs.")
      .cost_ns(40);
  d.doc(
      "Correlates input and outputs with the frequency that the generator announces, in windows of whole cycles, and finds out "
      "when the "
      "answer has settled. envelope: from a sample on all coefficients stay within threshold sigma sqrt(2 / window), sigma being "
      "the noise "
      "of the output's samples, which is white. repeat: the amplitudes of successive windows agree within `tolerance`. After "
      "`windows` settled "
      "windows that last `settled_time` at least, or after `max_time`, a record frequency_step sends the generator on; in a "
      "graph its "
      "connection needs a latency. G = Y/U of the mean amplitudes, with the variance that the scatter between the windows gives "
      "it. A slow "
      "transient that moves less than the threshold in that time passes for settled: set settled_time to several time "
      "constants.");
  d.reference(
      "D. A. Jue, Frequency domain system identification with a rational, multi-band, curve-fitting approach, 1998, section 3.2");
  d.reference(
      "R. Pintelon, J. Schoukens, System Identification: A Frequency Domain Approach, 2nd ed., 2012, chapter 2, "
      "doi:10.1002/9781118287422");
  d.stream_in(input).doc("what excites the plant: one channel");
  d.stream_in(output).doc("what the plant answers: one channel per output");
  d.message_in(started).record_type("frequency_step").doc("which frequency begins, from generators.stepped_sine");
  d.message_out(out)
      .record_type("frequency_response")
      .doc("the frequency response, at the end and, with `each`, after each frequency");
  d.message_out(step).record_type("frequency_step").doc("index: this frequency has been measured; goes back to the generator");
  d.parameter("settling", "envelope")
      .choices({"envelope", "repeat"})
      .doc("how it is seen that the answer has settled, see above");
  d.parameter("windows", std::int64_t{4}).range(2, 1e9).doc("settled windows to be averaged, at least");
  d.parameter("settled_time", 0.0).unit("s").range(0, 1e9).doc("how long the answer must have been settled, at least");
  d.optional<double>("max_time")
      .unit("s")
      .above(0.0)
      .doc("longest time at a frequency, settled or not; without it there is no limit");
  d.optional<std::vector<double>>("noise").unit("").doc(
      "envelope: standard deviation of the noise in the samples, one value or one an output; without it the samples before the "
      "first "
      "frequency tell it (the generator's `silence`)");
  d.parameter("threshold", 6 * 1.6)
      .unit("1")
      .range(1.0, 1e6)
      .doc("envelope: range of the coefficients, in their standard deviations");
  d.parameter("tolerance", 1e-3).unit("1").range(1e-12, 1.0).doc("repeat: relative difference of successive windows");
  d.parameter("advance", true)
      .doc("send the generator on; false: measure until it goes on by itself after its `dwell`, and take all that has settled");
  d.parameter("each", false).doc("a record with the lines so far after each frequency, too");
}

void SteppedSineBlock::configure(const Parameters& p) {
  rule_.kind = p.text("settling") == "envelope" ? SettlingRule::Kind::envelope : SettlingRule::Kind::repeat;
  rule_.factor = p.number("threshold");
  rule_.tolerance = p.number("tolerance");
  noise_given_ = p.has("noise");
  if (noise_given_) rule_.noise = p.numbers("noise");
  for (const double sigma : rule_.noise) {
    if (!(sigma > 0.0) || !std::isfinite(sigma)) fail("noise is " + short_number(sigma) + ", allowed: above 0");
  }
  windows_ = p.integer("windows");
  settled_time_s_ = p.number("settled_time");
  max_time_s_ = p.has("max_time") ? p.number("max_time") : 0.0;
  if (max_time_s_ > 0.0 && max_time_s_ < settled_time_s_)
    fail("max_time " + short_number(max_time_s_) + " s is below settled_time " + short_number(settled_time_s_) + " s");
  advance_ = p.boolean("advance");
  each_ = p.boolean("each");
}

void SteppedSineBlock::resolve(Facts& f) {
  const StreamFacts &u = f.in(input), &y = f.in(output);
  if (!u.known || !y.known) return;
  if (u.channels != 1) fail("input 'input' has " + std::to_string(u.channels) + " channels; one input is measured at a time");
  if (!u.rate.known()) fail("input 'input' has no sample rate");
  if (u.clock != y.clock)
    fail("inputs 'input' and 'output' have the clock domains '" + u.clock + "' and '" + y.clock +
         "'; a spectrum needs one clock");
  const auto outputs = static_cast<std::size_t>(y.channels);
  if (noise_given_ && rule_.noise.size() != 1 && rule_.noise.size() != outputs)
    fail("noise has " + std::to_string(rule_.noise.size()) + " values, allowed: 1, or one for each of the " +
         std::to_string(outputs) + " outputs");
  measurement_.rate = u.rate;
  measurement_.input = signals_of(u, "input");
  measurement_.outputs = signals_of(y, "output");
}

void SteppedSineBlock::advise(const Facts& f, Advice& a) {
  const auto settling = f.in(output).note("plant.settling_time");
  if (settling.empty() || !std::isfinite(settling[0])) return;
  if (max_time_s_ > 0.0 && max_time_s_ < settling[0]) {
    a.warn("the plant settles in " + short_number(settling[0]) + " s, max_time is " + short_number(max_time_s_) +
           " s: responses will be taken before that; raise max_time");
  } else if (settled_time_s_ < 0.2 * settling[0]) {
    a.tell("settled_time " + short_number(settled_time_s_) + " s is short of the plant's slowest time constant, " +
           short_number(0.2 * settling[0]) + " s: at high frequencies a slow transient may pass for settled; raise settled_time");
  }
}

void SteppedSineBlock::activate(const Activation&) {
  if (noise_given_) rule_.noise.resize(measurement_.outputs.names.size(), rule_.noise.front());
  sample_.resize(1 + measurement_.outputs.names.size());
  reset();
}

void SteppedSineBlock::reset() {
  if (!noise_given_) rule_.noise.clear();
  silence_.assign(sample_.size() - 1, {});
  measurement_.planned = 0;
  position_ = 0;
  begun_ = false;
  index_ = 0;
  line_ = {};
  dwell_.reset();
  lines_.clear();
}

void SteppedSineBlock::read_sample(Io& io, std::size_t n) {
  for (std::size_t s = 0; s < sample_.size(); ++s) {
    sample_[s] = s == 0 ? io.read(input)[n] : io.read(output, static_cast<int>(s - 1))[n];
    if (std::isfinite(sample_[s])) continue;
    fail((s == 0 ? "input '" + measurement_.input.names[0] : "output '" + measurement_.outputs.names[s - 1]) + "': sample " +
         std::to_string(position_) + " is " + (std::isnan(sample_[s]) ? "not a number" : "infinite"));
  }
  ++position_;
}

/// Running mean and sum of squares (Welford 1962).
void SteppedSineBlock::hear_silence() {
  for (std::size_t i = 0; i < silence_.size(); ++i) {
    Silence& s = silence_[i];
    const double off = sample_[i + 1] - s.mean;
    s.mean += off / static_cast<double>(position_);
    s.squares += off * (sample_[i + 1] - s.mean);
  }
}

/// The noise of the outputs, where it is needed and not given.
void SteppedSineBlock::settle_noise() {
  if (noise_given_ || rule_.kind != SettlingRule::Kind::envelope) return;
  if (position_ < kLeastSilence) {
    fail("the noise of the outputs is not known: give 'noise', or let the generator be silent for at least " +
         std::to_string(kLeastSilence) + " samples first; found: " + std::to_string(position_));
  }
  for (std::size_t i = 0; i < silence_.size(); ++i) {
    const double sigma = std::sqrt(silence_[i].squares / static_cast<double>(position_ - 1));
    if (!(sigma > 0.0) || !std::isfinite(sigma)) {
      fail("output '" + measurement_.outputs.names[i] +
           "' has no noise before the first frequency: without noise use settling: repeat");
    }
    rule_.noise.push_back(sigma);
    log_info("output '" + measurement_.outputs.names[i] + "': noise of " + short_number(sigma) + " from " +
             std::to_string(position_) + " samples before the first frequency");
  }
}

void SteppedSineBlock::begin(const RecordView& record) {
  const auto index = record.integer("index"), count = record.integer("count"), cycles = record.integer("cycles"),
             window = record.integer("window");
  const auto rate = record.number("sample_rate");
  if (record.type() != "frequency_step" || !index || !count || !cycles || !window || !rate) refuse(record);
  const Rate there = Rate::from_hz(*rate);
  if (!there.known() || *window < 3 || *window > kLongestWindow || *cycles < 1 || *cycles >= *window) refuse(record);
  const auto here = at_rate(*cycles, *window, there, measurement_.rate);
  line_ = {};
  line_.frequency_hz = static_cast<double>(*cycles) * there.hz() / static_cast<double>(*window);
  if (!here || here->samples <= 2 * here->cycles) {
    fail("frequency " + short_number(line_.frequency_hz) + " Hz has no whole window below half of the sample rate of " +
         short_number(measurement_.rate.hz()) + " Hz and " + std::to_string(kLongestWindow) + " samples");
  }
  if (!begun_) settle_noise();
  begun_ = true;
  index_ = *index;
  measurement_.planned = *count;
  line_.cycles = here->cycles;
  line_.window = here->samples;
  dwell_.emplace(line_.window, line_.cycles, silence_.size(), rule_);
}

void SteppedSineBlock::receive(int, const RecordView& record, Io& io) {
  if (dwell_) conclude(io, 0);  // the generator did not wait
  begin(record);
}

/// The frequency that is on has been measured, or its time is over.
bool SteppedSineBlock::is_over() const {
  if (!advance_) return false;
  const double rate = measurement_.rate.hz(), window_s = static_cast<double>(line_.window) / rate;
  if (max_time_s_ > 0.0 && static_cast<double>(dwell_->samples()) >= max_time_s_ * rate && dwell_->windows() >= 2) return true;
  const std::int64_t settled = dwell_->settled_windows();
  return settled >= windows_ && static_cast<double>(settled) * window_s >= settled_time_s_;
}

/// The response from the settled windows; where there are too few, from the last `windows`.
void SteppedSineBlock::conclude(Io& io, std::uint64_t offset) {
  const std::int64_t settled = dwell_->settled_windows();
  line_.settled = settled >= windows_;
  auto response = dwell_->estimate(line_.settled ? settled : windows_);
  if (!response) fail("frequency " + short_number(line_.frequency_hz) + " Hz: " + response.error().text);
  line_.response = std::move(*response);
  line_.settled_after_s = static_cast<double>(dwell_->settled_from()) / measurement_.rate.hz();
  line_.dwell_s = static_cast<double>(dwell_->samples()) / measurement_.rate.hz();
  dwell_.reset();
  lines_.push_back(std::move(line_));
  if (each_) io.emit(out, stepped_record(lines_, measurement_), offset);
}

void SteppedSineBlock::process(Io& io) {
  for (std::size_t n = 0; n < io.count(); ++n) {
    read_sample(io, n);
    if (!begun_) hear_silence();
    if (!dwell_ || !dwell_->push(sample_) || !is_over()) continue;
    conclude(io, n + 1);
    RecordBuilder record("frequency_step");
    record.set("index", index_);
    io.emit(step, record, n + 1);
  }
}

void SteppedSineBlock::finish(Io& io) {
  if (dwell_ && dwell_->windows() >= 2) conclude(io, 0);
  dwell_.reset();
  if (lines_.empty()) {
    fail(begun_ ? "no frequency was measured: the first had fewer than 2 whole windows"
                : "no frequency was measured: no record came on 'started'; connect it to generators.stepped_sine");
  }
  for (const std::string& warning : stepped_warnings(lines_, measurement_)) log_warning(warning);
  io.emit(out, stepped_record(lines_, measurement_), 0);
}

}  // namespace bodeflow::spectrum
