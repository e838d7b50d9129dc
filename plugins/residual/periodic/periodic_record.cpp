#include "periodic/periodic_record.hpp"

#include <algorithm>
#include <bodeflow/numerics/fft.hpp>
#include <cmath>

#include "periodic/drift_free.hpp"
#include "periodic/tone_free.hpp"
#include "records/checksum.hpp"
#include "statistics.hpp"

namespace bodeflow::residual {
namespace {

// A line of the input below this fraction of its greatest is rounding, not excitation.
constexpr double kRounding = 1e-9;
// Chance that a line of noise alone in a measured input is taken for an excited one.
constexpr double kFalseLine = 1e-6;
// Lines of a designed excitation that are next in size differ by less than 10 dB in power.
constexpr double kUneven = 10.0;
// The band that is looked at ends above the last excited line, below the Nyquist frequency: harmonics of what is missing show
// there.
constexpr double kBeyond = 1.25;
constexpr Eigen::Index kSkirtBins = 2;
// An input whose unexcited lines hold noise alone is cleared there: chance that noise alone looks like more.
constexpr double kOwnLines = 0.01;

struct Split {
  Eigen::VectorXcd lines;
  Eigen::VectorXd between_hz, between_power;
};

/// Lines of the period, and the bins between them up to the last of `lines`.
Split split(const Eigen::VectorXcd& bins, Eigen::Index periods, Eigen::Index lines, double bin_hz) {
  Split s;
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

Eigen::VectorXcd bins_of(const Eigen::VectorXd& samples) {
  return numerics::half_dft(samples) / static_cast<double>(samples.size());
}

struct InputChannel {
  Eigen::VectorXcd lines;
  std::optional<FloorOfBins> noise;
};

Expected<InputChannel> input_channel(const Eigen::VectorXd& samples, Eigen::Index periods, Eigen::Index lines, double bin_hz,
                                     const std::string& name) {
  const Split s = split(bins_of(samples), periods, lines, bin_hz);
  InputChannel c{s.lines, {}};
  if (!(s.between_power.mean() > kRounding * kRounding * s.lines.cwiseAbs2().maxCoeff())) return c;
  auto noise = FloorOfBins::make(s.between_hz, s.between_power);
  if (!noise) return refused("input '" + name + "': " + noise.error().text);
  c.noise = std::move(*noise);
  return c;
}

/// The lines whose power lies above the widest gap between powers, where it is wider than an excitation is uneven: those below it
/// are what the source adds of its own. All where there is no such gap.
std::vector<Eigen::Index> above_gap(std::vector<Eigen::Index> lines, const Eigen::VectorXd& power) {
  if (lines.size() < 2) return lines;
  std::sort(lines.begin(), lines.end(), [&](Eigen::Index a, Eigen::Index b) { return power[a] > power[b]; });
  std::size_t keep = lines.size();
  double widest = kUneven;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const double gap = power[lines[i - 1]] / power[lines[i]];
    if (gap > widest) widest = gap, keep = i;
  }
  lines.resize(keep);
  return lines;
}

/// Excited lines that the recording states, or those at which an input stands above its noise and its own distortion.
Expected<std::vector<Eigen::Index>> excited_lines(const records::Recording& recording, const std::vector<InputChannel>& inputs,
                                                  double line_hz) {
  std::vector<Eigen::Index> lines(recording.excited_lines.begin(), recording.excited_lines.end());
  if (lines.empty()) {
    for (const InputChannel& c : inputs) {
      const Eigen::VectorXd power = c.lines.cwiseAbs2();
      const double least = kRounding * kRounding * power.tail(power.size() - 1).maxCoeff();
      std::vector<Eigen::Index> seen;
      for (Eigen::Index k = 1; k < power.size(); ++k) {
        const double limit = c.noise ? -std::log(kFalseLine) * c.noise->at(static_cast<double>(k) * line_hz) : 0.0;
        if (power[k] > std::max(least, limit)) seen.push_back(k);
      }
      seen = above_gap(std::move(seen), power);
      lines.insert(lines.end(), seen.begin(), seen.end());
    }
  }
  std::sort(lines.begin(), lines.end());
  lines.erase(std::unique(lines.begin(), lines.end()), lines.end());
  if (lines.empty()) return refused("the input excites no line");
  return lines;
}

void set_kinds(const std::vector<Eigen::Index>& excited, PeriodicRecord& r) {
  const Eigen::Index p = r.periods;
  r.kind.assign(static_cast<std::size_t>(r.bins()), Kind::between);
  const auto kind = [&r](Eigen::Index bin) -> Kind& { return r.kind[static_cast<std::size_t>(bin)]; };
  for (Eigen::Index k = 0; k < r.lines(); ++k) kind(k * p) = k == 0 ? Kind::dc : k % 2 == 0 ? Kind::even : Kind::odd;
  for (const Eigen::Index k : excited) {
    kind(k * p) = Kind::excited;
    for (Eigen::Index d = 1; d <= std::min(kSkirtBins, p - 1); ++d) {
      for (const Eigen::Index bin : {k * p - d, k * p + d})
        if (bin < r.bins() && kind(bin) == Kind::between) kind(bin) = Kind::skirt;
    }
  }
}

/// |Y|^2 over the power of all inputs at every line: between the excited ones straight in its logarithm, beyond them even.
Eigen::VectorXd power_gain(const std::vector<InputChannel>& inputs, const PeriodicRecord& r) {
  std::vector<std::pair<Eigen::Index, double>> known;
  for (Eigen::Index k = 1; k < r.lines(); ++k) {
    const Eigen::Index bin = k * r.periods;
    double power = 0.0;
    for (const InputChannel& c : inputs) power += std::norm(c.lines[k]);
    if (r.kind[static_cast<std::size_t>(bin)] == Kind::excited && power > 0.0 && std::norm(r.output[bin]) > 0.0)
      known.emplace_back(k, std::log(std::norm(r.output[bin]) / power));
  }
  Eigen::VectorXd gain = Eigen::VectorXd::Zero(r.lines());
  if (known.empty()) return gain;
  std::size_t next = 0;
  for (Eigen::Index k = 0; k < r.lines(); ++k) {
    while (next < known.size() && known[next].first < k) ++next;
    const auto& [right, above] = known[std::min(next, known.size() - 1)];
    const auto& [left, below] = known[next > 0 ? next - 1 : 0];
    const double part = right > left ? static_cast<double>(k - left) / static_cast<double>(right - left) : 0.0;
    gain[k] = std::exp(below + std::clamp(part, 0.0, 1.0) * (above - below));
  }
  return gain;
}

/// Sets the noise of measured inputs at the lines that drive the model, and adds what it makes of the output to their variances.
void add_input_noise(const std::vector<InputChannel>& inputs, const std::vector<bool>& drives_all, PeriodicRecord& r) {
  const Eigen::VectorXd gain = power_gain(inputs, r);
  r.input_variance = Eigen::MatrixXd::Zero(r.lines(), static_cast<Eigen::Index>(inputs.size()));
  for (Eigen::Index k = 0; k < r.lines(); ++k) {
    const Eigen::Index bin = k * r.periods;
    const bool always = k == 0 || r.kind[static_cast<std::size_t>(bin)] == Kind::excited;
    for (std::size_t j = 0; j < inputs.size(); ++j) {
      if (!inputs[j].noise || !(always || drives_all[j])) continue;
      const double noise = inputs[j].noise->at(r.frequency_hz[bin]);
      r.input_variance(k, static_cast<Eigen::Index>(j)) = noise;
      r.variance[bin] += gain[k] * noise;
    }
  }
}

/// Whether the lines that are not excited hold more than the noise of that input.
bool has_own_lines(const InputChannel& c, const PeriodicRecord& r) {
  double sum = 0.0;
  std::vector<double> where;
  for (Eigen::Index k = 1; k < r.lines(); ++k) {
    const Eigen::Index bin = k * r.periods;
    if (r.kind[static_cast<std::size_t>(bin)] == Kind::excited) continue;
    sum += std::norm(c.lines[k]) / c.noise->at(r.frequency_hz[bin]);
    where.push_back(r.frequency_hz[bin]);
  }
  if (where.empty()) return true;
  const double count = static_cast<double>(where.size());
  const Eigen::Map<const Eigen::VectorXd> hz(where.data(), static_cast<Eigen::Index>(where.size()));
  return f_tail(sum / count, 2.0 * count, 2.0 / c.noise->relative_variance(hz)) < kOwnLines;
}

/// The period with all but the mean and the excited lines taken out.
Eigen::VectorXd cleared(const Eigen::VectorXd& period, const PeriodicRecord& r) {
  Eigen::VectorXcd full = numerics::dft(period);
  const Eigen::Index n = period.size();
  for (Eigen::Index k = 1; k <= n / 2; ++k) {
    if (k < r.lines() && r.kind[static_cast<std::size_t>(k * r.periods)] == Kind::excited) continue;
    full[k] = 0.0;
    full[n - k] = 0.0;
  }
  return numerics::inverse_dft(full).real();
}

Expected<void> check(const records::Recording& r, const BaseModel& base) {
  const auto inputs = static_cast<Eigen::Index>(base.inputs().size());
  if (base.filter_hz() > 0.0) return refused("the base model forms derivatives of its input; use the engine for given records");
  if (r.input.cols() != inputs || r.output.cols() != 1) {
    return refused("the base model has " + records::counted(inputs, "input") + " and one output, the recording has " +
                   records::counted(r.input.cols(), "input") + " and " + records::counted(r.output.cols(), "output"));
  }
  if (r.period <= 0) return refused("the recording states no period; use the engine for given records");
  if (r.periods < 2) {
    return refused("the recording has " + records::counted(r.periods, "period") +
                   " after the skipped ones, allowed: 2 or more, so that the noise shows between the lines");
  }
  return {};
}

/// The first value that is not finite, by name.
Expected<void> check_finite(const Eigen::MatrixXd& samples, const records::Signals& signals, const char* port) {
  for (Eigen::Index c = 0; c < samples.cols(); ++c)
    for (Eigen::Index n = 0; n < samples.rows(); ++n)
      if (!std::isfinite(samples(n, c))) {
        return refused(std::string(port) + " '" + signals.names[static_cast<std::size_t>(c)] + "' is not finite at sample " +
                       std::to_string(n));
      }
  return {};
}

void take_samples(const records::Recording& recording, PeriodicRecord& r) {
  const Eigen::Index begin = r.skip * r.period, count = r.periods * r.period;
  records::Checksum checksum;
  r.input.resize(r.period, recording.input.cols());
  for (Eigen::Index j = 0; j < recording.input.cols(); ++j) {
    const Eigen::VectorXd u = recording.input.col(j).segment(begin, count);
    checksum.add({u.data(), static_cast<std::size_t>(count)});
    r.input.col(j) = u.reshaped(r.period, r.periods).rowwise().mean();
  }
  const Eigen::VectorXd y = recording.output.col(0).segment(begin, count);
  checksum.add({y.data(), static_cast<std::size_t>(count)});
  r.checksum = checksum.text();
  const Eigen::VectorXd mean = y.reshaped(r.period, r.periods).rowwise().mean();
  const double n = static_cast<double>(r.period);
  r.output_rms = std::sqrt(mean.squaredNorm() / n);
  r.output_peak = mean.cwiseAbs().maxCoeff();
  r.input_rms = std::sqrt(r.input.col(0).squaredNorm() / n);
  r.input_peak = r.input.col(0).cwiseAbs().maxCoeff();
}

}  // namespace

Expected<PeriodicRecord> periodic_record(const records::Recording& recording, std::vector<double> known, const BaseModel& base) {
  if (auto sound = check(recording, base); !sound) return tl::unexpected(sound.error());
  if (auto finite = check_finite(recording.input, recording.input_signals, "input"); !finite)
    return tl::unexpected(finite.error());
  if (auto finite = check_finite(recording.output, recording.output_signals, "output"); !finite)
    return tl::unexpected(finite.error());
  PeriodicRecord r;
  r.input_name = recording.input_signals.names[0];
  r.output_name = recording.output_signals.names[0];
  r.input_unit = recording.input_signals.units[0];
  r.output_unit = recording.output_signals.units[0];
  r.sample_rate_hz = recording.sample_rate_hz;
  r.period = recording.period;
  r.periods = recording.periods;
  r.skip = recording.skip;
  r.known = std::move(known);
  take_samples(recording, r);

  const Eigen::Index begin = r.skip * r.period, count = r.periods * r.period, all = (r.period + 1) / 2;
  const double bin_hz = r.line_hz() / static_cast<double>(r.periods);
  std::vector<InputChannel> inputs;
  for (Eigen::Index j = 0; j < recording.input.cols(); ++j) {
    auto c = input_channel(recording.input.col(j).segment(begin, count), r.periods, all, bin_hz,
                           recording.input_signals.names[static_cast<std::size_t>(j)]);
    if (!c) return tl::unexpected(c.error());
    inputs.push_back(std::move(*c));
  }
  auto excited = excited_lines(recording, inputs, r.line_hz());
  if (!excited) return tl::unexpected(excited.error());
  if (excited->back() >= all) {
    return refused("the last excited line is " + std::to_string(excited->back()) + "; allowed: below the Nyquist frequency, " +
                   std::to_string(all - 1) + " or less");
  }
  const auto lines = std::min(static_cast<Eigen::Index>(kBeyond * static_cast<double>(excited->back())) + 1, all);
  const Eigen::VectorXcd bins = bins_of(recording.output.col(0).segment(begin, count));
  const Split s = split(bins, r.periods, lines, bin_hz);
  if (!(s.between_power.mean() > kRounding * kRounding * s.lines.cwiseAbs2().maxCoeff())) {
    return refused("output '" + r.output_name + "' holds no noise between the lines, so there is nothing to judge a residual by");
  }
  const Eigen::VectorXd calm_power = tone_free_power(bins.head((lines - 1) * r.periods + 1), r.periods, count);
  auto floor = FloorOfBins::make(s.between_hz, calm_power);
  if (!floor) return refused("output '" + r.output_name + "': " + floor.error().text);
  const auto calm = drift_free_floor(recording.output.col(0).segment(begin, count), r.periods, lines, r.line_hz());
  r.floor = calm ? lower_floor(*floor, *calm, s.between_hz) : *floor;
  r.output = bins.head((lines - 1) * r.periods + 1);
  r.frequency_hz = Eigen::VectorXd::LinSpaced(r.bins(), 0.0, static_cast<double>(r.bins() - 1)) * bin_hz;
  r.input_lines.resize(lines, recording.input.cols());
  for (std::size_t j = 0; j < inputs.size(); ++j) r.input_lines.col(static_cast<Eigen::Index>(j)) = inputs[j].lines.head(lines);
  set_kinds(*excited, r);
  r.variance = r.floor.at(r.frequency_hz);
  std::vector<bool> drives_all;
  for (const InputChannel& c : inputs) drives_all.push_back(!c.noise || has_own_lines(c, r));
  add_input_noise(inputs, drives_all, r);
  for (std::size_t j = 0; j < inputs.size(); ++j) {
    const auto column = static_cast<Eigen::Index>(j);
    if (!drives_all[j]) r.input.col(column) = cleared(r.input.col(column), r);
  }
  return r;
}

Eigen::VectorXd whitened(const PeriodicRecord& r, const Eigen::VectorXcd& values) {
  Eigen::VectorXd rows(2 * r.bins() - 1);
  rows[0] = values[0].real() / std::sqrt(r.variance[0]);
  for (Eigen::Index l = 1; l < r.bins(); ++l) {
    const std::complex<double> v = values[l] * std::sqrt(2.0 / r.variance[l]);
    rows[2 * l - 1] = v.real();
    rows[2 * l] = v.imag();
  }
  return rows;
}

Eigen::VectorXcd unwhitened(const PeriodicRecord& r, const Eigen::VectorXd& rows) {
  Eigen::VectorXcd values(r.bins());
  values[0] = rows[0] * std::sqrt(r.variance[0]);
  for (Eigen::Index l = 1; l < r.bins(); ++l)
    values[l] = std::complex<double>(rows[2 * l - 1], rows[2 * l]) * std::sqrt(r.variance[l] / 2.0);
  return values;
}

}  // namespace bodeflow::residual
