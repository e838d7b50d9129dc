#include "experiment.hpp"

#include <algorithm>
#include <bodeflow/numerics/fft.hpp>
#include <cmath>
#include <optional>

#include "records/checksum.hpp"
#include "statistics.hpp"

namespace bodeflow::residual {
namespace {

// A line of the input below this fraction of its greatest is rounding, not excitation.
constexpr double kRounding = 1e-9;
// Chance that a line of noise alone in a measured input is taken for an excited one.
constexpr double kFalseLine = 1e-6;
// The band that is looked at ends above the last excited line: harmonics of what is missing show there.
constexpr double kBeyond = 1.25;
constexpr Eigen::Index kSkirtBins = 2;

struct Spectrum {
  Eigen::VectorXcd lines;  ///< every P-th bin
  Eigen::VectorXd between_hz;
  Eigen::VectorXd between_power;
};

Spectrum spectrum_of(const Eigen::VectorXd& samples, Eigen::Index periods, Eigen::Index lines, double bin_hz) {
  const Eigen::VectorXcd bins = numerics::half_dft(samples) / static_cast<double>(samples.size());
  Spectrum s;
  s.lines.resize(lines);
  for (Eigen::Index k = 0; k < lines; ++k) s.lines[k] = bins[k * periods];
  const Eigen::Index count = (lines - 1) * (periods - 1);
  s.between_hz.resize(count);
  s.between_power.resize(count);
  for (Eigen::Index l = 0, n = 0; n < count; ++l) {
    if (l % periods == 0) continue;
    s.between_hz[n] = static_cast<double>(l) * bin_hz;
    s.between_power[n++] = std::norm(bins[l]);
  }
  return s;
}

/// Excited lines that the recording states, or those of the mean input above its noise.
Expected<std::vector<Eigen::Index>> excited_lines(const records::Recording& recording, const Eigen::VectorXd& mean_input,
                                                  const std::optional<NoiseFloor>& noise, double line_hz) {
  std::vector<Eigen::Index> lines(recording.excited_lines.begin(), recording.excited_lines.end());
  if (lines.empty()) {
    const Eigen::VectorXd power = (numerics::half_dft(mean_input) / static_cast<double>(mean_input.size())).cwiseAbs2();
    const double least = kRounding * kRounding * power.tail(power.size() - 1).maxCoeff();
    for (Eigen::Index k = 1; k < power.size(); ++k) {
      const double limit = noise ? -std::log(kFalseLine) * noise->at(static_cast<double>(k) * line_hz) : 0.0;
      if (power[k] > std::max(least, limit)) lines.push_back(k);
    }
  }
  if (lines.empty()) return refused("the input excites no line");
  std::sort(lines.begin(), lines.end());
  return lines;
}

void set_kinds(const std::vector<Eigen::Index>& excited, Eigen::Index lines, Experiment& e) {
  e.kind.resize(static_cast<std::size_t>(lines));
  for (std::size_t k = 0; k < e.kind.size(); ++k) e.kind[k] = k == 0 ? Kind::dc : k % 2 == 0 ? Kind::even : Kind::odd;
  for (const Eigen::Index k : excited) e.kind[static_cast<std::size_t>(k)] = Kind::excited;
  e.frequency_hz =
      Eigen::VectorXd::LinSpaced(lines, 0.0, static_cast<double>(lines - 1)) * e.sample_rate_hz / static_cast<double>(e.period);
  e.skirt.assign(static_cast<std::size_t>(e.between.size()), false);
  const Eigen::Index gap = e.periods - 1;
  for (const Eigen::Index k : excited) {
    for (Eigen::Index d = 0; d < std::min(kSkirtBins, gap); ++d) {
      const Eigen::Index above = k * gap + d, below = k * gap - 1 - d;
      if (above < e.between.size()) e.skirt[static_cast<std::size_t>(above)] = true;
      if (below >= 0) e.skirt[static_cast<std::size_t>(below)] = true;
    }
  }
}

/// Adds the noise of a measured input to the variances, and clears what it does not excite.
void use_measured_input(const NoiseFloor& noise, const Eigen::VectorXcd& input_lines, Experiment& e) {
  double excess = 0.0, count = 0.0;
  for (Eigen::Index k = 1; k < e.lines(); ++k) {
    const double level = noise.at(e.frequency_hz[k]);
    if (e.kind[static_cast<std::size_t>(k)] == Kind::excited) {
      e.variance[k] += std::norm(e.output[k] / input_lines[k]) * level;
    } else {
      excess += std::norm(input_lines[k]) / level;
      ++count;
    }
  }
  const double nu = 2.0 / noise.relative_variance(e.frequency_hz);
  if (count == 0.0 || f_tail(excess / count, 2.0 * count, nu) < 0.01) return;
  Eigen::VectorXcd full = numerics::dft(e.input);
  for (Eigen::Index k = 0; k <= e.period / 2; ++k) {
    if (k < e.lines() && e.kind[static_cast<std::size_t>(k)] == Kind::excited) continue;
    full[k] = 0.0;
    if (k > 0) full[e.period - k] = 0.0;
  }
  e.input = numerics::inverse_dft(full).real();
}

Expected<void> check(const records::Recording& r) {
  if (r.input.cols() != 1 || r.output.cols() != 1) {
    return refused("the tracer takes one input and one output, the recording has " + records::counted(r.input.cols(), "input") +
                   " and " + records::counted(r.output.cols(), "output"));
  }
  if (r.period <= 0) return refused("the recording states no period; the tracer needs a periodic excitation");
  if (r.periods < 2) {
    return refused("the recording has " + records::counted(r.periods, "period") +
                   " after the skipped ones, allowed: 2 or more, so that the noise shows between the lines");
  }
  return {};
}

}  // namespace

Expected<Experiment> experiment_of(const records::Recording& recording, const std::string& name) {
  if (auto sound = check(recording); !sound) return tl::unexpected(sound.error());
  Experiment e;
  e.name = name;
  e.input_name = recording.input_signals.names[0];
  e.output_name = recording.output_signals.names[0];
  e.input_unit = recording.input_signals.units[0];
  e.output_unit = recording.output_signals.units[0];
  e.sample_rate_hz = recording.sample_rate_hz;
  e.period = recording.period;
  e.periods = recording.periods;
  const Eigen::Index begin = recording.skip * e.period, count = e.periods * e.period;
  const Eigen::VectorXd u = recording.input.col(0).segment(begin, count), y = recording.output.col(0).segment(begin, count);
  records::Checksum checksum;
  checksum.add({u.data(), static_cast<std::size_t>(count)});
  checksum.add({y.data(), static_cast<std::size_t>(count)});
  e.checksum = checksum.text();
  e.input = u.reshaped(e.period, e.periods).rowwise().mean();

  const double line_hz = e.sample_rate_hz / static_cast<double>(e.period), bin_hz = line_hz / static_cast<double>(e.periods);
  const Eigen::Index all = (e.period + 1) / 2;
  const Spectrum of_input = spectrum_of(u, e.periods, all, bin_hz);
  std::optional<NoiseFloor> input_noise;
  const double largest = of_input.lines.cwiseAbs2().maxCoeff();
  if (of_input.between_power.mean() > kRounding * kRounding * largest) {
    auto noise = NoiseFloor::from_bins(of_input.between_hz, of_input.between_power);
    if (!noise) return refused("input '" + e.input_name + "': " + noise.error().text);
    input_noise = *noise;
  }
  auto excited = excited_lines(recording, e.input, input_noise, line_hz);
  if (!excited) return tl::unexpected(excited.error());
  const auto lines = static_cast<Eigen::Index>(kBeyond * static_cast<double>(excited->back())) + 1;
  if (lines > all) {
    return refused("the last excited line is " + std::to_string(excited->back()) + " of " + std::to_string(all) +
                   " below the Nyquist frequency; allowed: up to 0.8 of it, sample faster");
  }
  const Spectrum s = spectrum_of(y, e.periods, lines, bin_hz);
  if (!(s.between_power.mean() > kRounding * kRounding * s.lines.cwiseAbs2().maxCoeff())) {
    return refused("output '" + e.output_name + "' holds no noise between the lines, so there is nothing to judge a residual by");
  }
  auto floor = NoiseFloor::from_bins(s.between_hz, s.between_power);
  if (!floor) return refused("output '" + e.output_name + "': " + floor.error().text);
  e.floor = *floor;
  e.output = s.lines;
  e.input_lines = of_input.lines.head(lines);
  e.between_hz = s.between_hz;
  e.between = s.between_power.cwiseQuotient(e.floor.at(s.between_hz));
  set_kinds(*excited, lines, e);
  e.variance = e.floor.at(e.frequency_hz);
  if (input_noise) use_measured_input(*input_noise, e.input_lines, e);
  return e;
}

}  // namespace bodeflow::residual
