#include "averaging_dft_block.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "averaging_dft.hpp"
#include "excitation_advice.hpp"
#include "period_kernels.hpp"
#include "period_selection.hpp"
#include "records.hpp"
#include "response_checks.hpp"
#include "transient_removal.hpp"

namespace bodeflow::spectrum {

void AveragingDftBlock::describe(Describe& d) {
  d.id("spectrum.averaging_dft").summary("Measures a frequency response by averaging spectra over whole periods.").cost_ns(8);
  d.doc(
      "G = Y U^-1 of the mean spectra of one experiment an input, with the variance that the scatter between periods gives it "
      "(errors_in_variables: of dY - G dU, known_input: of dY; reference: G = S_yr S_ur^-1 for closed loops). With "
      "`realisations` of random "
      "phases the robust method: the best linear approximation, noise and nonlinear distortion apart. Spectra are scaled by 1/N. "
      "Assumes a "
      "periodic steady state: skip the transient, or have it removed. With one realisation, what repeats with the period, such "
      "as "
      "nonlinear distortion, is not in the variance: `levels` shows it where the excitation leaves lines out. A period that is "
      "not complete at "
      "the end is dropped and counted.");
  d.reference(
      "R. Pintelon, J. Schoukens, System Identification: A Frequency Domain Approach, 2nd ed., 2012, chapters 2 to 4 and 7, "
      "doi:10.1002/9781118287422");
  d.stream_in(input).doc("what excites the plant: one channel per input");
  d.stream_in(output).doc("what the plant answers: one channel per output");
  d.stream_in(reference).optional().doc(
      "what drives the loop from outside, without noise: as many channels as inputs. For form: reference; with the other forms "
      "it only tells which "
      "lines are excited");
  d.message_out(out).record_type("frequency_response").doc("the frequency response, at the end and after each `every` periods");
  d.message_out(levels)
      .record_type("spectral_levels")
      .doc("levels and noise at all lines of the band, excited or not, at the end");
  describe_averaging_dft_settings(d);
}

void AveragingDftBlock::configure(const Parameters& p) { settings_ = averaging_dft_settings(p); }

void AveragingDftBlock::check_signals(const Facts& f) const {
  const StreamFacts &u = f.in(input), &y = f.in(output), &r = f.in(reference);
  if (!u.rate.known()) fail("input 'input' has no sample rate");
  if (settings_.form == Form::reference && !r.known) fail("form: reference needs the input 'reference' connected");
  if (r.known && r.channels != u.channels) {
    fail("input 'reference' has " + std::to_string(r.channels) + " channels; needed: as many as 'input', " +
         std::to_string(u.channels));
  }
  for (const StreamFacts* s : {&y, &r}) {
    if (!s->known || s->clock == u.clock) continue;
    fail("inputs 'input' and '" + std::string(s == &y ? "output" : "reference") + "' have the clock domains '" + u.clock +
         "' and '" + s->clock + "'; a spectrum needs one clock");
  }
  if (schedule_.experiments < u.channels) {
    fail("experiments is " + std::to_string(schedule_.experiments) + "; needed: at least one for each of the " +
         std::to_string(u.channels) + " inputs");
  }
  const std::string fault = fault_of(schedule_);
  if (!fault.empty()) fail(fault);
  const std::int64_t needed = schedule_.needed();
  const std::string many = schedule_.periods > 0 ? std::to_string(schedule_.periods) : "2";
  const std::string each = schedule_.count() > 1 ? " in each of " + std::to_string(schedule_.count()) + " experiments" : "";
  for (const StreamFacts* s : {&u, &y, &r}) {
    if (!s->known || s->length < 0 || s->length >= needed) continue;
    fail("the " +
         std::string(s == &u   ? "input"
                     : s == &y ? "output"
                               : "reference") +
         " has " + std::to_string(s->length) + " samples; needed: at least " + std::to_string(needed) + " (" +
         std::to_string(schedule_.skip) + " skipped and " + many + " averaged periods of " + std::to_string(schedule_.period) +
         each + ")");
  }
}

void AveragingDftBlock::name_signals(const StreamFacts& facts, const char* port) {
  const Signals signals = signals_of(facts, port);
  measurement_.names.insert(measurement_.names.end(), signals.names.begin(), signals.names.end());
  measurement_.units.insert(measurement_.units.end(), signals.units.begin(), signals.units.end());
}

void AveragingDftBlock::resolve(Facts& f) {
  const StreamFacts &u = f.in(input), &y = f.in(output), &r = f.in(reference);
  if (!u.known || !y.known) return;
  schedule_ = settings_.schedule;
  if (schedule_.experiments == 0) schedule_.experiments = u.channels;
  check_signals(f);
  measurement_ = Measurement{};
  measurement_.form = settings_.form;
  measurement_.layout = {u.channels, y.channels, r.known ? r.channels : 0};
  measurement_.rate = u.rate;
  measurement_.period = schedule_.period;
  measurement_.confidence = settings_.confidence;
  name_signals(u, "input");
  name_signals(y, "output");
  if (r.known) name_signals(r, "reference");
  known_lines_ = excited_lines(r.known ? r : u, schedule_.period);
}

void AveragingDftBlock::advise(const Facts& f, Advice& a) {
  if (!f.in(input).known || !f.in(output).known) return;
  const Planned planned{schedule_, settings_.choice, settings_.form, settings_.remove_transient};
  const StreamFacts& from = f.in(reference).known ? f.in(reference) : f.in(input);
  for (const Remark& remark : measurement_advice(planned, from, f.in(input), f.in(output))) {
    remark.warning ? a.warn(remark.text) : a.tell(remark.text);
  }
}

void AveragingDftBlock::activate(const Activation& a) {
  vector_level_ = a.vector_level;
  const Layout& layout = measurement_.layout;
  const std::int64_t period = schedule_.period;
  frame_.resize(period, layout.signals());
  if (settings_.remove_transient) {
    collector_ = std::make_unique<TransientRemoval>(period, layout);
  } else if (settings_.outliers > 0.0) {
    collector_ = std::make_unique<PeriodSelection>(period, layout, settings_.outliers);
  } else {
    const auto detrend = settings_.detrend ? AveragingDft::Detrend::linear : AveragingDft::Detrend::none;
    collector_ = std::make_unique<AveragingDft>(period, layout, detrend, vector_level_);
  }
  reset();
}

void AveragingDftBlock::reset() {
  collector_->clear();
  parts_.clear();
  measurement_.input_amplitude.assign(static_cast<std::size_t>(measurement_.layout.inputs), 0.0);
  position_ = filled_ = 0;
  experiment_ = used_ = sent_ = 0;
}

std::span<const double> AveragingDftBlock::samples(Io& io, Eigen::Index signal) const {
  const auto c = static_cast<int>(signal), inputs = static_cast<int>(measurement_.layout.inputs),
             outputs = static_cast<int>(measurement_.layout.outputs);
  if (c < inputs) return io.read(input, c);
  return c < inputs + outputs ? io.read(output, c - inputs) : io.read(reference, c - inputs - outputs);
}

/// Fails with the first sample of signal `a` in this call that is not finite.
void AveragingDftBlock::refuse_sample(Io& io, Eigen::Index a) const {
  const auto x = samples(io, a);
  const auto bad = std::find_if(x.begin(), x.end(), [](double value) { return !std::isfinite(value); });
  const Layout& l = measurement_.layout;
  const std::string port = a < l.inputs ? "input" : a < l.inputs + l.outputs ? "output" : "reference";
  fail(port + " '" + measurement_.names[static_cast<std::size_t>(a)] + "': sample " +
       std::to_string(position_ + (bad - x.begin())) + " is " + (std::isnan(*bad) ? "not a number" : "infinite"));
}

/// Samples of this call, from `from` on, go to the frame as far as it has room; their number.
std::size_t AveragingDftBlock::copy(Io& io, std::size_t from) {
  const std::size_t count = std::min(io.count() - from, static_cast<std::size_t>(schedule_.period - filled_));
  for (Eigen::Index a = 0; a < frame_.cols(); ++a) {
    double* to = frame_.col(a).data() + filled_;
    if (!copy_finite(samples(io, a).data() + from, to, count, vector_level_)) refuse_sample(io, a);
  }
  filled_ += static_cast<std::int64_t>(count);
  return count;
}

void AveragingDftBlock::process(Io& io) {
  std::size_t n = 0;
  while (n < io.count() && experiment_ < schedule_.count()) {
    const std::int64_t waiting = schedule_.averaged_from(experiment_) - (position_ + static_cast<std::int64_t>(n));
    if (waiting > 0) {
      n += static_cast<std::size_t>(std::min(waiting, static_cast<std::int64_t>(io.count() - n)));
      continue;
    }
    n += copy(io, n);
    if (filled_ < schedule_.period) break;
    filled_ = 0;
    for (Eigen::Index j = 0; j < measurement_.layout.inputs; ++j) {
      double& largest = measurement_.input_amplitude[static_cast<std::size_t>(j)];
      largest = std::max(largest, frame_.col(j).cwiseAbs().maxCoeff());
    }
    collector_->add(frame_);
    used_ += schedule_.period;
    const std::int64_t periods = collector_->periods();
    if (periods == schedule_.periods) end_experiment();
    if (settings_.every > 0 && periods >= 2 && periods % settings_.every == 0) {
      measurement_.dropped_samples = position_ + static_cast<std::int64_t>(n) - used_;
      send(io, n, false);
    }
  }
  position_ += static_cast<std::int64_t>(io.count());
}

void AveragingDftBlock::end_experiment() {
  auto moments = collector_->moments();
  if (!moments) fail(moments.error().text);
  parts_.push_back(std::move(*moments));
  collector_->clear();
  ++experiment_;
}

void AveragingDftBlock::send(Io& io, std::uint64_t offset, bool last) {
  Measured measured{measurement_.layout, schedule_.period, schedule_.experiments, std::move(parts_)};
  parts_.clear();
  if (schedule_.periods == 0) {
    auto moments = collector_->moments();
    if (!moments) fail(moments.error().text);
    measured.parts.push_back(std::move(*moments));
  }
  const auto estimate = estimate_response(measured, settings_.choice, settings_.form);
  if (!estimate) fail(estimate.error().text);
  const std::vector<std::int64_t>& named = settings_.choice.candidates;
  std::vector<std::int64_t> driven;  // what the excitation says of itself, and what was found
  std::set_union(known_lines_.begin(), known_lines_.end(), estimate->lines.begin(), estimate->lines.end(),
                 std::back_inserter(driven));
  const Levels band = levels_of(measured, driven, named.empty() ? estimate->lines.front() : named.front(),
                                named.empty() ? estimate->lines.back() : named.back());
  measurement_.warnings =
      response_warnings({measured, *estimate, band, settings_.form, measurement_.line_hz(), measurement_.names, named.empty()});
  const std::int64_t periods = collector_->periods();
  if (!last || sent_ != periods || periods == 0 || filled_ > 0)
    io.emit(out, response_record(*estimate, band, measurement_), offset);
  sent_ = periods;
  if (!last) return;
  io.emit(levels, levels_record(band, *estimate, measurement_), offset);
  for (const std::string& warning : measurement_.warnings) log_warning(warning);
}

/// Fails where the data ended before the measurement did.
void AveragingDftBlock::require_complete() const {
  const std::int64_t periods = collector_->periods();
  if (schedule_.periods > 0) {
    if (experiment_ == schedule_.count()) return;
    fail("the data ended in " + name_of(schedule_, experiment_) + " after " + std::to_string(periods) + " of " +
         std::to_string(schedule_.periods) + " averaged periods; needed: " + std::to_string(schedule_.needed()) +
         " samples, found " + std::to_string(position_));
  }
  if (periods >= 2) return;
  const std::int64_t whole = std::max<std::int64_t>(0, position_ - schedule_.start(0)) / schedule_.period;
  fail(std::to_string(whole) + " whole periods of " + std::to_string(schedule_.period) + " samples, " +
       std::to_string(std::min(whole, schedule_.skip)) + " of them skipped; needed: at least 2 after " +
       std::to_string(schedule_.skip) + " skipped");
}

void AveragingDftBlock::finish(Io& io) {
  require_complete();
  if (filled_ > 0) log_info(std::to_string(filled_) + " samples at the end are no whole period and are dropped");
  measurement_.dropped_samples = position_ - used_;
  send(io, io.count(), true);
}

void AveragingDftBlock::deactivate() {
  collector_.reset();
  parts_.clear();
}

}  // namespace bodeflow::spectrum
