#include "sampled/layout.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "model/plant_matrices.hpp"
#include "records/signals.hpp"

namespace bodeflow::residual {
namespace {

constexpr Eigen::Index kLeastSamples = 100;
constexpr Eigen::Index kWindow = 25, kShortest = 50;     // samples a state
constexpr Eigen::Index kPieces = 3, kLeastSegments = 4;  // of an excerpt
constexpr double kTimeConstants = 4.0;
constexpr double kOversampling = 2.0;  // half the rate of rows over the corner: the filter has 48 dB there
// A pole that is slower than the fastest one by this factor integrates.
constexpr double kIntegrates = 1e-9;

struct Poles {
  Eigen::Index states = 0;
  double slowest_s = 0.0;  ///< of those that decay
  bool integrates = false;
};

Expected<Poles> poles_of(const BaseModel& base, const Eigen::VectorXd& values, const std::vector<double>& known) {
  Poles p;
  if (!base.has_state_space()) return p;
  const auto plant = plant_matrices(base, values.data(), known);
  if (!plant) return refused("the base model can't be computed at its start");
  p.states = plant->states();
  if (p.states == 0) return p;
  const Eigen::VectorXcd poles = plant->A.eigenvalues();
  const double fastest = poles.cwiseAbs().maxCoeff();
  for (const auto& pole : poles) {
    if (-pole.real() > kIntegrates * fastest)
      p.slowest_s = std::max(p.slowest_s, -1.0 / pole.real());
    else if (!base.has_laws() || fastest > 0.0)
      p.integrates = true;
  }
  // A law of the base itself may be what makes it settle.
  if (base.has_laws() && p.slowest_s == 0.0) p.integrates = false;
  return p;
}

void finish(Layout& l) {
  for (const Layout::Segment& s : l.segments) {
    l.row_stretches.push_back({l.rows, s.rows});
    l.rows += s.rows;
  }
}

}  // namespace

Expected<Layout> make_layout(Eigen::Index samples, double sample_time_s, const BaseModel& base, const Eigen::VectorXd& values,
                             const std::vector<double>& known, double segment_s) {
  const auto poles = poles_of(base, values, known);
  if (!poles) return tl::unexpected(poles.error());
  const Eigen::Index least = std::max(kLeastSamples, 2 * kShortest * poles->states);
  if (samples < least)
    return refused("the record has " + std::to_string(samples) + " samples; needed: at least " + std::to_string(least));
  Layout l;
  l.integrates = poles->integrates;
  const auto samples_of = [&](double seconds) { return static_cast<Eigen::Index>(std::ceil(seconds / sample_time_s)); };
  if (poles->states == 0) {
    const double corner = base.filter_hz();
    const Eigen::Index edge = corner > 0.0 ? std::min(samples_of(1.0 / corner), samples / 10) : 0;
    if (corner > 0.0)
      l.stride = std::max<Eigen::Index>(1, static_cast<Eigen::Index>(0.5 / (kOversampling * corner * sample_time_s)));
    l.segments.push_back({{0, samples}, 0, edge, (samples - 2 * edge + l.stride - 1) / l.stride});
    if (edge > 0) l.words = std::to_string(edge) + " samples at both ends are left out (edges of the filter)";
    if (l.stride > 1)
      l.words += ", every " + std::to_string(l.stride) + "th of the others counts (the filter leaves nothing between)";
    finish(l);
    return l;
  }
  Eigen::Index length = samples;
  if (segment_s > 0.0 && segment_s < static_cast<double>(samples) * sample_time_s) {
    length = samples_of(segment_s);
    if (length < kShortest * poles->states)
      return refused("a segment of " + records::short_number(segment_s) + " s has " + std::to_string(length) +
                     " samples; needed: at least " + std::to_string(kShortest * poles->states));
  } else if (segment_s == 0.0 && l.integrates) {
    length = std::clamp(samples_of(kTimeConstants * poles->slowest_s), kShortest * poles->states, samples / 5);
  }
  if (length == samples) {
    const Eigen::Index slowest =
        poles->slowest_s < static_cast<double>(samples) * sample_time_s ? samples_of(poles->slowest_s) : samples;
    const Eigen::Index window = std::clamp(slowest, kWindow * poles->states, std::max(samples / 5, kWindow * poles->states));
    l.segments.push_back({{0, samples}, window, window, samples - window});
    l.words = "the first " + std::to_string(window) + " samples determine the initial state and are not counted";
  } else {
    const Eigen::Index count = samples / length;  // the rest at the end goes to the last segments
    for (Eigen::Index i = 0; i < count; ++i) {
      const Eigen::Index first = i * samples / count, next = (i + 1) * samples / count;
      l.segments.push_back({{first, next - first}, next - first, first, next - first});
    }
    l.words = "the plant integrates: " + std::to_string(count) + " segments of " +
              records::short_number(static_cast<double>(length) * sample_time_s) + " s, each from an initial state fitted to it";
  }
  finish(l);
  return l;
}

std::optional<Layout> excerpt_of(const Layout& whole, Eigen::Index rows) {
  Layout part = whole;
  part.segments.clear();
  part.row_stretches.clear();
  part.rows = 0;
  const auto count = static_cast<Eigen::Index>(whole.segments.size());
  const bool each_settles =
      whole.segments.front().window > 0 && whole.segments.front().window < whole.segments.front().samples.count;
  if (each_settles) {
    if (whole.integrates) return {};  // pieces with a state of their own say little of a drift
    const Eigen::Index pieces = std::max<Eigen::Index>(kPieces / count, 1);
    for (const Layout::Segment& s : whole.segments) {
      const Eigen::Index length = s.window + rows / (pieces * count);
      if (2 * pieces * length > s.samples.count) return {};
      for (Eigen::Index i = 0; i < pieces; ++i) {
        const Eigen::Index at = s.samples.first + (pieces > 1 ? i * (s.samples.count - length) / (pieces - 1) : 0);
        part.segments.push_back({{at, length}, s.window, at + s.window, length - s.window});
      }
    }
  } else {
    const Eigen::Index every = whole.rows / rows;
    if (every < 2 || count / every < kLeastSegments) return {};
    for (Eigen::Index i = every / 2; i < count; i += every) part.segments.push_back(whole.segments[static_cast<std::size_t>(i)]);
  }
  finish(part);
  return part;
}

}  // namespace bodeflow::residual
