#include "excitation_advice.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "records.hpp"
#include "response_record.hpp"

namespace bodeflow::spectrum {
namespace {

// A settled transient is e^-5 of its start, see the note plant.settling_time.
constexpr double kNearNyquist = 0.8;
constexpr double kHighCrest = 3.5;
// Periods and frequencies in notes are quotients of doubles.
constexpr double kEqual = 1e-6;

std::string number(double x) { return short_number(x, 4); }

class Adviser {
 public:
  Adviser(const Planned& planned, const StreamFacts& excitation, const StreamFacts& input, const StreamFacts& output)
      : p_(planned), excitation_(excitation), input_(input), output_(output), rate_(input.rate.hz()) {
    const Schedule& s = p_.schedule;
    line_hz_ = rate_ / static_cast<double>(s.period);
    periods_ = s.periods;
    if (periods_ == 0 && input_.length >= 0)
      periods_ = std::max<std::int64_t>(0, (input_.length - s.averaged_from(0)) / s.period);
    frequencies_ = excitation_.note("excitation.frequencies");
  }

  std::vector<Remark> all() {
    duration();
    period();
    experiment();
    band();
    lines_asked_for();
    modes();
    settling();
    crest();
    expected_deviation();
    return std::move(remarks_);
  }

 private:
  void tell(std::string text) { remarks_.push_back({false, std::move(text)}); }
  void warn(std::string text) { remarks_.push_back({true, std::move(text)}); }
  std::string seconds(double samples) const { return number(samples / rate_) + " s"; }

  void duration() {
    const Schedule& s = p_.schedule;
    const auto N = static_cast<double>(s.period);
    std::string text = std::to_string(s.period) + " samples a period, lines " + number(line_hz_) + " Hz apart; ";
    if (periods_ == 0) {
      tell(text + "2 averaged periods are reached after " + seconds(static_cast<double>(s.needed())) + " at the earliest");
      return;
    }
    const std::int64_t needed = s.averaged_from(s.count() - 1) + periods_ * s.period;
    text += std::to_string(periods_) + " averaged periods" +
            (s.count() > 1 ? " in each of " + std::to_string(s.count()) + " experiments" : "") + ", " + std::to_string(s.skip) +
            " skipped" + (s.count() > 1 ? " in each" : "") + ": " + seconds(static_cast<double>(needed));
    tell(text);
    const std::int64_t rest = input_.length - needed;
    if (input_.length >= 0 && rest > 0) {
      tell("the last " + std::to_string(rest) + " samples (" + number(static_cast<double>(rest) / N) + " periods) are not used");
    }
    if (periods_ < 4 && s.realisations == 1) {
      warn("fewer than 4 averaged periods give a variance that is itself uncertain; measure at least 4");
    }
    if (s.realisations > 1 && s.realisations < 4) {
      warn("fewer than 4 realisations give a variance that is itself uncertain; measure at least 4");
    }
  }

  void period() {
    const std::vector<double> note = excitation_.note("excitation.period");
    if (note.empty()) return;
    const double samples = note.front() * rate_, N = static_cast<double>(p_.schedule.period), ratio = N / samples;
    if (!(samples > 0.0)) return;
    if (std::abs(ratio - std::round(ratio)) > kEqual * ratio || ratio < 0.5) {
      warn("the excitation repeats after " + number(samples) + " samples, and the period is " +
           std::to_string(p_.schedule.period) + ": the spectra will leak; set period to " + number(samples) +
           " or a multiple of it");
    } else if (std::round(ratio) > 1.0) {
      tell("the period holds " + number(std::round(ratio)) + " periods of the excitation: lines between its own are not excited");
    }
  }

  void experiment() {
    const std::vector<double> note = excitation_.note("excitation.experiment");
    const Schedule& s = p_.schedule;
    if (note.empty() && s.realisations > 1 && !excitation_.note("excitation.period").empty()) {
      warn(
          "the excitation is the same in all realisations, so that nonlinear distortion repeats and is not in the variance: give "
          "each "
          "phases of its own (phases: random, experiment_periods and realisations of the generator)");
    }
    if (note.empty() || !s.starts.empty() || periods_ == 0) return;
    const double samples = note.front() * rate_;
    const auto taken = static_cast<double>((s.skip + periods_) * s.period);
    if (std::abs(taken - samples) <= kEqual * samples) return;
    warn("the phases of the excitation change after each " + number(samples) + " samples, and an experiment is taken to be " +
         number(taken) + " (skip and periods): set periods to " +
         number(std::round(samples / static_cast<double>(s.period)) - static_cast<double>(s.skip)) +
         ", experiments and realisations as the excitation has them");
  }

  void band() {
    const double nyquist = 0.5 * rate_;
    if (frequencies_.empty()) return;
    const double low = frequencies_.front(), high = frequencies_.back();
    const std::string text = "excited: " + std::to_string(frequencies_.size()) + " lines from " + number(low) + " to " +
                             number(high) + " Hz, up to " + number(high / nyquist) + " of the Nyquist frequency (" +
                             number(nyquist) + " Hz)";
    if (high > kNearNyquist * nyquist) {
      warn(text + ": what lies above it folds back on the highest lines; use an anti-alias filter and a higher sample rate");
    } else {
      tell(text);
    }
  }

  void lines_asked_for() {
    if (frequencies_.empty() || p_.choice.candidates.empty() || p_.choice.threshold > 0.0) return;
    std::int64_t silent = 0, example = 0;
    for (const std::int64_t k : p_.choice.candidates) {
      const double f = static_cast<double>(k) * line_hz_;
      const auto near = std::lower_bound(frequencies_.begin(), frequencies_.end(), f - 1e-3 * line_hz_);
      if (near != frequencies_.end() && *near < f + 1e-3 * line_hz_) continue;
      if (silent++ == 0) example = k;
    }
    if (silent == 0) return;
    warn(std::to_string(silent) + " of the " + std::to_string(p_.choice.candidates.size()) +
         " lines asked for are not excited (line " + std::to_string(example) + " at " +
         number(static_cast<double>(example) * line_hz_) +
         " Hz first): name the excited lines, or set lines.threshold to keep those alone");
  }

  void modes() {
    if (frequencies_.empty()) return;
    for (const double mode : output_.note("plant.modes")) {
      if (mode >= frequencies_.front() && mode <= frequencies_.back()) continue;
      tell("the plant's mode at " + number(mode) + " Hz lies outside the excited band");
    }
  }

  void settling() {
    const std::vector<double> note = output_.note("plant.settling_time");
    if (note.empty() || p_.remove_transient) return;
    if (!std::isfinite(note.front())) {
      tell(
          "the plant has a pole that does not decay: the offset that an integrator keeps does no harm, against its drift set "
          "detrend: linear; an unstable plant needs a loop around it");
      return;
    }
    const double skipped = static_cast<double>(p_.schedule.skip * p_.schedule.period);
    const double samples = note.front() * rate_;
    if (skipped >= samples) return;
    warn("the plant settles in " + number(note.front()) + " s, and " + seconds(skipped) + " are skipped: set skip to " +
         number(std::ceil(samples / static_cast<double>(p_.schedule.period))) + ", or transient: remove");
  }

  void crest() {
    const std::vector<double> note = excitation_.note("excitation.crest_factor");
    if (note.empty()) return;
    const std::string text = "crest factor of the excitation: " + number(note.front());
    tell(note.front() > kHighCrest ? text + "; optimised phases put more power into the same peak" : text);
  }

  void expected_deviation() {
    const std::vector<double> frequencies = input_.note("excitation.frequencies");
    std::vector<double> amplitudes = input_.note("excitation.amplitudes");
    if (amplitudes.empty() || amplitudes.size() != frequencies.size() || periods_ == 0) return;
    std::sort(amplitudes.begin(), amplitudes.end());
    const double amplitude = amplitudes[amplitudes.size() / 2];
    if (!(amplitude > 0.0)) return;
    const auto samples =
        static_cast<double>(p_.schedule.period) * static_cast<double>(periods_) * static_cast<double>(p_.schedule.count());
    const std::vector<double> known = output_.note("noise.std"), input_noise = input_.note("noise.std");
    const double noise = known.empty() ? 1.0 : known.front();
    const double of_magnitude = std::numbers::sqrt2 / (amplitude * std::sqrt(samples));  // half of E|dG|^2 is along G
    const std::string unit = ratio_unit(output_.unit, input_.unit);
    std::string text = "expected std of |G|: " + number(of_magnitude * noise) + (unit.empty() || unit == "1" ? "" : " " + unit);
    text += known.empty() ? " per unit of white noise on the output" : " from the white noise of the output";
    if (!input_noise.empty() && input_noise.front() > 0.0) {
      text += ", with " + number(of_magnitude * input_noise.front()) + " |G| from that of the input in quadrature";
    }
    text += ", at lines of median amplitude " + number(amplitude) +
            (p_.schedule.experiments > 1 ? " of orthogonal experiments" : "") + "; 4 times the periods would halve it, in " +
            seconds(static_cast<double>(p_.schedule.count() * (p_.schedule.skip + 4 * periods_) * p_.schedule.period));
    tell(text);
  }

  const Planned& p_;
  const StreamFacts &excitation_, &input_, &output_;
  double rate_ = 1.0, line_hz_ = 1.0;
  std::int64_t periods_ = 0;  // averaged ones of an experiment; 0: unknown
  std::vector<double> frequencies_;
  std::vector<Remark> remarks_;
};

}  // namespace

std::vector<std::int64_t> excited_lines(const StreamFacts& excitation, std::int64_t period) {
  std::vector<std::int64_t> lines;
  if (!excitation.rate.known()) return lines;
  for (const double f : excitation.note("excitation.frequencies")) {
    const double k = f / excitation.rate.hz() * static_cast<double>(period);
    if (k > 0.5 && k < 0.5 * static_cast<double>(period) && std::abs(k - std::round(k)) < 1e-3) lines.push_back(std::llround(k));
  }
  std::sort(lines.begin(), lines.end());
  lines.erase(std::unique(lines.begin(), lines.end()), lines.end());
  return lines;
}

std::vector<Remark> measurement_advice(const Planned& planned, const StreamFacts& excitation, const StreamFacts& input,
                                       const StreamFacts& output) {
  return Adviser(planned, excitation, input, output).all();
}

}  // namespace bodeflow::spectrum
