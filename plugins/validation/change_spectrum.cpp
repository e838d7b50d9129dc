#include "change_spectrum.hpp"

#include <algorithm>
#include <bodeflow/numerics/chi_squared.hpp>
#include <cmath>
#include <limits>

#include "magnitude_factors.hpp"
#include "records/signals.hpp"

namespace bodeflow::validation {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kMost = 1e6;         // significance of a change at a line without any variance
constexpr double kFound = 1.6448536;  // normal quantile of the 95 % with which a detectable change is found

double significance_at(const ChangeLines& c, Eigen::Index k) {
  const double change = std::norm(c.after[k] - c.before[k]), variance = c.variance(k), nu = c.degrees(k);
  if (change == 0.0) return 0.0;
  const double t = change / variance;
  return std::min(kMost, std::isfinite(nu) ? nu * std::log1p(t / nu) : t);
}

/// g: how many lines go along with each other in that part.
double lines_together(const ChangeLines& c, Eigen::Index first, Eigen::Index count) {
  const double noise = std::min<double>(static_cast<double>(count), static_cast<double>(2 * c.correlated_lines + 1));
  double share = 0.0;
  for (Eigen::Index k = first; k < first + count; ++k)
    if (c.scatter[k] > 0.0) share += 2.0 * c.scatter[k] / c.variance(k);
  share /= static_cast<double>(count);
  return noise + share * (static_cast<double>(count) - noise);
}

/// The relative change at all lines of the band that the sum finds with 95 %: normal approximation of the non-central
/// chi-squared distribution.
double detectable_change(const ChangeLines& c, const BandChange& band, double level) {
  const double n = static_cast<double>(band.lines), g = lines_together(c, band.first, band.lines), df = 2.0 * n / g;
  const double apart = df - numerics::chi_squared_limit(0.5 * level, df);
  const double half = apart - 2.0 * kFound * kFound;
  const double shift = -half + std::sqrt(std::max(0.0, half * half - apart * apart + 2.0 * kFound * kFound * df));
  double ratio = 0.0, nu = INFINITY;
  for (Eigen::Index k = band.first; k < band.first + band.lines; ++k) {
    ratio += std::norm(c.before[k]) / c.variance(k);
    nu = std::min(nu, c.degrees(k));
  }
  const double mean = (df + shift) / df;
  const double t = std::isfinite(nu) ? nu * std::expm1(mean / nu) : mean;
  return std::sqrt(std::max(0.0, t - 1.0) * n / ratio);
}

Expected<std::vector<BandChange>> divide(const Eigen::VectorXd& f, const SpectrumSettings& s) {
  std::vector<BandChange> bands;
  const auto add = [&](double low, double high, Eigen::Index first, Eigen::Index last) {
    if (last <= first) return;
    BandChange b;
    b.low_hz = low;
    b.high_hz = high;
    b.first = first;
    b.lines = last - first;
    bands.push_back(b);
  };
  if (s.edges_hz.empty()) {
    const Eigen::Index count = std::clamp<Eigen::Index>(f.size() / kFewestLines, 1, s.bands);
    for (Eigen::Index i = 0; i < count; ++i) {
      const Eigen::Index first = f.size() * i / count, last = f.size() * (i + 1) / count;
      add(i == 0 ? f[0] : 0.5 * (f[first - 1] + f[first]), i + 1 == count ? f[f.size() - 1] : 0.5 * (f[last - 1] + f[last]),
          first, last);
    }
    return bands;
  }
  for (std::size_t i = 1; i < s.edges_hz.size(); ++i) {
    const double low = s.edges_hz[i - 1], high = s.edges_hz[i];
    if (!(high > low))
      return unexpected("bands: the edges must rise; " + records::short_number(high) + " Hz after " + records::short_number(low) +
                        " Hz");
    const bool last = i + 1 == s.edges_hz.size();
    const auto* from = std::lower_bound(f.data(), f.data() + f.size(), low);
    const auto* to =
        last ? std::upper_bound(f.data(), f.data() + f.size(), high) : std::lower_bound(f.data(), f.data() + f.size(), high);
    add(low, high, from - f.data(), to - f.data());
  }
  if (bands.empty()) return unexpected("bands: no line of the responses lies within them");
  return bands;
}

void judge(const ChangeLines& c, const Eigen::VectorXd& significance, BandChange& b, double level, double relevant) {
  const auto before = c.before.segment(b.first, b.lines), after = c.after.segment(b.first, b.lines);
  const double size = before.norm();
  b.relative = size > 0.0 ? (after - before).norm() / size : kNaN;
  const Eigen::VectorXd x = decibels(before), y = decibels(after);
  b.correlation = correlation_coefficient(x, y);
  b.factor = relative_factor(x, y);
  Eigen::Index strongest = 0;
  bool known = true;
  for (Eigen::Index k = b.first; k < b.first + b.lines; ++k) known = known && c.variance(k) > 0.0;
  (known ? Eigen::VectorXd(significance.segment(b.first, b.lines)) : Eigen::VectorXd((after - before).cwiseAbs()))
      .maxCoeff(&strongest);
  b.strongest_hz = c.frequency_hz[b.first + strongest];
  if (!known) {
    b.probability = b.detectable = kNaN;
    return;
  }
  const double together = change_probability(c, significance, b.first, b.lines);
  const double line = std::exp(-significance[b.first + strongest]);
  const double alone = -std::expm1(static_cast<double>(b.lines) * std::log1p(-std::min(line, 1.0 - 1e-16)));
  b.probability = std::min(1.0, 2.0 * std::min(together, alone));
  b.detectable = detectable_change(c, b, level);
  b.verdict = b.probability < level ? Verdict::changed : b.detectable <= relevant ? Verdict::unchanged : Verdict::undecidable;
}

}  // namespace

std::string verdict_text(Verdict verdict) {
  return verdict == Verdict::changed ? "changed" : verdict == Verdict::unchanged ? "unchanged" : "not decidable";
}

double change_probability(const ChangeLines& c, const Eigen::VectorXd& significance, Eigen::Index first, Eigen::Index count) {
  const double g = lines_together(c, first, count);
  return numerics::chi_squared_tail(2.0 * significance.segment(first, count).sum() / g, 2.0 * static_cast<double>(count) / g);
}

Expected<SpectrumChange> spectrum_change(const ChangeLines& c, const SpectrumSettings& settings, Eigen::Index entries) {
  auto bands = divide(c.frequency_hz, settings);
  if (!bands) return unexpected(bands.error().text);
  SpectrumChange s;
  s.bands = std::move(*bands);
  s.level = (1.0 - settings.confidence) / static_cast<double>(entries * static_cast<Eigen::Index>(s.bands.size()));
  s.significance.resize(c.lines());
  for (Eigen::Index k = 0; k < c.lines(); ++k) s.significance[k] = significance_at(c, k);
  bool any = false, all = true;
  for (BandChange& b : s.bands) {
    judge(c, s.significance, b, s.level, settings.relevant);
    any = any || b.verdict == Verdict::changed;
    all = all && b.verdict == Verdict::unchanged;
  }
  s.verdict = any ? Verdict::changed : all ? Verdict::unchanged : Verdict::undecidable;
  return s;
}

}  // namespace bodeflow::validation
