#include "resampler.hpp"

#include <algorithm>
#include <bodeflow/numerics/fir.hpp>
#include <cmath>
#include <string>

namespace bodeflow::acquisition {
namespace {

// Kaiser's formula for the length is good to about 1 dB.
constexpr double kMarginDb = 2.0;
// Phases between which cubics interpolate: (pi / 256)^4 3 / 128 = 5e-10 of the highest frequency.
constexpr std::int64_t kDriftPhases = 256;

std::int64_t floor_divide(std::int64_t a, std::int64_t b) { return a / b - (a % b < 0 ? 1 : 0); }
std::int64_t ceil_divide(std::int64_t a, std::int64_t b) { return -floor_divide(-a, b); }

numerics::LowPass design_of(const ResamplerSpec& spec, std::int64_t phases) {
  const double lower = std::min(1.0, static_cast<double>(spec.up) / static_cast<double>(spec.down));
  const double nyquist = lower / static_cast<double>(phases);
  return {spec.pass_band * nyquist, nyquist, spec.attenuation_db + kMarginDb};
}

/// Rows of the table for each phase: h at the 2 reach + 1 input samples around an output, the earliest first.
std::vector<double> table_of(const ResamplerPlan& plan) {
  const Eigen::VectorXd taps =
      static_cast<double>(plan.phases) * numerics::low_pass(design_of(plan.spec, plan.phases), plan.half);
  std::vector<double> table;
  for (std::int64_t phase = -1; phase <= plan.phases + 1; ++phase) {
    for (std::int64_t i = plan.reach; i >= -plan.reach; --i) {
      const std::int64_t at = plan.half + phase + i * plan.phases;
      table.push_back(at >= 0 && at < taps.size() ? taps[at] : 0.0);
    }
  }
  return table;
}

}  // namespace

numerics::Expected<ResamplerPlan> plan_resampler(const ResamplerSpec& spec) {
  if (spec.up > kMostPhases || spec.down > kMostPhases) {
    return numerics::refused("the output rate is " + std::to_string(spec.up) + "/" + std::to_string(spec.down) +
                             " of the input rate; numbers up to " + std::to_string(kMostPhases) +
                             " are possible: choose a rate in a simpler ratio, and `drift` for small deviations");
  }
  ResamplerPlan plan;
  plan.spec = spec;
  const bool drifts = std::abs(spec.drift) > 0.0;
  if (!drifts && spec.up == 1 && spec.down == 1) return plan;
  plan.phases = drifts ? kDriftPhases : spec.up;
  const auto half = numerics::low_pass_half_length(design_of(spec, plan.phases));
  if (!half) return tl::make_unexpected(half.error());
  plan.half = *half;
  plan.reach = plan.half / plan.phases + (drifts ? 2 : 1);
  // The last sample that an output needs comes within its firing; a fast input clock needs `buffer` more. Before the first sample
  // drift counts backward, as far as h reaches.
  const auto margin = static_cast<std::int64_t>(std::ceil(std::abs(spec.drift) * static_cast<double>(plan.reach + 3)));
  const std::int64_t ahead = plan.reach + 1 + margin + (spec.drift > 0.0 ? spec.buffer + 1 : 0);
  plan.delay = ceil_divide(ahead * spec.up, spec.down);
  plan.past = ceil_divide(plan.delay * spec.down, spec.up) + plan.reach + 2 + margin + (spec.drift < 0.0 ? spec.buffer : 0);
  return plan;
}

Resampler::Resampler(const ResamplerPlan& plan, std::int64_t channels, std::int64_t max_count)
    : plan_(plan), frames_(static_cast<std::size_t>(channels)) {
  if (plan.is_wire()) return;
  table_ = table_of(plan);
  // Room for as many samples as are kept, so that these are moved seldom.
  for (Frame& frame : frames_) frame.samples.resize(static_cast<std::size_t>(2 * plan.past + max_count * plan.spec.down));
  reset();
}

void Resampler::reset() {
  for (Frame& frame : frames_) {
    std::fill(frame.samples.begin(), frame.samples.end(), 0.0);
    frame.begin = -plan_.past;
    frame.end = 0;
  }
}

void Resampler::append(Frame& frame, std::span<const double> x) const {
  const auto held = static_cast<std::size_t>(frame.end - frame.begin);
  if (held + x.size() > frame.samples.size()) {
    std::copy_n(frame.samples.begin() + static_cast<std::ptrdiff_t>(held) - plan_.past, plan_.past, frame.samples.begin());
    frame.begin = frame.end - plan_.past;
  }
  std::copy(x.begin(), x.end(), frame.samples.begin() + (frame.end - frame.begin));
  frame.end += static_cast<std::int64_t>(x.size());
}

/// The output at input sample `whole` + phase / phases.
double Resampler::at_phase(const Frame& frame, std::int64_t whole, std::int64_t phase) const {
  const std::int64_t taps = 2 * plan_.reach + 1;
  return numerics::dot(frame.samples.data() + (whole - plan_.reach - frame.begin), table_.data() + (phase + 1) * taps,
                       static_cast<std::size_t>(taps));
}

bool Resampler::run(std::int64_t channel, std::int64_t first, std::span<const double> x, std::span<double> y) {
  if (plan_.is_wire()) {
    std::copy(x.begin(), x.end(), y.begin());
    return true;
  }
  Frame& frame = frames_[static_cast<std::size_t>(channel)];
  append(frame, x);
  const ResamplerSpec& spec = plan_.spec;
  const bool drifts = std::abs(spec.drift) > 0.0;
  const auto phases = static_cast<double>(plan_.phases);
  for (std::size_t k = 0; k < y.size(); ++k) {
    const std::int64_t index = (first * spec.up + static_cast<std::int64_t>(k) - plan_.delay) * spec.down;
    const std::int64_t whole = floor_divide(index, spec.up), rest = index - whole * spec.up;
    if (!drifts) {
      y[k] = at_phase(frame, whole, rest);
      continue;
    }
    if (whole < -plan_.reach - 2) {
      y[k] = 0.0;
      continue;
    }
    const double fraction = static_cast<double>(rest) / static_cast<double>(spec.up);
    const double shift = spec.drift * (static_cast<double>(whole) + fraction);
    if (index > 0 && std::abs(shift) > static_cast<double>(spec.buffer)) {
      std::fill(y.begin() + static_cast<std::ptrdiff_t>(k), y.end(), 0.0);
      return false;
    }
    const double position = fraction + shift, steps = std::floor(position);
    const double phase = (position - steps) * phases, step = std::min(std::floor(phase), phases - 1.0), t = phase - step;
    const std::int64_t n = whole + static_cast<std::int64_t>(steps), r = static_cast<std::int64_t>(step);
    // Lagrange's cubic through the phases r - 1 to r + 2.
    y[k] = -t * (t - 1) * (t - 2) / 6 * at_phase(frame, n, r - 1) + (t + 1) * (t - 1) * (t - 2) / 2 * at_phase(frame, n, r) -
           (t + 1) * t * (t - 2) / 2 * at_phase(frame, n, r + 1) + (t + 1) * t * (t - 1) / 6 * at_phase(frame, n, r + 2);
  }
  return true;
}

}  // namespace bodeflow::acquisition
