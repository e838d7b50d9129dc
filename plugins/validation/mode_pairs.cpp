#include "mode_pairs.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <bodeflow/numerics/chi_squared.hpp>
#include <cmath>
#include <limits>

namespace bodeflow::validation {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr Eigen::Index kAround = 3;  // fewest lines that stand for the surroundings of a mode

double apart_of(const Mode& a, const Mode& b) {
  return std::abs(a.pole - b.pole) / std::sqrt(std::abs(a.pole) * std::abs(b.pole));
}

/// First and last line within the half-power width of the mode, at least kAround lines.
std::pair<Eigen::Index, Eigen::Index> around(const Eigen::VectorXd& f, const Mode& m) {
  const double centre = m.frequency_hz(), half = centre * std::max(m.damping(), 0.0);
  Eigen::Index nearest = 0;
  (f.array() - centre).abs().minCoeff(&nearest);
  Eigen::Index first = nearest, last = nearest;
  while (first > 0 && f[first - 1] >= centre - half) --first;
  while (last + 1 < f.size() && f[last + 1] <= centre + half) ++last;
  while (last - first + 1 < std::min(kAround, f.size())) {
    if (first > 0) --first;
    if (last + 1 < f.size() && last - first + 1 < kAround) ++last;
  }
  return {first, last};
}

/// The probability of as much change around the modes of the pair: of the less likely of both places, taken twice.
double probability_around(const ChangeLines& c, const SpectrumChange& s, const ModeChange& m) {
  double least = 1.0;
  for (const auto& mode : {m.before, m.after}) {
    if (!mode) continue;
    const auto [first, last] = around(c.frequency_hz, *mode);
    for (Eigen::Index k = first; k <= last; ++k)
      if (!(c.variance(k) > 0.0)) return kNaN;
    least = std::min(least, change_probability(c, s.significance, first, last - first + 1));
  }
  return std::min(1.0, m.before && m.after ? 2.0 * least : least);
}

void add_shifts(ModeChange& m) {
  m.frequency_shift = m.frequency_shift_deviation = m.damping_shift = m.damping_shift_deviation = kNaN;
  if (!m.before || !m.after) return;
  const double a = m.before->frequency_hz(), b = m.after->frequency_hz();
  m.frequency_shift = b / a - 1.0;
  m.frequency_shift_deviation =
      b / a * std::sqrt(m.before->frequency_variance() / (a * a) + m.after->frequency_variance() / (b * b));
  m.damping_shift = m.after->damping() - m.before->damping();
  m.damping_shift_deviation = std::sqrt(m.before->damping_variance() + m.after->damping_variance());
}

/// Whether the poles differ by more than their covariances; nothing where these are not known.
std::optional<bool> differ(const ModeChange& m, double level) {
  const Eigen::Matrix2d both = m.before->covariance + m.after->covariance;
  if (!both.allFinite() || !(both.determinant() > 0.0)) return std::nullopt;
  const std::complex<double> change = m.after->pole - m.before->pole;
  const Eigen::Vector2d d(change.real(), change.imag());
  return d.dot(both.inverse() * d) > numerics::chi_squared_limit(level, 2.0);
}

ModeStatus status_of(const ModeChange& m, double level) {
  const bool seen = m.probability < level;
  if (!m.before || !m.after) {
    if (!seen) return ModeStatus::undecided;
    return m.before ? ModeStatus::vanished : ModeStatus::fresh;
  }
  const auto moved = differ(m, level);
  if (!moved || std::isnan(m.probability)) return ModeStatus::undecided;
  return *moved && seen ? ModeStatus::moved : ModeStatus::same;
}

}  // namespace

std::string status_text(ModeStatus status) {
  switch (status) {
    case ModeStatus::same:
      return "same";
    case ModeStatus::moved:
      return "moved";
    case ModeStatus::fresh:
      return "new";
    case ModeStatus::vanished:
      return "vanished";
    case ModeStatus::undecided:
      break;
  }
  return "undecided";
}

std::vector<std::pair<int, int>> pair_modes(const std::vector<Mode>& before, const std::vector<Mode>& after, double apart) {
  const std::size_t n = before.size(), m = after.size();
  Eigen::MatrixXd cost = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(n + 1), static_cast<Eigen::Index>(m + 1));
  const auto at = [&](std::size_t i, std::size_t j) -> double& {
    return cost(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  };
  const double alone = 0.5 * apart;
  const auto together = [&](std::size_t i, std::size_t j) {
    const double d = apart_of(before[i], after[j]);
    return d <= apart ? d : INFINITY;
  };
  for (std::size_t i = 0; i <= n; ++i)
    for (std::size_t j = 0; j <= m; ++j) {
      if (i == 0 && j == 0) continue;
      double least = INFINITY;
      if (i > 0) least = std::min(least, at(i - 1, j) + alone);
      if (j > 0) least = std::min(least, at(i, j - 1) + alone);
      if (i > 0 && j > 0) least = std::min(least, at(i - 1, j - 1) + together(i - 1, j - 1));
      at(i, j) = least;
    }
  std::vector<std::pair<int, int>> pairs;
  std::size_t i = n, j = m;
  while (i > 0 || j > 0) {
    if (i > 0 && j > 0 && at(i, j) == at(i - 1, j - 1) + together(i - 1, j - 1)) {
      pairs.emplace_back(static_cast<int>(--i), static_cast<int>(--j));
    } else if (i > 0 && at(i, j) == at(i - 1, j) + alone) {
      pairs.emplace_back(static_cast<int>(--i), -1);
    } else {
      pairs.emplace_back(-1, static_cast<int>(--j));
    }
  }
  std::reverse(pairs.begin(), pairs.end());
  return pairs;
}

std::vector<ModeChange> mode_changes(const ChangeLines& lines, const SpectrumChange& spectrum, const std::vector<Mode>& before,
                                     const std::vector<Mode>& after, double apart, double confidence) {
  const auto pairs = pair_modes(before, after, apart);
  const double level = (1.0 - confidence) / static_cast<double>(std::max<std::size_t>(1, pairs.size()));
  std::vector<ModeChange> changes;
  for (const auto& [i, j] : pairs) {
    ModeChange m;
    if (i >= 0) m.before = before[static_cast<std::size_t>(i)];
    if (j >= 0) m.after = after[static_cast<std::size_t>(j)];
    m.probability = probability_around(lines, spectrum, m);
    add_shifts(m);
    m.status = status_of(m, level);
    changes.push_back(m);
  }
  const auto place = [](const ModeChange& m) { return (m.before ? *m.before : *m.after).frequency_hz(); };
  std::stable_sort(changes.begin(), changes.end(), [&](const auto& a, const auto& b) { return place(a) < place(b); });
  return changes;
}

}  // namespace bodeflow::validation
