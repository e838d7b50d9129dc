#include "response_checks.hpp"

#include <algorithm>
#include <array>
#include <bodeflow/numerics/confidence.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "records.hpp"
#include "repetition_checks.hpp"

namespace bodeflow::spectrum {
namespace {

constexpr double kLeastSnr = 10.0;         // power; below it G = Y/U is biased
constexpr double kSignificant = 5.0;       // standard deviations before a check speaks
constexpr double kTurnThatMatters = 1e-3;  // rad from first to last period at the highest line
constexpr double kBesideExcited = 0.05;    // of the excited level
constexpr double kTransient = 1.5;         // of the usual distance of a period, squared
constexpr double kWorstCondition = 20.0;   // 26 dB of noise amplification at worst
constexpr double kDistortionOverNoise = 3.0;
constexpr double kNearNyquist = 0.8;
constexpr double kAliased = 0.01;    // of the strongest line
constexpr double kDriven = 0.1;      // of the output's level, both beside their strongest lines
constexpr double kRounding = 1e-10;  // of the excited lines: what a transform leaves between them

std::string number(double x) { return short_number(x, 3); }

/// "3 of 24 lines (37 to 39 Hz ...": lines as a text.
std::string lines_text(const std::vector<std::int64_t>& bad, std::size_t all, double line_hz) {
  std::string text = std::to_string(bad.size()) + " of " + std::to_string(all) + " lines (" +
                     short_number(static_cast<double>(bad.front()) * line_hz);
  if (bad.size() > 1) text += " to " + short_number(static_cast<double>(bad.back()) * line_hz);
  return text + " Hz)";
}

Eigen::Index excitation_signal(const Judged& j) {
  return j.measured.layout.references > 0 ? j.measured.layout.inputs + j.measured.layout.outputs : 0;
}

void few_periods(const Judged& j, std::vector<std::string>& out) {
  const Estimate& e = j.estimate;
  const bool robust = e.realisations > 1;
  const std::int64_t count = robust ? e.realisations : e.periods;
  if (count < 4) {
    const double degrees = static_cast<double>(count - 1);
    const double wide = numerics::confidence_radius(1.0, degrees, 0.95) /
                        numerics::confidence_radius(1.0, std::numeric_limits<double>::infinity(), 0.95);
    out.push_back("only " + std::to_string(count) + (robust ? " realisations" : " periods") +
                  ": the variance is itself uncertain, and the 95 % region up to " + number(wide) +
                  " times as wide as with many; measure at least 4");
  }
  if (robust && !j.measured.has_noise()) {
    out.push_back(
        "one period a realisation: noise and nonlinear distortion can't be told apart; measure 2 or more periods of each");
  }
}

void left_out(const Judged& j, std::vector<std::string>& out) {
  std::string list;
  std::size_t count = 0;
  for (std::size_t part = 0; part < j.measured.parts.size(); ++part) {
    for (const std::int64_t p : j.measured.parts[part].left_out) {
      if (++count > 10) continue;
      list += (list.empty() ? "" : ", ") + std::to_string(p + 1);
      if (j.measured.parts.size() > 1) list += " of experiment " + std::to_string(part + 1);
    }
  }
  if (count == 0) return;
  out.push_back(std::to_string(count) + (count == 1 ? " period is" : " periods are") + " left out as outliers (averaged period " +
                list + (count > 10 ? ", ..." : "") + "): look for what disturbed them");
}

/// The signal that the response is divided by: the input, or the reference.
void weak_input(const Judged& j, std::vector<std::string>& out) {
  if (!j.measured.has_noise()) return;
  const Layout& l = j.measured.layout;
  const bool reference = j.form == Form::reference;
  const Eigen::Index first = reference ? l.inputs + l.outputs : 0, count = reference ? l.references : l.inputs;
  std::vector<std::int64_t> bad;
  double worst = std::numeric_limits<double>::infinity(), worst_hz = 0.0;
  for (const std::int64_t k : j.estimate.lines) {
    double snr = std::numeric_limits<double>::infinity();
    for (std::size_t m = 0; m < j.measured.realisations(); ++m) {
      // The best driven experiment counts: one at a time, the others are silent by design.
      for (Eigen::Index a = first; a < first + count; ++a) {
        double power = 0.0, variance = 0.0;
        for (Eigen::Index e = 0; e < j.measured.experiments; ++e) {
          power += std::norm(j.measured.part(m, e).mean(k, a));
          variance += j.measured.part(m, e).variance(k, a);
        }
        if (variance > 0.0) snr = std::min(snr, power / variance);
      }
    }
    if (snr >= kLeastSnr) continue;
    bad.push_back(k);
    if (snr < worst) worst = snr, worst_hz = static_cast<double>(k) * j.line_hz;
  }
  if (bad.empty()) return;
  out.push_back(std::string(reference ? "the reference" : "the input") + " stands less than 10 dB above its own noise at " +
                lines_text(bad, j.estimate.lines.size(), j.line_hz) + ", at worst " + number(10.0 * std::log10(worst)) +
                " dB at " + short_number(worst_hz) +
                " Hz: the response is biased there; put more amplitude on these lines, average more periods, or leave them out");
}

void wrong_period(const Judged& j, std::vector<std::string>& out) {
  const Eigen::Index signal = excitation_signal(j), period = j.measured.period;
  for (const Moments& m : j.measured.parts) {
    const PeriodError e = period_error(m, signal, j.estimate.lines, period);
    const double turn =
        2.0 * std::numbers::pi * static_cast<double>(j.estimate.lines.back()) * std::abs(e.samples) / static_cast<double>(period);
    if (!(std::abs(e.samples) > kSignificant * e.deviation) || turn * static_cast<double>(m.periods) < kTurnThatMatters) continue;
    out.push_back("successive periods turn against each other, by up to " + number(turn) + " rad: the true period is " +
                  number(std::abs(e.samples)) + " samples " + (e.samples > 0.0 ? "longer" : "shorter") + " than " +
                  std::to_string(period) +
                  "; give the period of the excitation, or let generator and acquisition share one clock");
    return;
  }
}

void beside_excited(const Judged& j, std::vector<std::string>& out) {
  const Levels& l = j.levels;
  if (l.input_noise.size() == 0) return;
  double beside = 0.0, noise = 0.0, excited = 0.0, count = 0.0, excited_count = 0.0;
  for (std::size_t i = 0; i < l.kind.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    if (l.kind[i] == Levels::excited) {
      excited += l.input_level.row(row).squaredNorm(), excited_count += 1.0;
    } else if ((i > 0 && l.kind[i - 1] == Levels::excited) || (i + 1 < l.kind.size() && l.kind[i + 1] == Levels::excited)) {
      beside += l.input_level.row(row).squaredNorm(), noise += l.input_noise.row(row).squaredNorm(), count += 1.0;
    }
  }
  if (count == 0.0 || excited_count == 0.0) return;
  const double ratio = std::sqrt(beside / count / (excited / excited_count));
  if (ratio < kBesideExcited || beside < kLeastSnr * noise) return;
  out.push_back(
      "the input has " + number(100.0 * ratio) +
      " % of the excited level on the lines beside the excited ones: a wrong period or a transient leaks, or the actuator "
      "distorts; check the period, skip more periods, or use a reference");
}

void constant_output(const Judged& j, std::vector<std::string>& out) {
  for (Eigen::Index i = 0; i < j.measured.layout.outputs; ++i) {
    const Eigen::Index a = j.measured.layout.inputs + i;
    const bool changes = std::any_of(j.measured.parts.begin(), j.measured.parts.end(), [&](const Moments& m) {
      return m.mean.col(a).tail(m.mean.rows() - 1).cwiseAbs2().maxCoeff() > 0.0;
    });
    if (changes) continue;
    out.push_back("output '" + j.names[static_cast<std::size_t>(a)] +
                  "' is constant: its response and variance are zero; is it connected, and is it the right channel?");
  }
}

/// Level of a signal between two lines beside its strongest line, noise taken off.
double level_between(const Moments& m, Eigen::Index signal, Eigen::Index from, Eigen::Index to,
                     const std::vector<std::int64_t>& lines) {
  double largest = 0.0;
  for (const std::int64_t k : lines) largest = std::max(largest, std::norm(m.mean(k, signal)));
  const double power =
      (m.mean.col(signal).segment(from, to - from + 1).cwiseAbs2() - m.variance.col(signal).segment(from, to - from + 1)).sum();
  return largest > 0.0 ? std::sqrt(std::max(0.0, power) / static_cast<double>(to - from + 1) / largest) : 0.0;
}

void aliasing(const Judged& j, std::vector<std::string>& out) {
  const double nyquist = 0.5 * static_cast<double>(j.measured.period);
  const auto last = static_cast<double>(j.estimate.lines.back());
  if (last > kNearNyquist * nyquist) {
    out.push_back("lines up to " + short_number(last * j.line_hz) + " Hz are excited, above 0.8 of the Nyquist frequency (" +
                  short_number(nyquist * j.line_hz) +
                  " Hz): what lies above it folds back there; use an anti-alias filter and a higher sample rate");
    return;
  }
  const auto from = static_cast<Eigen::Index>(std::ceil(0.9 * nyquist)), to = (j.measured.period - 1) / 2;
  if (to - from < 2) return;
  for (Eigen::Index i = 0; i < j.measured.layout.outputs; ++i) {
    const Eigen::Index a = j.measured.layout.inputs + i;
    for (const Moments& m : j.measured.parts) {
      if (!m.has_noise()) continue;
      const double power = m.mean.col(a).segment(from, to - from + 1).squaredNorm();
      const double noise = m.variance.col(a).segment(from, to - from + 1).sum();
      const double level = level_between(m, a, from, to, j.estimate.lines);
      if (level < kAliased || power < kLeastSnr * noise) continue;
      double driven = 0.0;  // by what the input has there
      for (Eigen::Index b = 0; b < j.measured.layout.inputs; ++b)
        driven = std::max(driven, level_between(m, b, from, to, j.estimate.lines));
      if (driven > kDriven * level) continue;
      out.push_back(
          "output '" + j.names[static_cast<std::size_t>(a)] + "' repeats " + number(100.0 * level) +
          " % of its strongest line right below the Nyquist frequency, where nothing is excited: it is probably aliased; use an "
          "anti-alias filter or a higher sample rate");
      return;
    }
  }
}

void transient(const Judged& j, std::vector<std::string>& out) {
  const auto lines = static_cast<double>(j.estimate.lines.size());
  for (const Moments& m : j.measured.parts) {
    for (Eigen::Index a = 0; a < j.measured.layout.inputs + j.measured.layout.outputs; ++a) {
      const EndPeriods ends = end_periods(m, a, j.estimate.lines);
      const double deviation = std::sqrt(1.0 / lines);  // of either, at most
      if (ends.first < kTransient * std::max(1.0, ends.last) || ends.first < 1.0 + kSignificant * deviation) continue;
      out.push_back("the first averaged period of '" + j.names[static_cast<std::size_t>(a)] + "' differs from the others by " +
                    number(std::sqrt(ends.first)) +
                    " times their scatter: the transient is not over; skip more periods, or set transient: remove");
      return;
    }
  }
}

void condition(const Judged& j, std::vector<std::string>& out) {
  std::vector<std::int64_t> bad;
  for (std::size_t i = 0; i < j.estimate.lines.size(); ++i) {
    if (j.estimate.condition[static_cast<Eigen::Index>(i)] > kWorstCondition) bad.push_back(j.estimate.lines[i]);
  }
  if (bad.empty()) return;
  out.push_back("the experiments hardly tell the inputs apart at " + lines_text(bad, j.estimate.lines.size(), j.line_hz) +
                ": condition number up to " + number(j.estimate.condition.maxCoeff()) +
                ", which multiplies the noise; use orthogonal excitations");
}

void distortion(const Judged& j, std::vector<std::string>& out) {
  const Estimate& e = j.estimate;
  if (e.nonlinear_variance.size() > 0) {
    const double nonlinear = e.nonlinear_variance.sum() / static_cast<double>(e.realisations), noise = e.noise_variance.sum();
    const double response = e.response.squaredNorm();
    if (!(nonlinear > kRounding * kRounding * response)) return;
    if (!(noise > kRounding * kRounding * response)) {
      out.push_back("stochastic nonlinear distortion is " + number(100.0 * std::sqrt(nonlinear / response)) +
                    " % of the response in the mean of the realisations, and there is no noise: measure more realisations, or "
                    "with another amplitude");
    } else if (nonlinear > kDistortionOverNoise * kDistortionOverNoise * noise) {
      out.push_back("stochastic nonlinear distortion is " + number(std::sqrt(nonlinear / noise)) +
                    " times the noise: more periods won't help; measure more realisations, or with another amplitude");
    }
    return;
  }
  if (j.levels.output_noise.size() == 0) return;
  const KindLevel odd = rms_of(j.levels, Levels::odd), even = rms_of(j.levels, Levels::even);
  const Eigen::VectorXd noise = rms_noise(j.levels), excited = rms_of(j.levels, Levels::excited).level;
  for (Eigen::Index i = 0; i < noise.size(); ++i) {
    if (!(noise[i] > 0.0)) continue;
    const double odd_ratio = odd.lines > 0 ? odd.level[i] / noise[i] : 0.0,
                 even_ratio = even.lines > 0 ? even.level[i] / noise[i] : 0.0;
    if (!(std::max(odd_ratio, even_ratio) > kDistortionOverNoise)) continue;
    if (!(std::max(odd_ratio, even_ratio) * noise[i] > kRounding * excited[i])) continue;
    std::string what;
    if (odd_ratio > kDistortionOverNoise) what += "odd " + number(odd_ratio);
    if (even_ratio > kDistortionOverNoise) what += (what.empty() ? "even " : " and even ") + number(even_ratio);
    out.push_back(
        "output '" + j.names[static_cast<std::size_t>(j.measured.layout.inputs + i)] + "': distortion at unexcited lines is " +
        what +
        " times the noise, and not in the variance; measure several realisations (realisations: 7), or with another amplitude");
  }
}

}  // namespace

PeriodError period_error(const Moments& m, Eigen::Index signal, const std::vector<std::int64_t>& lines, Eigen::Index period) {
  PeriodError none{0.0, std::numeric_limits<double>::infinity()};
  if (m.periods < 2 || m.second.size() == 0 || lines.size() < 3 || !m.left_out.empty()) return none;
  // Angle of each line per period: from the first two, then refined over all, where the first guess tells the whole turns.
  const auto fit = [&](const Eigen::MatrixXcd& later, double periods, double guess) {
    double above = 0.0, below = 0.0;
    std::vector<double> angles;
    for (const std::int64_t k : lines) {
      const std::complex<double> turned =
          later(k, signal) * std::conj(m.first(k, signal)) * std::polar(1.0, -guess * static_cast<double>(k) * periods);
      angles.push_back(std::arg(turned) / periods + guess * static_cast<double>(k));
      above += static_cast<double>(k) * angles.back();
      below += static_cast<double>(k) * static_cast<double>(k);
    }
    const double slope = above / below;
    double rest = 0.0;
    for (std::size_t i = 0; i < lines.size(); ++i) rest += std::pow(angles[i] - slope * static_cast<double>(lines[i]), 2);
    return std::array{slope, std::sqrt(rest / static_cast<double>(lines.size() - 1) / below)};
  };
  auto found = fit(m.second, 1.0, 0.0);
  const auto all = static_cast<double>(m.periods - 1);
  if (m.periods > 2 && found[1] * all * static_cast<double>(lines.back()) < 0.5) found = fit(m.last, all, found[0]);
  // X_(p+1) = X_p exp(-2 pi i k d / (N + d)): a period longer by d samples arrives late.
  const double samples = -found[0] * static_cast<double>(period) / (2.0 * std::numbers::pi);
  return {samples, found[1] * static_cast<double>(period) / (2.0 * std::numbers::pi)};
}

EndPeriods end_periods(const Moments& m, Eigen::Index signal, const std::vector<std::int64_t>& lines) {
  EndPeriods ends;
  if (m.periods < 3 || m.last.size() == 0 || !m.left_out.empty()) return ends;
  const auto count = static_cast<double>(m.periods);
  double used = 0.0;
  for (const std::int64_t k : lines) {
    const double usual = m.variance(k, signal) * (count - 1.0);  // s^2 (P - 1) / P
    // Alike to rounding: the transform itself scatters.
    if (!(usual > 1e-28 * std::norm(m.mean(k, signal)))) continue;
    ends.first += std::norm(m.first(k, signal) - m.mean(k, signal)) / usual;
    ends.last += std::norm(m.last(k, signal) - m.mean(k, signal)) / usual;
    used += 1.0;
  }
  if (used > 0.0) ends.first /= used, ends.last /= used;
  return ends;
}

std::vector<std::string> response_warnings(const Judged& judged) {
  std::vector<std::string> out;
  const auto run = [&](std::initializer_list<void (*)(const Judged&, std::vector<std::string>&)> checks) {
    for (const auto check : checks) check(judged, out);
  };
  run({few_periods, left_out, weak_input, wrong_period, unrepeated, beside_excited});
  const std::size_t before = out.size();
  drift(judged, out);
  const bool drifts = out.size() > before;
  run({constant_output});
  if (!drifts) aliasing(judged, out);
  run({transient, condition, same_phases});
  if (!drifts) distortion(judged, out);
  return out;
}

}  // namespace bodeflow::spectrum
