#include "sampled/observations.hpp"

#include <algorithm>
#include <cmath>

#include "records/signals.hpp"
#include "spectrum/sample_watch.hpp"

namespace bodeflow::residual {
namespace {

// A lattice of values: so many distinct differences at least are whole multiples of the least one, within this part of it.
constexpr double kOnLattice = 1e-3;
// The noise of rounding, a step over sqrt(12), above this part of the signal's deviation is worth a sentence.
constexpr double kCoarse = 1e-3;
constexpr Eigen::Index kStill = 20;  // equal samples in a row, while the other signal moves at each of them

std::string named(const records::Signals& signals, Eigen::Index c, const char* port) {
  return std::string(port) + " '" + signals.names[static_cast<std::size_t>(c)] + "'";
}

std::string unit_of(const records::Signals& signals, Eigen::Index c) {
  const std::string& unit = signals.units[static_cast<std::size_t>(c)];
  return unit.empty() ? "" : " " + unit;
}

/// The step of the lattice on which all values of a channel lie; 0 where there is none.
double lattice_step(const Eigen::VectorXd& x) {
  double step = 0.0;
  for (Eigen::Index n = 1; n < x.size(); ++n) {
    const double d = std::abs(x[n] - x[n - 1]);
    if (d > 0.0 && (step == 0.0 || d < step)) step = d;
  }
  if (step == 0.0) return 0.0;
  for (Eigen::Index n = 1; n < x.size(); ++n) {
    const double steps = (x[n] - x[n - 1]) / step;
    if (std::abs(steps - std::round(steps)) > kOnLattice * std::max(1.0, std::abs(steps))) return 0.0;
  }
  return step;
}

void look_at(const Eigen::MatrixXd& samples, const records::Signals& signals, const char* port, std::vector<std::string>& said) {
  for (Eigen::Index c = 0; c < samples.cols(); ++c) {
    spectrum::SampleWatch watch;
    const Eigen::VectorXd x = samples.col(c);
    watch.add({x.data(), static_cast<std::size_t>(x.size())});
    if (const std::string text = watch.clipping(named(signals, c, port)); !text.empty()) said.push_back(text);
    const double step = lattice_step(x), deviation = std::sqrt((x.array() - x.mean()).square().mean());
    if (step / std::sqrt(12.0) > kCoarse * deviation && step < deviation)
      said.push_back(named(signals, c, port) + " has steps of " + records::short_number(step, 3) + unit_of(signals, c) +
                     ": rounding adds noise of " + records::short_number(step / std::sqrt(12.0), 2) + unit_of(signals, c));
  }
}

}  // namespace

std::vector<std::string> observe(const records::Recording& r) {
  std::vector<std::string> said;
  look_at(r.input, r.input_signals, "input", said);
  look_at(r.output, r.output_signals, "output", said);
  Eigen::Index still = 0, longest = 0, where = 0;
  for (Eigen::Index n = 1; n < r.samples(); ++n) {
    still = r.output(n, 0) == r.output(n - 1, 0) && r.input(n, 0) != r.input(n - 1, 0) ? still + 1 : 0;
    if (still <= longest) continue;
    longest = still;
    where = n - still;
  }
  if (longest >= kStill)
    said.push_back(named(r.output_signals, 0, "output") + " stands still for " + std::to_string(longest) +
                   " samples from sample " + std::to_string(where) + " on while the input moves: lost samples?");
  return said;
}

}  // namespace bodeflow::residual
