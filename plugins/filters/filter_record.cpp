#include "filter_record.hpp"

#include <algorithm>
#include <bodeflow/numerics/fir.hpp>
#include <cmath>

namespace bodeflow::filters {
namespace {

constexpr double kDecades = 4.0;
constexpr double kSettled = 1e-4;  // of the largest value
constexpr Eigen::Index kLeastImpulse = 8;
constexpr Eigen::Index kMostProducts = 20'000'000;  // of a record: long filters are shown at fewer frequencies

// Evenly over the logarithm up to the Nyquist frequency, and around what is narrow.
std::vector<double> frequencies(double nyquist_hz, const std::vector<FilterCurve>& curves, int points) {
  std::vector<double> f;
  for (int k = 0; k <= points; ++k) f.push_back(nyquist_hz * std::pow(10.0, kDecades * (static_cast<double>(k) / points - 1)));
  for (const FilterCurve& curve : curves) {
    for (const auto& [centre, width] : curve.resonances) {
      for (const double step : {-8.0, -4.0, -2.0, -1.0, -0.5, -0.25, 0.0, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0}) {
        const double near = centre + step * width;
        if (near > f.front() && near < nyquist_hz) f.push_back(near);
      }
    }
  }
  std::sort(f.begin(), f.end());
  f.erase(std::unique(f.begin(), f.end()), f.end());
  return f;
}

}  // namespace

Eigen::VectorXd settled(const Eigen::VectorXd& impulse) {
  if (impulse.size() == 0) return impulse;
  const double floor = kSettled * impulse.cwiseAbs().maxCoeff();
  Eigen::Index end = impulse.size();
  while (end > kLeastImpulse && std::abs(impulse[end - 1]) <= floor) --end;
  return impulse.head(std::min(end, impulse.size()));
}

RecordBuilder filter_record(const std::string& kind, double sample_rate_hz, const std::vector<FilterCurve>& curves, int points) {
  RecordBuilder record("filter");
  std::vector<std::string> names;
  Eigen::Index longest = 0;
  for (const FilterCurve& curve : curves) {
    names.push_back(curve.label);
    longest = std::max(longest, curve.impulse.size());
  }
  record.set("kind", kind);
  record.set("sample_rate", sample_rate_hz);
  record.set("names", names);
  const std::vector<double> f = frequencies(0.5 * sample_rate_hz, curves, points);
  const std::size_t count = curves.size();
  const auto frequency = record.array<double>("frequency", "Hz", {f.size()});
  std::copy(f.begin(), f.end(), frequency.begin());
  const auto response = record.array<std::complex<double>>("response", "", {f.size(), count});
  for (std::size_t k = 0; k < f.size(); ++k) {
    for (std::size_t i = 0; i < count; ++i) response[k * count + i] = curves[i].response(f[k]);
  }
  const auto samples = static_cast<std::size_t>(longest);
  const auto time = record.array<double>("time", "s", {samples});
  for (std::size_t n = 0; n < samples; ++n) time[n] = static_cast<double>(n) / sample_rate_hz;
  const auto impulse = record.array<double>("impulse", "", {samples, count});
  for (std::size_t i = 0; i < count; ++i) {
    for (Eigen::Index n = 0; n < curves[i].impulse.size(); ++n)
      impulse[static_cast<std::size_t>(n) * count + i] = curves[i].impulse[n];
  }
  return record;
}

RecordBuilder fir_record(const std::string& kind, double sample_rate_hz, const Eigen::VectorXd& taps) {
  FilterCurve curve;
  curve.label = "filter";
  curve.response = [&](double hz) { return numerics::fir_response(taps, 2 * hz / sample_rate_hz); };
  curve.impulse = taps.head(std::min(taps.size(), kMostImpulse));
  const Eigen::Index points = kMostProducts / std::max<Eigen::Index>(taps.size(), 1);
  return filter_record(kind, sample_rate_hz, {curve}, static_cast<int>(std::clamp<Eigen::Index>(points, 16, 300)));
}

}  // namespace bodeflow::filters
