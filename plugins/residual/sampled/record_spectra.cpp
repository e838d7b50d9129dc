#include "sampled/record_spectra.hpp"

#include <algorithm>
#include <bodeflow/numerics/fft.hpp>
#include <cmath>
#include <numbers>

namespace bodeflow::residual {
namespace {

constexpr Eigen::Index kLeastSamples = 128, kShortest = 64, kLongest = 8192, kParts = 16;
constexpr double kSilent = 1e-8;  // of the strongest line's power
constexpr Eigen::Index kSurroundings = 50;
constexpr double kChance = 1e-3;
constexpr Eigen::Index kLeastPart = 32;

Eigen::VectorXd hann(Eigen::Index length) {
  Eigen::VectorXd w(length);
  for (Eigen::Index n = 0; n < length; ++n)
    w[n] = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * (static_cast<double>(n) + 0.5) / static_cast<double>(length));
  return w;
}

/// Where the mean of a part changes most: the sample behind the change and the statistic in deviates.
struct Change {
  Eigen::Index at = 0;
  double size = 0.0;
};

Change greatest_change(const Eigen::VectorXd& x, Eigen::Index first, Eigen::Index count) {
  Change best;
  if (count < 2 * kLeastPart) return best;
  const auto part = x.segment(first, count);
  const double mean = part.mean(), std = std::sqrt((part.array() - mean).square().mean());
  if (!(std > 0.0)) return best;
  double sum = 0.0;
  const auto n = static_cast<double>(count);
  for (Eigen::Index k = 1; k < count; ++k) {
    sum += part[k - 1] - mean;
    if (k < kLeastPart || count - k < kLeastPart) continue;
    const double before = static_cast<double>(k), size = std::abs(sum) / (std * std::sqrt(before * (n - before) / n));
    if (size > best.size) best = {first + k, size};
  }
  return best;
}

}  // namespace

MeasuredResponse averaged_response(const Eigen::VectorXd& x, const Eigen::VectorXd& y, double sample_time_s) {
  MeasuredResponse r;
  const Eigen::Index samples = x.size();
  if (samples < kLeastSamples) return r;
  Eigen::Index length = kShortest;
  while (2 * length <= kLongest && 2 * length * kParts / 2 <= samples) length *= 2;
  const Eigen::VectorXd window = hann(length);
  numerics::RealDft dft(length);
  Eigen::VectorXcd u(dft.lines()), v(dft.lines()), cross = Eigen::VectorXcd::Zero(dft.lines());
  Eigen::VectorXd power = Eigen::VectorXd::Zero(dft.lines()), power_y = power;
  int parts = 0;
  for (Eigen::Index first = 0; first + length <= samples; first += length / 2, ++parts) {
    const auto a = x.segment(first, length), b = y.segment(first, length);
    dft.forward(Eigen::VectorXd(((a.array() - a.mean()) * window.array()).matrix()), u);
    dft.forward(Eigen::VectorXd(((b.array() - b.mean()) * window.array()).matrix()), v);
    cross += v.cwiseProduct(u.conjugate());
    power += u.cwiseAbs2();
    power_y += v.cwiseAbs2();
  }
  const double strongest = power.tail(power.size() - 1).maxCoeff();
  for (Eigen::Index k = 1; k < dft.lines() - 1; ++k) {
    if (!(power[k] > kSilent * strongest)) continue;
    const std::complex<double> g = cross[k] / power[k];
    const double noise = std::max(power_y[k] - std::norm(cross[k]) / power[k], 1e-12 * power_y[k]);
    if (!(std::abs(g) > 0.0) || !(noise > 0.0)) continue;
    r.frequency_hz.push_back(static_cast<double>(k) / (static_cast<double>(length) * sample_time_s));
    r.response.push_back(g);
    r.weight.push_back(std::sqrt(power[k] / noise * std::max(0.5 * parts, 1.0)));
  }
  return r;
}

std::vector<double> peak_frequencies(const Eigen::VectorXd& x, double sample_time_s, std::size_t most) {
  const Eigen::Index samples = x.size();
  if (samples < kLeastSamples) return {};
  const Eigen::VectorXd power = numerics::half_dft((x.array() - x.mean()).matrix().cwiseProduct(hann(samples))).cwiseAbs2();
  // The mean is ln 2 times less than the median of an exponential distribution tells, whose tail is exp(-x).
  const double limit = std::log(static_cast<double>(samples) / kChance);
  struct Peak {
    double ratio, frequency_hz;
  };
  std::vector<Peak> peaks;
  std::vector<double> around;
  for (Eigen::Index k = 2; k + 2 < power.size(); ++k) {
    if (!(power[k] > power[k - 1]) || !(power[k] >= power[k + 1])) continue;
    const Eigen::Index from = std::max<Eigen::Index>(1, k - kSurroundings), to = std::min(power.size() - 1, k + kSurroundings);
    around.assign(power.data() + from, power.data() + to);
    std::nth_element(around.begin(), around.begin() + static_cast<std::ptrdiff_t>(around.size() / 2), around.end());
    const double mean = around[around.size() / 2] / std::numbers::ln2;
    if (!(power[k] > limit * mean)) continue;
    // The vertex of a parabola through the logarithms, which is that of a Hann window within a twentieth of a bin.
    const double a = std::log(power[k - 1]), b = std::log(power[k]), c = std::log(power[k + 1]), bend = a - 2.0 * b + c;
    const double place = static_cast<double>(k) + (bend < 0.0 ? 0.5 * (a - c) / bend : 0.0);
    peaks.push_back({power[k] / std::max(mean, 1e-300), place / (static_cast<double>(samples) * sample_time_s)});
  }
  std::stable_sort(peaks.begin(), peaks.end(), [](const Peak& p, const Peak& q) { return p.ratio > q.ratio; });
  std::vector<double> frequencies;
  for (std::size_t i = 0; i < std::min(most, peaks.size()); ++i) frequencies.push_back(peaks[i].frequency_hz);
  return frequencies;
}

std::vector<Eigen::Index> change_points(const Eigen::VectorXd& x, std::size_t most) {
  std::vector<Change> changes;
  const Eigen::VectorXd square = x.cwiseAbs2();
  for (const Eigen::VectorXd* signal : {&x, &square}) {
    const Change whole = greatest_change(*signal, 0, x.size());
    if (!(whole.size > 0.0)) continue;
    changes.push_back(whole);
    for (const Change& part : {greatest_change(*signal, 0, whole.at), greatest_change(*signal, whole.at, x.size() - whole.at)})
      if (part.size > 0.0) changes.push_back(part);
  }
  std::stable_sort(changes.begin(), changes.end(), [](const Change& a, const Change& b) { return a.size > b.size; });
  std::vector<Eigen::Index> places;
  for (const Change& c : changes) {
    const auto near = [&c](Eigen::Index p) { return std::abs(p - c.at) < kLeastPart; };
    if (places.size() < most && std::none_of(places.begin(), places.end(), near)) places.push_back(c.at);
  }
  return places;
}

}  // namespace bodeflow::residual
