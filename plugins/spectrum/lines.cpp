#include "lines.hpp"

#include <algorithm>
#include <cmath>

namespace bodeflow::spectrum {
namespace {

// A line is told from noise when the power of its mean is 10 dB above the variance of that mean.
constexpr double kExcitedOverVariance = 10.0;

}  // namespace

Excitation excitation_of(const Measured& measured, std::size_t realisation) {
  const Layout& l = measured.layout;
  const Eigen::Index first = l.references > 0 ? l.inputs + l.outputs : 0, count = l.references > 0 ? l.references : l.inputs;
  Excitation e;
  e.power = Eigen::VectorXd::Zero(measured.parts.front().mean.rows());
  e.variance = e.power;
  for (Eigen::Index i = 0; i < measured.experiments; ++i) {
    const Moments& m = measured.part(realisation, i);
    for (Eigen::Index a = first; a < first + count; ++a) {
      e.power += m.mean.col(a).cwiseAbs2();
      if (m.has_noise()) e.variance += m.variance.col(a);
    }
  }
  return e;
}

std::vector<std::int64_t> chosen_lines(const Measured& measured, const LineChoice& choice) {
  const Eigen::Index highest = (measured.period - 1) / 2;
  std::vector<std::int64_t> lines = choice.candidates;
  if (lines.empty()) {
    for (std::int64_t k = 1; k <= highest; ++k) lines.push_back(k);
  }
  if (choice.threshold <= 0.0) return lines;
  for (std::size_t m = 0; m < measured.realisations(); ++m) {
    const Excitation e = excitation_of(measured, m);
    double largest = 0.0;
    for (const std::int64_t k : choice.candidates) largest = std::max(largest, e.power[k]);
    if (choice.candidates.empty()) largest = e.power.segment(1, highest).maxCoeff();
    const double least = choice.threshold * std::sqrt(largest);
    const auto silent = [&](std::int64_t k) {
      return !(std::sqrt(e.power[k]) >= least && e.power[k] > kExcitedOverVariance * e.variance[k]);
    };
    lines.erase(std::remove_if(lines.begin(), lines.end(), silent), lines.end());
  }
  return lines;
}

}  // namespace bodeflow::spectrum
