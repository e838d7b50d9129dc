#include "averaging_dft_settings.hpp"

#include <string>

namespace bodeflow::spectrum {
namespace {

// Where no line is named: -10 dB of the strongest line divides the lines of a flat multisine from what a drive or an amplifier
// adds between them.
constexpr double kDefaultThreshold = 0.3;
// A frame and four spectra of this length take some 10 GB.
constexpr std::int64_t kLongestPeriod = 100'000'000;

Form form_of(const std::string& name) {
  if (name == "known_input") return Form::known_input;
  return name == "reference" ? Form::reference : Form::errors_in_variables;
}

void require_compatible(const AveragingDftSettings& s, bool starts_given) {
  const bool several = s.schedule.count() > 1 || starts_given;
  if (s.every > 0 && (several || s.schedule.periods > 0))
    fail("every: only where one experiment is averaged to the end of the stream");
  if (s.every > 0 && (s.outliers > 0.0 || s.remove_transient))
    fail("every: not with outliers or transient: remove, which need all periods at once");
  if (s.outliers > 0.0 && s.remove_transient)
    fail("outliers and transient: remove: one of the two; the transient is told from an unbroken record");
  if (s.outliers > 0.0 && s.detrend)
    fail("outliers and detrend: linear: one of the two; the drift is told from an unbroken record");
  if (s.remove_transient && s.detrend)
    fail("detrend: linear is part of transient: remove, which takes a drift off as well; give one of the two");
  if (s.remove_transient && s.schedule.periods == 1) fail("transient: remove needs at least 2 periods");
}

}  // namespace

void describe_lines(Describe& d) {
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

std::int64_t period_of(const Parameters& p) {
  const std::int64_t period = p.integer("period");
  if (period < 3 || period > kLongestPeriod) fail("period " + std::to_string(period) + "; allowed: 3 to 100000000");
  return period;
}

LineChoice line_choice(const Parameters& p, std::int64_t period) {
  const std::int64_t highest = (period - 1) / 2;
  const bool ranged = p.has("lines.first") || p.has("lines.last") || p.given("lines.step");
  LineChoice choice;
  choice.candidates = p.integers("lines.list");
  const bool listed = !choice.candidates.empty();
  if (p.given("lines.list") && !listed)
    fail("lines: list is empty; name one line or more, or leave it out: the excited lines then");
  if (ranged && listed) fail("lines: give either list, or first, last and step");
  choice.threshold = p.has("lines.threshold") ? p.number("lines.threshold") : ranged || listed ? 0.0 : kDefaultThreshold;
  if (ranged) {
    const std::int64_t first = p.has("lines.first") ? p.integer("lines.first") : 1;
    const std::int64_t last = p.has("lines.last") ? p.integer("lines.last") : highest;
    const std::int64_t step = p.integer("lines.step");
    if (first < 1 || step < 1) fail("lines: first and step are at least 1");
    if (first > last) fail("lines: first " + std::to_string(first) + " is above last " + std::to_string(last));
    if (last > highest) {
      fail("lines: last " + std::to_string(last) + " is at or above the Nyquist frequency; at most " + std::to_string(highest) +
           " with a period of " + std::to_string(period));
    }
    for (std::int64_t k = first; k <= last; k += step) choice.candidates.push_back(k);
  }
  for (std::size_t i = 0; i < choice.candidates.size(); ++i) {
    const std::int64_t k = choice.candidates[i];
    if (k > highest) {
      fail("lines: line " + std::to_string(k) + " is at or above the Nyquist frequency; at most " + std::to_string(highest) +
           " with a period of " + std::to_string(period));
    }
    if (k < 1 || (i > 0 && k <= choice.candidates[i - 1])) {
      fail("lines: list does not rise: " + std::to_string(k) + " after " + std::to_string(i > 0 ? choice.candidates[i - 1] : 0));
    }
  }
  return choice;
}

void describe_averaging_dft_settings(Describe& d) {
  d.required<std::int64_t>("period").range(3, 1e8).doc("samples in one period of the excitation");
  d.parameter("skip", std::int64_t{0})
      .range(0, 1e9)
      .doc("periods at the start of each experiment that are left out: the transient");
  d.optional<std::int64_t>("periods").range(1, 1e9).doc(
      "averaged periods of each experiment; needed for several experiments; default: all that come");
  d.parameter("realisations", std::int64_t{1})
      .range(1, 1e6)
      .doc(
          "experiments with other random phases, for the robust method: variance from their scatter, noise and nonlinear "
          "distortion apart");
  d.optional<std::int64_t>("experiments")
      .range(1, 1e6)
      .doc("experiments of each realisation, one after the other in the stream; default: as many as inputs");
  d.parameter("starts", std::vector<std::int64_t>{})
      .range(0, 9e15)
      .doc("samples where the experiments begin, counted from 0; default: each begins where the one before ends");
  d.parameter("form", "errors_in_variables")
      .choices({"errors_in_variables", "known_input", "reference"})
      .doc(
          "errors_in_variables: input and output are measured; known_input: the input has no noise; reference: from a signal "
          "that causes both");
  d.parameter("every", std::int64_t{0}).range(0, 1e9).doc("a record after each so many periods; 0: only one, at the end");
  d.parameter("confidence", 0.95).unit("1").above(0.0).below(1.0).doc("probability of the confidence circles");
  d.parameter("detrend", "mean")
      .choices({"none", "mean", "linear"})
      .doc(
          "linear: a drift common to all periods, by least squares over the means of the periods; mean: over whole periods it is "
          "line 0 "
          "and touches no other, so nothing needs to be done, as with none");
  d.parameter("outliers", 0.0)
      .unit("1")
      .range(0.0, 1e6)
      .doc(
          "leave out periods whose distance from the median of the periods is so many times the usual one, 3 for example; 0: "
          "none");
  d.parameter("transient", "skip")
      .choices({"skip", "remove"})
      .doc("skip: by `skip`; remove: fitted beside the lines of the whole record and taken off, so that no period is lost");
  describe_lines(d);
}

AveragingDftSettings averaging_dft_settings(const Parameters& p) {
  AveragingDftSettings s;
  s.schedule.period = period_of(p);
  s.schedule.skip = p.integer("skip");
  s.schedule.periods = p.has("periods") ? p.integer("periods") : 0;
  s.schedule.realisations = p.integer("realisations");
  s.schedule.experiments = p.has("experiments") ? p.integer("experiments") : 0;
  s.schedule.starts = p.integers("starts");
  s.form = form_of(p.text("form"));
  s.every = p.integer("every");
  s.confidence = p.number("confidence");
  s.detrend = p.text("detrend") == "linear";
  s.outliers = p.number("outliers");
  if (s.outliers > 0.0 && s.outliers <= 1.0)
    fail("outliers: periods up to the usual distance can't be left out; allowed: above 1, or 0");
  s.remove_transient = p.text("transient") == "remove";
  s.choice = line_choice(p, s.schedule.period);
  require_compatible(s, !s.schedule.starts.empty());
  return s;
}

}  // namespace bodeflow::spectrum
