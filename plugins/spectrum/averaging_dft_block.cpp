#include "averaging_dft_block.hpp"

#include <algorithm>
#include <cmath>

namespace bodeflow::spectrum {
namespace {

// Where no line is named: -10 dB of the strongest line divides the lines of a flat multisine from what a drive or an amplifier
// adds between them.
constexpr double kDefaultThreshold = 0.3;
// A frame and four spectra of this length take some 10 GB.
constexpr std::int64_t kLongestPeriod = 100'000'000;

}  // namespace

void AveragingDftBlock::describe(Describe& d) {
  d.id("spectrum.averaging_dft").summary("Measures a frequency response by averaging spectra over whole periods.").cost_ns(40);
  d.doc(
      "G = Y/U of the mean spectra, with the variance that the scatter between periods gives it: errors_in_variables "
      "|G|^2 (var_y/|Y|^2 + var_u/|U|^2 - 2 Re(cov_yu/(Y conj U))), known_input var_y/|U|^2; variances and covariance are of the "
      "means, divisor P(P-1). Spectra are scaled by 1/N. Assumes a periodic steady state: skip the transient. What repeats with "
      "the "
      "period, such as nonlinear distortion, is not in the variance. Biased where the input stands less than 10 dB above its "
      "noise. "
      "A period that is not complete at the end is dropped and counted.");
  d.reference(
      "R. Pintelon, J. Schoukens, System Identification: A Frequency Domain Approach, 2nd ed., 2012, chapter 2, "
      "doi:10.1002/9781118287422");
  d.stream_in(input).doc("what excites the plant: one channel");
  d.stream_in(output).doc("what the plant answers: one channel per output");
  d.message_out(out).record_type("frequency_response").doc("the frequency response, at the end and after each `every` periods");
  d.required<std::int64_t>("period").range(3, 1e8).doc("samples in one period of the excitation");
  d.parameter("skip", std::int64_t{0}).range(0, 1e9).doc("periods at the start that are left out: the transient");
  d.parameter("form", "errors_in_variables")
      .choices({"errors_in_variables", "known_input"})
      .doc("errors_in_variables: input and output are measured; known_input: the input has no noise");
  d.parameter("every", std::int64_t{0}).range(0, 1e9).doc("a record after each so many periods; 0: only one, at the end");
  d.optional<std::int64_t>("lines.first").range(1, 1e8).doc("first line (multiple of rate / period); default 1");
  d.optional<std::int64_t>("lines.last")
      .range(1, 1e8)
      .doc("last line; default (period - 1) / 2, the last below the Nyquist frequency");
  d.parameter("lines.step", std::int64_t{1}).range(1, 1e8).doc("from line to line");
  d.parameter("lines.list", std::vector<std::int64_t>{})
      .range(1, 1e8)
      .doc("the lines one by one, rising, in place of first, last, step");
  d.optional<double>("lines.threshold")
      .unit("1")
      .range(0.0, 1.0)
      .doc(
          "keep only excited lines: mean input at least so many times its strongest line, and 10 dB above its variance; 0: keep "
          "all. "
          "Default: 0 where lines are named, else 0.3");
}

void AveragingDftBlock::configure(const Parameters& p) {
  period_ = p.integer("period");
  if (period_ < 3 || period_ > kLongestPeriod) fail("period " + std::to_string(period_) + "; allowed: 3 to 100000000");
  skip_ = p.integer("skip");
  every_ = p.integer("every");
  measurement_.form = p.text("form") == "known_input" ? Form::known_input : Form::errors_in_variables;
  configure_lines(p);
}

void AveragingDftBlock::configure_lines(const Parameters& p) {
  const std::int64_t highest = (period_ - 1) / 2;
  const bool ranged = p.has("lines.first") || p.has("lines.last") || p.given("lines.step");
  choice_.candidates = p.integers("lines.list");
  if (ranged && !choice_.candidates.empty()) fail("lines: give either list, or first, last and step");
  choice_.threshold = p.has("lines.threshold")                ? p.number("lines.threshold")
                      : ranged || !choice_.candidates.empty() ? 0.0
                                                              : kDefaultThreshold;
  if (ranged) {
    const std::int64_t first = p.has("lines.first") ? p.integer("lines.first") : 1;
    const std::int64_t last = p.has("lines.last") ? p.integer("lines.last") : highest;
    const std::int64_t step = p.integer("lines.step");
    if (first < 1 || step < 1) fail("lines: first and step are at least 1");
    if (first > last) fail("lines: first " + std::to_string(first) + " is above last " + std::to_string(last));
    if (last > highest) {
      fail("lines: last " + std::to_string(last) + " is at or above the Nyquist frequency; at most " + std::to_string(highest) +
           " with a period of " + std::to_string(period_));
    }
    for (std::int64_t k = first; k <= last; k += step) choice_.candidates.push_back(k);
  }
  for (std::size_t i = 0; i < choice_.candidates.size(); ++i) {
    const std::int64_t k = choice_.candidates[i];
    if (k > highest) {
      fail("lines: line " + std::to_string(k) + " is at or above the Nyquist frequency; at most " + std::to_string(highest) +
           " with a period of " + std::to_string(period_));
    }
    if (i > 0 && k <= choice_.candidates[i - 1]) {
      fail("lines: list does not rise: " + std::to_string(k) + " after " + std::to_string(choice_.candidates[i - 1]));
    }
  }
}

void AveragingDftBlock::name_signals(const StreamFacts& facts, const char* port) {
  for (std::size_t c = 0; c < static_cast<std::size_t>(facts.channels); ++c) {
    std::string name = c < facts.channel_names.size() ? facts.channel_names[c] : "";
    if (name.empty()) name = facts.channels == 1 ? port : std::string(port) + "_" + std::to_string(c + 1);
    measurement_.names.push_back(std::move(name));
    const bool own = c < facts.channel_units.size() && !facts.channel_units[c].empty();
    measurement_.units.push_back(own ? facts.channel_units[c] : facts.unit);
  }
}

void AveragingDftBlock::resolve(Facts& f) {
  const StreamFacts &u = f.in(input), &y = f.in(output);
  if (!u.known || !y.known) return;
  if (u.channels != 1) {
    fail("input 'input' has " + std::to_string(u.channels) + " channels; one input is measured at a time");
  }
  if (!u.rate.known()) fail("input 'input' has no sample rate");
  if (u.clock != y.clock) {
    fail("inputs 'input' and 'output' have the clock domains '" + u.clock + "' and '" + y.clock +
         "'; a spectrum needs one clock");
  }
  for (const StreamFacts* s : {&u, &y}) {
    if (s->length < 0 || s->length >= (skip_ + 2) * period_) continue;
    fail("the " + std::string(s == &u ? "input" : "output") + " has " + std::to_string(s->length) +
         " samples; needed: at least " + std::to_string((skip_ + 2) * period_) + " (" + std::to_string(skip_) +
         " skipped and 2 averaged periods of " + std::to_string(period_) + ")");
  }
  measurement_.rate = u.rate;
  measurement_.period = period_;
  measurement_.names.clear();
  measurement_.units.clear();
  name_signals(u, "input");
  name_signals(y, "output");
}

void AveragingDftBlock::activate(const Activation&) {
  const auto signals = static_cast<Eigen::Index>(measurement_.names.size());
  frame_.resize(period_, signals);
  average_.emplace(period_, signals - 1);
  reset();
}

void AveragingDftBlock::reset() {
  average_->clear();
  filled_ = 0;
  whole_ = sent_ = 0;
}

void AveragingDftBlock::check_finite(Eigen::Index channel, Eigen::Index from, Eigen::Index count) const {
  for (Eigen::Index n = from; n < from + count; ++n) {
    const double x = frame_(n, channel);
    if (std::isfinite(x)) continue;
    fail((channel == 0 ? "input '" : "output '") + measurement_.names[static_cast<std::size_t>(channel)] + "': sample " +
         std::to_string(whole_ * period_ + n) + " is " + (std::isnan(x) ? "not a number" : "infinite"));
  }
}

/// Samples from..from+count of this call go to the frame, behind what is there.
void AveragingDftBlock::copy(Io& io, std::size_t from, Eigen::Index count) {
  for (Eigen::Index c = 0; c < frame_.cols(); ++c) {
    const auto samples = c == 0 ? io.read(input) : io.read(output, static_cast<int>(c - 1));
    std::copy_n(samples.begin() + static_cast<std::ptrdiff_t>(from), count, frame_.col(c).begin() + filled_);
    check_finite(c, filled_, count);
  }
  filled_ += count;
}

void AveragingDftBlock::process(Io& io) {
  std::size_t n = 0;
  while (n < io.count()) {
    const Eigen::Index count = std::min(static_cast<Eigen::Index>(io.count() - n), period_ - filled_);
    copy(io, n, count);
    n += static_cast<std::size_t>(count);
    if (filled_ < period_) break;
    filled_ = 0;
    if (++whole_ <= skip_) continue;
    average_->add(frame_.col(0), frame_.rightCols(frame_.cols() - 1));
    if (every_ > 0 && average_->periods() >= 2 && average_->periods() % every_ == 0) send(io, n);
  }
}

void AveragingDftBlock::send(Io& io, std::uint64_t offset) {
  measurement_.dropped_samples = std::min(whole_, skip_) * period_ + filled_;
  const auto estimate = average_->estimate(choice_, measurement_.form);
  if (!estimate) fail(estimate.error().text);
  io.emit(out, response_record(*estimate, measurement_), offset);
  sent_ = average_->periods();
}

void AveragingDftBlock::finish(Io& io) {
  if (average_->periods() < 2) {
    fail(std::to_string(whole_) + " whole periods of " + std::to_string(period_) + " samples, " +
         std::to_string(std::min(whole_, skip_)) + " of them skipped; needed: at least 2 after " + std::to_string(skip_) +
         " skipped");
  }
  if (filled_ > 0) log_info(std::to_string(filled_) + " samples at the end are no whole period and are dropped");
  if (sent_ != average_->periods() || filled_ > 0) send(io, io.count());
}

void AveragingDftBlock::deactivate() { average_.reset(); }

}  // namespace bodeflow::spectrum
