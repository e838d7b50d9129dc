#include "repetition_checks.hpp"

#include <algorithm>
#include <bodeflow/numerics/confidence.hpp>
#include <cmath>
#include <complex>
#include <numbers>

#include "line_response.hpp"
#include "lines.hpp"
#include "records.hpp"

namespace bodeflow::spectrum {
namespace {

constexpr double kSamePhases = 0.01;  // of the power; random phases differ by twice the power
constexpr double kNoise = 4.0;        // times what noise explains on average, summed over lines
constexpr std::size_t kLinesToCompare = 3;
constexpr double kCarries = 0.01;       // of the power of the strongest line
constexpr double kScatter = 0.1;        // of the power of single periods
constexpr double kMostlyScatter = 0.5;  // the same, where no floor of noise is seen
constexpr double kOverFloor = 10.0;     // power
constexpr std::size_t kLinesOfFloor = 10;
constexpr double kSignificant = 5.0;  // standard deviations
constexpr double kByChance = 0.01;
constexpr double kShareOfRadius = 0.5;
constexpr std::size_t kLowestLines = 3;
constexpr double kRounding = 1e-10;  // of the signal

std::string number(double x) { return short_number(x, 3); }

/// Do two realisations have the same excitation at these lines?
bool alike(const Judged& j, std::size_t one, std::size_t other) {
  const Layout& l = j.measured.layout;
  const Eigen::Index first = l.references > 0 ? l.inputs + l.outputs : 0, count = l.references > 0 ? l.references : l.inputs;
  double difference = 0.0, noise = 0.0, power = 0.0;
  for (Eigen::Index e = 0; e < j.measured.experiments; ++e) {
    const Moments &a = j.measured.part(one, e), &b = j.measured.part(other, e);
    for (const std::int64_t k : j.estimate.lines) {
      for (Eigen::Index s = first; s < first + count; ++s) {
        difference += std::norm(a.mean(k, s) - b.mean(k, s));
        power += 0.5 * (std::norm(a.mean(k, s)) + std::norm(b.mean(k, s)));
        if (a.has_noise()) noise += a.variance(k, s);
        if (b.has_noise()) noise += b.variance(k, s);
      }
    }
  }
  return difference < kSamePhases * power + std::min(kNoise * noise, 0.5 * power);
}

/// The trend of a signal over the periods, from all experiments.
struct Trend {
  double slope = 0.0;      // from one period to the next
  double variance = 0.0;   // of a mean of one period, from the scatter around the trend
  double degrees = 0.0;    // of that variance
  double precision = 0.0;  // 1 / variance of `slope`, for a variance of 1
};

Trend trend_of(const Measured& measured, Eigen::Index signal) {
  Trend t;
  double rest = 0.0, slopes = 0.0;
  for (const Moments& m : measured.parts) {
    if (m.trend.size() == 0) return {};
    const auto count = static_cast<double>(m.periods);
    const double spread = count * (count * count - 1.0) / 12.0;
    slopes += spread * m.trend[signal];
    t.precision += spread;
    t.degrees += count - 2.0;
    rest += m.trend_residual[signal];
  }
  t.slope = slopes / t.precision;
  t.variance = t.degrees > 0.0 ? rest / t.degrees : 0.0;
  return t;
}

bool significant(const Trend& t, double variance_at_lines) {
  if (!(t.degrees > 0.0)) return false;
  const double explained = t.slope * t.slope * t.precision;
  if (!(explained > kSignificant * kSignificant * std::max(t.variance, variance_at_lines))) return false;
  const double x = t.variance * t.degrees / (t.variance * t.degrees + explained), half = 0.5 * t.degrees;
  return std::pow(x, half) / (half * std::beta(half, 0.5) * std::sqrt(1.0 - x)) < kByChance;
}

/// What a drift of one unit a period of a signal adds to the response at a line: entries as in Estimate::response.
Eigen::RowVectorXcd bias_of_drift(const Judged& j, Eigen::Index signal, Eigen::Index row) {
  const Layout& l = j.measured.layout;
  const std::int64_t k = j.estimate.lines[static_cast<std::size_t>(row)];
  const auto samples = static_cast<double>(j.measured.period);
  const std::complex<double> ramp =
      1.0 / samples / (std::polar(1.0, -2.0 * std::numbers::pi * static_cast<double>(k) / samples) - 1.0);
  Eigen::RowVectorXcd weights = Eigen::RowVectorXcd::Zero(l.inputs);
  for (std::size_t m = 0; m < j.measured.realisations(); ++m) {
    const auto at = line_response(j.measured, m, static_cast<Eigen::Index>(k), j.form);
    if (at) weights += at->weights.colwise().sum() / static_cast<double>(j.measured.realisations());
  }
  Eigen::RowVectorXcd bias = Eigen::RowVectorXcd::Zero(l.outputs * l.inputs);
  for (Eigen::Index i = 0; i < l.outputs; ++i) {
    const std::complex<double> factor = signal < l.inputs        ? -j.estimate.response(row, i * l.inputs + signal)
                                        : signal == l.inputs + i ? 1.0
                                                                 : 0.0;
    bias.segment(i * l.inputs, l.inputs) = ramp * factor * weights;
  }
  return bias;
}

/// The largest bias of the lowest lines by a drift of `slope` a period, in confidence radii.
double bias_in_radii(const Judged& j, Eigen::Index signal, double slope) {
  double worst = 0.0;
  for (std::size_t i = 0; i < std::min(kLowestLines, j.estimate.lines.size()); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const Eigen::RowVectorXcd bias = slope * bias_of_drift(j, signal, row);
    for (Eigen::Index c = 0; c < bias.size(); ++c) {
      const double size = std::abs(bias[c]);
      if (!(size > kRounding * std::abs(j.estimate.response(row, c)))) continue;
      worst = std::max(
          worst, size / numerics::confidence_radius(j.estimate.variance(row, c), j.estimate.degrees_of_freedom(row, c), 0.95));
    }
  }
  return worst;
}

/// How the power of the excitation divides into what repeats and what does not.
struct Repetition {
  double repeated = 0.0, scatter = 0.0;  // power of single periods at the lines that carry it
  std::size_t carrying = 0, lines = 0;   // lines that carry power; all
  double floor = 0.0;                    // mean scatter at the others
  std::vector<std::int64_t> left_out;    // carry power that repeats, and are not in the estimate
};

Repetition repetition_of(const Judged& j) {
  const Excitation x = excitation_of(j.measured, 0);
  const Eigen::Index highest = (j.measured.period - 1) / 2;
  const auto periods = static_cast<double>(j.measured.parts.front().periods);
  const Eigen::VectorXd all = x.power + (periods - 1.0) * x.variance;
  const double least = kCarries * all.segment(1, highest).maxCoeff();
  Repetition r;
  r.lines = static_cast<std::size_t>(highest);
  for (Eigen::Index k = 1; k <= highest; ++k) {
    const double scatter = periods * x.variance[k];
    if (all[k] < least) {
      r.floor += scatter;
      continue;
    }
    ++r.carrying;
    r.repeated += x.power[k];
    r.scatter += scatter;
    const bool repeats = x.power[k] >= least && x.power[k] > kOverFloor * x.variance[k];
    if (repeats && !std::binary_search(j.estimate.lines.begin(), j.estimate.lines.end(), k)) r.left_out.push_back(k);
  }
  if (r.carrying < r.lines) r.floor /= static_cast<double>(r.lines - r.carrying);
  return r;
}

bool repeats(const Repetition& r) {
  const double share = r.scatter / (r.repeated + r.scatter);
  if (r.lines - r.carrying < kLinesOfFloor) return share < kMostlyScatter;
  return share < kScatter || r.scatter / static_cast<double>(r.carrying) < kOverFloor * r.floor;
}

}  // namespace

void unrepeated(const Judged& j, std::vector<std::string>& out) {
  if (!j.measured.has_noise()) return;
  const Repetition r = repetition_of(j);
  const std::string signal = j.measured.layout.references > 0 ? "reference" : "input";
  if (!repeats(r)) {
    std::string text = "the periods of the " + signal +
                       " do not repeat: " + number(100.0 * r.scatter / (r.repeated + r.scatter)) +
                       " % of its power changes from one period of " + std::to_string(j.measured.period) + " samples to the next";
    if (j.found_lines)
      text += ", and " + std::to_string(j.estimate.lines.size()) + " of " +
              counted(static_cast<std::int64_t>(r.carrying), "line") + " with power are kept";
    out.push_back(text + "; give the period of the excitation or a multiple of it, and a start after its transient");
    return;
  }
  if (!j.found_lines || r.left_out.empty()) return;
  out.push_back(counted(static_cast<std::int64_t>(r.left_out.size()), "line") + " of the " + signal +
                " with a tenth of the strongest or more are left out, the first at " +
                short_number(static_cast<double>(r.left_out.front()) * j.line_hz) +
                " Hz: name the lines, or set lines.threshold lower, if they are excited");
}

void same_phases(const Judged& j, std::vector<std::string>& out) {
  if (j.estimate.lines.size() < kLinesToCompare) return;
  const std::size_t realisations = j.measured.realisations();
  std::size_t repeated = 0;
  for (std::size_t m = 1; m < realisations; ++m) {
    repeated += alike(j, 0, m) || alike(j, m - 1, m) ? 1 : 0;
  }
  if (repeated == 0) return;
  out.push_back(std::to_string(repeated) + " of " + std::to_string(realisations) +
                " realisations have the excitation of the first or of the one before: nonlinear distortion repeats with it, and "
                "neither variance "
                "nor nonlinear_variance holds it; give each realisation phases of its own (phases: random)");
}

void drift(const Judged& j, std::vector<std::string>& out) {
  for (Eigen::Index a = 0; a < j.measured.layout.inputs + j.measured.layout.outputs; ++a) {
    const Trend trend = trend_of(j.measured, a);
    double at_lines = 0.0, count = 0.0;
    for (const Moments& m : j.measured.parts) {
      for (std::size_t i = 0; m.has_noise() && i < std::min(kLowestLines, j.estimate.lines.size()); ++i) {
        at_lines += m.variance(j.estimate.lines[i], a) * static_cast<double>(m.periods), count += 1.0;
      }
    }
    if (count == 0.0 || !significant(trend, at_lines / count)) continue;
    const double radii = bias_in_radii(j, a, trend.slope);
    if (!(radii > kShareOfRadius)) continue;
    const std::string kind = a < j.measured.layout.inputs ? "input" : "output";
    out.push_back(kind + " '" + j.names[static_cast<std::size_t>(a)] + "' drifts by " +
                  number(trend.slope * static_cast<double>(j.estimate.periods)) + " over the " +
                  std::to_string(j.estimate.periods) + " averaged periods" +
                  (j.measured.parts.size() > 1 ? " of an experiment" : "") +
                  ", which shifts the response at the lowest lines by up to " + number(radii) +
                  " times the confidence radius: set detrend: linear");
  }
}

}  // namespace bodeflow::spectrum
