#include "welch_block.hpp"

#include <algorithm>
#include <cmath>

#include "welch_record.hpp"
#include "window.hpp"

namespace bodeflow::spectrum {
namespace {

constexpr std::int64_t kLongestSegment = 100'000'000;

Detrend detrend_of(const std::string& name) {
  return name == "none" ? Detrend::none : name == "mean" ? Detrend::mean : Detrend::linear;
}

WelchForm form_of(const std::string& name) { return name == "h1" ? WelchForm::h1 : name == "h2" ? WelchForm::h2 : WelchForm::hv; }

std::int64_t segments_in(std::int64_t samples, const WelchSettings& s) {
  return samples < s.segment ? 0 : 1 + (samples - s.segment) / s.hop;
}

}  // namespace

void WelchBlock::describe(Describe& d) {
  d.id("spectrum.welch")
      .summary("Measures a frequency response and its coherence from averaged spectra of windowed segments.")
      .cost_ns(60);
  d.doc(
      "For noise and other signals without a period. h1 = S_yu S_uu^-1 takes the outputs to be noisy, h2 = S_yy / S_uy the "
      "input, hv "
      "both in proportion to their power (the geometric mean of h1 and h2); several inputs: h1. The variance follows from the "
      "coherence, (1 - gamma^2)/gamma^2 |G|^2 / (M_e - inputs) for h1, where M_e is what the M overlapping segments are worth. "
      "Biased by "
      "noise "
      "on the input (h1: too small), by leakage where the plant's memory is not short beside a segment, and in a closed loop. "
      "With a periodic excitation spectrum.averaging_dft is free of leakage; with few data spectrum.local_polynomial leaks far "
      "less.");
  d.reference("J. S. Bendat, A. G. Piersol, Random Data, 4th ed., 2010, chapters 6, 7 and 9, doi:10.1002/9781118032428");
  d.reference(
      "P. D. Welch, The use of fast Fourier transform for the estimation of power spectra, 1967, doi:10.1109/TAU.1967.1161901");
  d.stream_in(input).doc("what excites the plant: one channel per input");
  d.stream_in(output).doc("what the plant answers: one channel per output");
  d.message_out(out).record_type("frequency_response").doc("the frequency response, at the end and after each `every` segments");
  d.required<std::int64_t>("segment").range(4, 1e8).doc("samples in a segment: lines are multiples of rate / segment");
  d.parameter("window", "hann").choices(window_names()).doc("what each segment is multiplied with");
  d.parameter("overlap", 0.5).unit("1").range(0.0, 0.95).doc("of a segment with the one before");
  d.parameter("detrend", "mean").choices({"none", "mean", "linear"}).doc("what is taken off each segment before");
  d.parameter("form", "h1").choices({"h1", "h2", "hv"}).doc("which signals are noisy: h1 outputs, h2 the input, hv both");
  d.parameter("band", std::vector<double>{})
      .unit("Hz")
      .range(0, 1e15)
      .doc("[from, to]: frequencies of the estimate, both included; default: all between zero and the Nyquist frequency");
  d.parameter("every", std::int64_t{0}).range(0, 1e9).doc("a record after each so many segments; 0: only one, at the end");
}

void WelchBlock::configure(const Parameters& p) {
  const std::int64_t segment = p.integer("segment");
  if (segment < 4 || segment > kLongestSegment) fail("segment " + std::to_string(segment) + "; allowed: 4 to 100000000");
  settings_.segment = segment;
  settings_.window = p.text("window");
  const auto& names = window_names();
  if (std::find(names.begin(), names.end(), settings_.window) == names.end()) fail("unknown window '" + settings_.window + "'");
  settings_.detrend = detrend_of(p.text("detrend"));
  const double overlap = p.number("overlap");
  settings_.hop = std::max<Eigen::Index>(1, std::llround(static_cast<double>(segment) * (1.0 - overlap)));
  form_ = form_of(p.text("form"));
  band_hz_ = p.numbers("band");
  every_ = p.integer("every");
}

void WelchBlock::resolve(Facts& f) {
  const StreamFacts &u = f.in(input), &y = f.in(output);
  if (!u.known || !y.known) return;
  if (form_ != WelchForm::h1 && u.channels != 1)
    fail("form " + name_of(form_) + " takes one input, 'input' has " + std::to_string(u.channels) + " channels; use h1");
  if (!u.rate.known()) fail("input 'input' has no sample rate");
  if (u.clock != y.clock)
    fail("inputs 'input' and 'output' have the clock domains '" + u.clock + "' and '" + y.clock +
         "'; a spectrum needs one clock");
  settings_.sample_rate_hz = u.rate.hz();
  const auto range = lines_in_band(band_hz_, settings_.sample_rate_hz, settings_.segment);
  if (!range) fail(range.error().text);
  range_ = *range;
  for (const StreamFacts* s : {&u, &y}) {
    if (s->length < 0 || segments_in(s->length, settings_) > u.channels) continue;
    fail("the " + std::string(s == &u ? "input" : "output") + " has " + counted(s->length, "sample") + ", " +
         counted(segments_in(s->length, settings_), "segment") + " of " + std::to_string(settings_.segment) +
         "; needed: more than " + std::to_string(u.channels) + ", one an input");
  }
  inputs_ = signals_of(u, "input");
  outputs_ = signals_of(y, "output");
}

void WelchBlock::advise(const Facts& f, Advice& a) {
  const StreamFacts &u = f.in(input), &y = f.in(output);
  if (!u.known || !y.known) return;
  const double rate = settings_.sample_rate_hz, segment_s = static_cast<double>(settings_.segment) / rate;
  const std::string resolution =
      "resolution " + short_number(resolution_hz(settings_)) + " Hz (lines each " + short_number(1.0 / segment_s) + " Hz)";
  if (u.length < 0) {
    a.tell(resolution + "; " + short_number(static_cast<double>(settings_.hop) / rate) + " s a segment");
  } else {
    const std::int64_t count = segments_in(u.length, settings_);
    const double worth = effective_averages(window(settings_.window, settings_.segment), settings_.hop, count);
    const double free = worth - static_cast<double>(u.channels);
    // Of |G|: half of the complex variance (1 - gamma^2) / gamma^2 / (M_e - inputs) at gamma^2 = 0.9.
    const double error = std::sqrt((1.0 - 0.9) / (2.0 * 0.9 * free));
    a.tell(counted(count, "segment") + " in " + short_number(static_cast<double>(u.length) / rate) + " s, worth " +
           short_number(std::round(worth)) + " averages; " + resolution + "; random error of |G| " +
           short_number(std::round(1000.0 * error) / 10.0) + " % at a coherence of 0.9");
    if (worth < 10.0)
      a.warn("few averages (" + short_number(std::round(10.0 * worth) / 10.0) + "): measure " +
             short_number(std::ceil(10.0 / worth)) + " times as long, or take shorter segments");
  }
  const auto period = u.note("excitation.period");
  if (!period.empty())
    a.warn("the excitation repeats each " + short_number(period[0]) +
           " s: spectrum.averaging_dft over whole periods has no leakage and needs no window");
  const auto settling = y.note("plant.settling_time");
  if (!settling.empty() && std::isfinite(settling[0]) && settling[0] > segment_s)
    a.warn("leakage: a segment lasts " + short_number(segment_s) + " s, the plant needs " + short_number(settling[0]) +
           " s to settle; take segments of " + short_number(std::ceil(2.0 * settling[0] * rate)) +
           " samples or more, or spectrum.local_polynomial");
}

void WelchBlock::activate(const Activation&) {
  const auto inputs = static_cast<Eigen::Index>(inputs_.names.size()), outputs = static_cast<Eigen::Index>(outputs_.names.size());
  frame_.resize(settings_.segment, inputs + outputs);
  welch_.emplace(settings_, inputs, outputs);
  reset();
}

void WelchBlock::reset() {
  welch_->clear();
  watches_.assign(static_cast<std::size_t>(frame_.cols()), {});
  warnings_.clear();
  filled_ = 0;
  taken_ = sent_ = 0;
}

std::string WelchBlock::channel(Eigen::Index c) const {
  const auto j = static_cast<std::size_t>(c), inputs = inputs_.names.size();
  return j < inputs ? "input '" + inputs_.names[j] + "'" : "output '" + outputs_.names[j - inputs] + "'";
}

/// Samples from .. from + count of this call go to the frame, behind what is there.
void WelchBlock::take(Io& io, std::size_t from, Eigen::Index count) {
  const auto inputs = static_cast<Eigen::Index>(inputs_.names.size());
  for (Eigen::Index c = 0; c < frame_.cols(); ++c) {
    const auto all = c < inputs ? io.read(input, static_cast<int>(c)) : io.read(output, static_cast<int>(c - inputs));
    const auto samples = all.subspan(from, static_cast<std::size_t>(count));
    const std::size_t finite = watches_[static_cast<std::size_t>(c)].add(samples);
    if (finite < samples.size())
      fail(channel(c) + ": sample " + std::to_string(taken_ + static_cast<std::int64_t>(finite)) + " is " +
           (std::isnan(samples[finite]) ? "not a number" : "infinite"));
    std::copy(samples.begin(), samples.end(), frame_.col(c).begin() + filled_);
  }
  filled_ += count;
  taken_ += count;
}

void WelchBlock::process(Io& io) {
  std::size_t n = 0;
  while (n < io.count()) {
    const Eigen::Index count = std::min(static_cast<Eigen::Index>(io.count() - n), settings_.segment - filled_);
    take(io, n, count);
    n += static_cast<std::size_t>(count);
    if (filled_ < settings_.segment) break;
    welch_->add(frame_);
    filled_ = settings_.segment - settings_.hop;
    for (Eigen::Index c = 0; c < frame_.cols(); ++c)
      std::copy(frame_.col(c).begin() + settings_.hop, frame_.col(c).end(), frame_.col(c).begin());
    if (every_ > 0 && welch_->averages() % every_ == 0 && welch_->degrees_of_freedom() > 0.0) send(io, n);
  }
}

void WelchBlock::send(Io& io, std::uint64_t offset) {
  WelchOrigin from{settings_, form_, inputs_, outputs_, {}, {}};
  for (std::size_t c = 0; c < watches_.size(); ++c) {
    const std::string name = channel(static_cast<Eigen::Index>(c));
    if (c < inputs_.names.size()) {
      if (watches_[c].constant()) fail(name + " is constant: it excites nothing");
      from.input_amplitude.push_back(watches_[c].amplitude());
    }
    if (std::string text = watches_[c].clipping(name); !text.empty()) from.warnings.push_back(std::move(text));
  }
  const auto estimate = welch_->estimate(form_, range_.first, range_.last);
  if (!estimate) fail(estimate.error().text);
  from.warnings = welch_warnings(*estimate, from);
  io.emit(out, welch_record(*estimate, from), offset);
  warnings_ = std::move(from.warnings);
  sent_ = welch_->averages();
}

void WelchBlock::finish(Io& io) {
  if (sent_ == 0 || sent_ != welch_->averages()) send(io, io.count());
  for (const std::string& warning : warnings_) log_warning(warning);
}

void WelchBlock::deactivate() { welch_.reset(); }

}  // namespace bodeflow::spectrum
