#include "change_lines.hpp"

#include <algorithm>
#include <array>

#include "records/signals.hpp"

namespace bodeflow::validation {
namespace {

using Complex = std::complex<double>;
using records::ResponseData;

constexpr double kSameFrequency = 1e-6;   // relative
constexpr Eigen::Index kNeighbours = 10;  // w: lines on each side over which the scatter is averaged

/// How the value at one frequency comes from lines of a response.
struct Place {
  std::array<Eigen::Index, 4> line{};
  std::array<double, 4> weight{};    ///< of the cubic
  std::array<double, 4> straight{};  ///< of the straight line between the two around it
  bool exact = false;
};

std::array<double, 4> lagrange(const std::array<double, 4>& x, double at) {
  std::array<double, 4> weight{};
  for (std::size_t i = 0; i < 4; ++i) {
    weight[i] = 1.0;
    for (std::size_t j = 0; j < 4; ++j)
      if (j != i) weight[i] *= (at - x[j]) / (x[i] - x[j]);
  }
  return weight;
}

bool same(double a, double b) { return std::abs(a - b) <= kSameFrequency * std::max(std::abs(a), std::abs(b)); }

/// Nothing outside the range.
std::optional<Place> place_of(double f, const Eigen::VectorXd& lines) {
  const auto* above = std::lower_bound(lines.data(), lines.data() + lines.size(), f);
  const Eigen::Index k = above - lines.data();
  Place p;
  for (const Eigen::Index near : {k - 1, k}) {
    if (near < 0 || near >= lines.size() || !same(lines[near], f)) continue;
    p.line.fill(near);
    p.weight[0] = p.straight[0] = 1.0;
    p.exact = true;
    return p;
  }
  if (k == 0 || k == lines.size()) return std::nullopt;
  const Eigen::Index first = std::clamp<Eigen::Index>(k - 2, 0, lines.size() - 4);
  const std::array<Eigen::Index, 4> near{first, first + 1, first + 2, first + 3};
  std::array<double, 4> x{};
  for (std::size_t i = 0; i < 4; ++i) x[i] = std::log(lines[near[i]]);
  p.line = near;
  p.weight = lagrange(x, std::log(f));
  const auto below = static_cast<std::size_t>(k - 1 - first);
  p.straight[below + 1] = (std::log(f) - x[below]) / (x[below + 1] - x[below]);
  p.straight[below] = 1.0 - p.straight[below + 1];
  return p;
}

Expected<void> check_alike(const ResponseData& before, const ResponseData& after, const std::string& what) {
  if (before.inputs() != after.inputs() || before.outputs() != after.outputs()) {
    return unexpected("the response " + what + " has " + records::counted(after.outputs(), "output") + " and " +
                      records::counted(after.inputs(), "input") + ", that before " +
                      records::counted(before.outputs(), "output") + " and " + records::counted(before.inputs(), "input"));
  }
  for (std::size_t i = 0; i < before.response_units.size(); ++i) {
    const std::string &a = before.response_units[i], &b = after.response_units[i];
    if (!a.empty() && !b.empty() && a != b)
      return unexpected("the response " + what + " is in " + b + ", that before in " + a + ": measure both in the same unit");
  }
  return {};
}

/// What the record states of it; 0 without.
Eigen::VectorXd noise_of(const ResponseData& r, Eigen::Index entry) {
  return r.variance.size() > 0 ? Eigen::VectorXd(r.variance.col(entry)) : Eigen::VectorXd::Zero(r.frequency_hz.size());
}

/// Variance beyond the noise at the lines of `before`, by repeats.
Eigen::VectorXd repeated_scatter(const ResponseData& before, const std::vector<ResponseData>& repeats, Eigen::Index entry) {
  const Eigen::Index lines = before.frequency_hz.size();
  const Eigen::VectorXd noise = noise_of(before, entry);
  const bool known = noise.minCoeff() > 0.0;
  Eigen::VectorXd base = known ? noise : Eigen::VectorXd(before.response.col(entry).cwiseAbs2());
  Eigen::VectorXd ratio(lines);
  for (Eigen::Index k = 0; k < lines; ++k) {
    Complex mean = before.response(k, entry);
    for (const auto& r : repeats) mean += r.response(k, entry);
    mean /= static_cast<double>(repeats.size() + 1);
    double squares = std::norm(before.response(k, entry) - mean);
    for (const auto& r : repeats) squares += std::norm(r.response(k, entry) - mean);
    ratio[k] = base[k] > 0.0 ? squares / static_cast<double>(repeats.size()) / base[k] : 0.0;
  }
  Eigen::VectorXd scatter(lines);
  for (Eigen::Index k = 0; k < lines; ++k) {
    const Eigen::Index first = std::max<Eigen::Index>(0, k - kNeighbours), last = std::min(lines - 1, k + kNeighbours);
    const double mean = ratio.segment(first, last - first + 1).mean();
    scatter[k] = base[k] * (known ? std::max(0.0, mean - 1.0) : mean);
  }
  return scatter;
}

/// The entry before and after at those lines.
ChangeLines entry_at(const ResponseData& before, const ResponseData& after, const std::vector<Eigen::Index>& lines,
                     const std::vector<Place>& places, Eigen::Index entry, const Scatter& scatter) {
  ChangeLines c;
  c.frequency_hz = before.frequency_hz(lines);
  c.before = before.response.col(entry)(lines);
  c.before_noise = noise_of(before, entry)(lines);
  const Eigen::VectorXd noise = noise_of(after, entry);
  const auto count = static_cast<Eigen::Index>(lines.size());
  c.after = Eigen::VectorXcd::Zero(count);
  c.after_noise = Eigen::VectorXd::Zero(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const Place& p = places[static_cast<std::size_t>(k)];
    Complex bend = 0.0;
    for (std::size_t i = 0; i < 4; ++i) {
      c.after[k] += p.weight[i] * after.response(p.line[i], entry);
      c.after_noise[k] += p.weight[i] * p.weight[i] * noise[p.line[i]];
      bend += (p.weight[i] - p.straight[i]) * after.response(p.line[i], entry);
    }
    c.after_noise[k] += std::norm(bend);
  }
  c.scatter = scatter.relative * scatter.relative * c.before.cwiseAbs2();
  c.scatter.array() += scatter.absolute * scatter.absolute;
  if (!scatter.repeats.empty()) {
    c.scatter += repeated_scatter(before, scatter.repeats, entry)(lines);
    c.scatter_degrees = static_cast<double>(scatter.repeats.size());
  }
  c.before_degrees = before.degrees_of_freedom.value_or(INFINITY);
  c.after_degrees = after.degrees_of_freedom.value_or(INFINITY);
  c.correlated_lines = std::max(before.correlated_lines, after.correlated_lines);
  return c;
}

}  // namespace

double ChangeLines::degrees(Eigen::Index k) const {
  const double total = variance(k);
  const auto share = [](double v, double nu) { return v > 0.0 ? v * v / nu : 0.0; };
  const double spread =
      share(before_noise[k], before_degrees) + share(after_noise[k], after_degrees) + share(2.0 * scatter[k], scatter_degrees);
  return spread > 0.0 ? total * total / spread : INFINITY;
}

Expected<AlignedResponses> align(const ResponseData& before, const ResponseData& after, const Scatter& scatter) {
  if (auto good = check_alike(before, after, "after"); !good) return unexpected(good.error().text);
  for (const auto& repeat : scatter.repeats) {
    if (auto good = check_alike(before, repeat, "of a repeat"); !good) return unexpected(good.error().text);
    bool fits = repeat.frequency_hz.size() == before.frequency_hz.size();
    for (Eigen::Index k = 0; fits && k < before.frequency_hz.size(); ++k)
      fits = same(repeat.frequency_hz[k], before.frequency_hz[k]);
    if (!fits) return unexpected("a repeat stands at other frequencies than the response before: measure it at the same lines");
  }
  if (after.frequency_hz.size() < kFewestLines) {
    return unexpected("the response after has " + records::counted(after.frequency_hz.size(), "line") +
                      "; needed: " + std::to_string(kFewestLines));
  }
  AlignedResponses aligned;
  std::vector<Eigen::Index> lines;
  std::vector<Place> places;
  for (Eigen::Index k = 0; k < before.frequency_hz.size(); ++k) {
    const auto place = place_of(before.frequency_hz[k], after.frequency_hz);
    if (!place) continue;
    if (!place->exact && after.frequency_hz[0] == 0.0)
      return unexpected("the responses have different frequencies, and one at 0 Hz: leave that out to interpolate");
    if (!place->exact) ++aligned.interpolated;
    lines.push_back(k);
    places.push_back(*place);
  }
  const auto count = static_cast<Eigen::Index>(lines.size());
  aligned.left_out = before.frequency_hz.size() - count;
  if (count < kFewestLines) {
    return unexpected("the responses have " + records::counted(count, "line") +
                      " in common; needed: " + std::to_string(kFewestLines));
  }
  for (Eigen::Index e = 0; e < before.response.cols(); ++e)
    aligned.entries.push_back(entry_at(before, after, lines, places, e, scatter));
  return aligned;
}

}  // namespace bodeflow::validation
