#include "linearity.hpp"

#include <algorithm>
#include <bodeflow/numerics/chi_squared.hpp>
#include <cmath>
#include <limits>
#include <numeric>

#include "weighted_mean.hpp"

namespace bodeflow::spectrum {
namespace {

constexpr double kSameFrequency = 1e-9;
constexpr Eigen::Index kGroups = 4;  // of neighbouring lines, for smooth changes

std::string numbered(std::size_t response) { return "response " + std::to_string(response + 1); }

/// Where the lines of a response are others than those of the first one; empty: they are the same.
std::string differing_line(const ResponseData& d, const ResponseData& first) {
  const Eigen::Index lines = d.frequency_hz.size();
  if (lines != first.frequency_hz.size())
    return counted(lines, "line") + ", the first one " + counted(first.frequency_hz.size(), "line");
  for (Eigen::Index k = 0; k < lines; ++k) {
    const double here = d.frequency_hz[k], there = first.frequency_hz[k];
    if (std::abs(here - there) > kSameFrequency * there)
      return "a line at " + short_number(here) + " Hz where the first one has " + short_number(there) + " Hz";
  }
  return {};
}

Expected<bool> check(const std::vector<ResponseData>& all, const std::vector<double>& amplitudes, double significance) {
  if (all.size() < 2)
    return unexpected(counted(static_cast<std::int64_t>(all.size()), "response") +
                      "; needed: at least 2, at different amplitudes");
  if (amplitudes.size() != all.size())
    return unexpected(counted(static_cast<std::int64_t>(amplitudes.size()), "amplitude") + " for " +
                      counted(static_cast<std::int64_t>(all.size()), "response"));
  if (!(significance > 0.0 && significance < 1.0))
    return unexpected("a significance of " + short_number(significance) + "; allowed: between 0 and 1");
  const ResponseData& first = all.front();
  for (std::size_t e = 0; e < all.size(); ++e) {
    const ResponseData& d = all[e];
    if (!(amplitudes[e] > 0.0) || !std::isfinite(amplitudes[e]))
      return unexpected(numbered(e) + " has the amplitude " + short_number(amplitudes[e]) + "; needed: above 0");
    if (std::count(amplitudes.begin(), amplitudes.end(), amplitudes[e]) > 1)
      return unexpected("two responses have the amplitude " + short_number(amplitudes[e]) + "; needed: all different");
    if (d.variance.size() == 0) return unexpected(numbered(e) + " has no variance: what noise explains is not known");
    if (d.input_names != first.input_names || d.output_names != first.output_names || d.response_units != first.response_units)
      return unexpected(numbered(e) + " has other inputs, outputs or units than the first one");
    if (const std::string other = differing_line(d, first); !other.empty())
      return unexpected(numbered(e) + " has " + other + "; needed: the same lines");
  }
  return true;
}

Uncertain entry(const ResponseData& d, Eigen::Index k, Eigen::Index c) {
  return {d.response(k, c), d.variance(k, c), d.degrees_of_freedom.value_or(std::numeric_limits<double>::infinity())};
}

/// Fisher's combination of independent probabilities.
class Combined {
 public:
  void add(double p) {
    sum_ -= 2.0 * std::log(p);
    degrees_ += 2.0;
  }
  double p_value() const { return std::isinf(sum_) ? 0.0 : numerics::chi_squared_tail(sum_, degrees_); }

 private:
  double sum_ = 0.0, degrees_ = 0.0;
};

/// A level and what it is compared with: lines x entries.
struct Pair {
  Eigen::Matrix<Uncertain, Eigen::Dynamic, Eigen::Dynamic> level, below;
};

Pair pair_of(const ResponseData& level, const std::vector<const ResponseData*>& below) {
  Pair p;
  p.level.resize(level.response.rows(), level.response.cols());
  p.below = p.level;
  for (Eigen::Index c = 0; c < p.level.cols(); ++c) {
    for (Eigen::Index k = 0; k < p.level.rows(); ++k) {
      std::vector<Uncertain> numbers;
      for (const ResponseData* d : below) numbers.push_back(entry(*d, k, c));
      p.below(k, c) = weighted_mean(numbers);
      p.level(k, c) = entry(level, k, c);
    }
  }
  return p;
}

/// The mean of (G - G_0)/G_0 over the lines from .. to - 1 of an entry.
Uncertain mean_change(const Pair& pair, Eigen::Index entry, Eigen::Index from, Eigen::Index to) {
  Uncertain mean;
  double squares = 0.0;  // of the lines' variances over their degrees of freedom
  const auto lines = static_cast<double>(to - from);
  for (Eigen::Index k = from; k < to; ++k) {
    const Uncertain &a = pair.level(k, entry), &b = pair.below(k, entry);
    if (b.value == 0.0) continue;  // no relative difference; the test line by line has it
    const double scale = 1.0 / (lines * lines * std::norm(b.value)), va = scale * a.variance, vb = scale * b.variance;
    mean.value += (a.value - b.value) / (lines * b.value);
    mean.variance += va + vb;
    squares += va * va / a.degrees_of_freedom + vb * vb / b.degrees_of_freedom;
  }
  mean.degrees_of_freedom = squares > 0.0 ? mean.variance * mean.variance / squares : std::numeric_limits<double>::infinity();
  return mean;
}

double smooth_p_value(const Pair& pair) {
  const Eigen::Index lines = pair.level.rows(), groups = std::min(kGroups, lines);
  const Uncertain none{0.0, 0.0, std::numeric_limits<double>::infinity()};
  Combined all;
  for (Eigen::Index c = 0; c < pair.level.cols(); ++c) {
    for (Eigen::Index g = 0; g < groups; ++g) {
      all.add(agreement(mean_change(pair, c, g * lines / groups, (g + 1) * lines / groups), none));
    }
  }
  return all.p_value();
}

/// `level` beside the mean of those `below` it.
LevelComparison compare(const ResponseData& level, const std::vector<const ResponseData*>& below) {
  const Pair pair = pair_of(level, below);
  const Eigen::Index lines = pair.level.rows(), entries = pair.level.cols();
  LevelComparison c;
  c.line_p_value = Eigen::VectorXd::Ones(lines);
  Combined all;
  double difference = 0.0, noise = 0.0, size = 0.0;
  for (Eigen::Index i = 0; i < entries; ++i) {
    for (Eigen::Index k = 0; k < lines; ++k) {
      const Uncertain &here = pair.level(k, i), &mean = pair.below(k, i);
      const double p = agreement(here, mean);
      all.add(p);
      c.line_p_value[k] = std::min(c.line_p_value[k], p);
      difference += std::norm(here.value - mean.value);
      noise += here.variance + mean.variance;
      size += std::norm(mean.value);
    }
  }
  c.line_p_value = (static_cast<double>(entries) * c.line_p_value).cwiseMin(1.0);
  c.lines_p_value = all.p_value();
  c.smooth_p_value = smooth_p_value(pair);
  c.p_value = std::min(1.0, 2.0 * std::min(c.lines_p_value, c.smooth_p_value));
  c.relative_difference = std::sqrt(std::max(0.0, difference - noise) / size);
  c.relative_noise = std::sqrt(noise / size);
  return c;
}

}  // namespace

Expected<Linearity> linearity(const std::vector<ResponseData>& responses, const std::vector<double>& amplitudes,
                              double significance) {
  if (auto fine = check(responses, amplitudes, significance); !fine) return unexpected(fine.error().text);
  Linearity l;
  l.order.resize(responses.size());
  std::iota(l.order.begin(), l.order.end(), std::size_t{0});
  std::sort(l.order.begin(), l.order.end(), [&](std::size_t a, std::size_t b) { return amplitudes[a] < amplitudes[b]; });
  for (const std::size_t e : l.order) l.amplitudes.push_back(amplitudes[e]);
  const double limit = significance / static_cast<double>(responses.size() - 1);
  std::vector<const ResponseData*> below = {&responses[l.order[0]]};
  bool agree = true;
  for (std::size_t n = 1; n < l.order.size(); ++n) {
    const ResponseData& level = responses[l.order[n]];
    l.comparisons.push_back(compare(level, below));
    if (!agree) continue;
    l.p_value = std::min(l.p_value, l.comparisons.back().p_value);
    agree = l.comparisons.back().p_value >= limit;
    if (!agree) continue;
    below.push_back(&level);
    ++l.linear_levels;
  }
  return l;
}

Expected<double> line_amplitude(const ResponseData& response) {
  if (!response.spectra) return unexpected("the response has no mean spectra to take its amplitude from; give `levels`");
  return 2.0 * std::sqrt(response.spectra->input.cwiseAbs2().mean());
}

}  // namespace bodeflow::spectrum
