#include "model_warnings.hpp"

#include <algorithm>
#include <bodeflow/numerics/polynomial.hpp>
#include <cmath>
#include <complex>
#include <numbers>

#include "records/signals.hpp"

namespace bodeflow::koopmans_levin {

namespace {

using records::counted;
using records::short_number;

using Texts = std::vector<std::string>;

constexpr double kLeastProbability = 0.01;
constexpr double kFewEquations = 5.0;  // times the parameters: fewer, and covariances are too small
constexpr double kOffset = 16.0;       // |error|^2 over its variance: four standard deviations

double hertz(double omega, double sample_rate_hz) { return omega * sample_rate_hz / (2.0 * std::numbers::pi); }

std::string shortened(double value) { return short_number(value, 3); }

std::string probability_text(double p) { return p < 1e-12 ? "below 1e-12" : shortened(p); }

void warn_of_ratio(const Identification& found, Texts& warnings) {
  if (found.ratio_source == RatioSource::fallback) {
    warnings.push_back(found.estimate->reason + "; the model is that of fallback_ratio " + shortened(found.model.ratio) +
                       ": measure the noise (output_noise, noise_band), or record longer");
  }
  if (!found.sensitivity) return;
  Eigen::Index worst = 0;
  const double shift = found.sensitivity->shift_in_std.maxCoeff(&worst);
  if (!(shift > 1.0)) return;
  const auto moved = (found.sensitivity->shift_in_std.array() > 1.0).count();
  warnings.push_back("a factor " + shortened(found.sensitivity->factor) + " in the noise ratio moves " +
                     counted(moved, "parameter") + " by more than one standard deviation, " +
                     parameter_names(found.model.order())[static_cast<std::size_t>(worst)] + " by " + shortened(shift) +
                     ": measure the noise (output_noise, noise_band) or estimate the ratio (ratio: auto)");
}

void warn_of_order(const Identification& found, Texts& warnings) {
  if (!found.scan || found.scan->chosen > 0) return;
  warnings.push_back("no order was found: the noise still falls at order " + std::to_string(found.model.order()) +
                     ", the highest tried; raise highest_order, narrow the band, or give the order (see order_scan)");
}

void warn_of_errors(const Identification& found, double sample_rate_hz, Texts& warnings) {
  if (!found.whiteness || found.noise_free || !(found.whiteness->probability < kLeastProbability)) return;
  const Whiteness& w = *found.whiteness;
  Eigen::Index worst = 0;
  (w.band_mean.array() - 1.0).abs().maxCoeff(&worst);
  const double half = 0.5 * (w.band_omega[1] - w.band_omega[0]);
  const double from = hertz(std::max(0.0, w.band_omega[worst] - half), sample_rate_hz),
               to = hertz(w.band_omega[worst] + half, sample_rate_hz);
  warnings.push_back("the equation errors are not white (probability " + probability_text(w.probability) + "): from " +
                     shortened(from) + " to " + shortened(to) + " Hz they have " + shortened(w.band_mean[worst]) +
                     " times the power that white noises give them; the noise is coloured, the order too low or the ratio wrong: "
                     "raise the order, or choose the band where the noise is white");
}

void warn_of_offset(const Identification& found, double sample_rate_hz, Texts& warnings) {
  if (found.noise_free || found.lines.k[0] != 0) return;
  const double share = std::norm(equation_errors(found.lines, found.model)[0]) / equation_variances(found.lines, found.model)[0];
  // Noise that is stronger towards low frequencies is no offset.
  const double beside = found.whiteness ? std::max(1.0, found.whiteness->band_mean[0]) : 1.0;
  if (!(share > kOffset * beside)) return;
  warnings.push_back("the mean values lie " + shortened(std::sqrt(share)) +
                     " standard deviations off the model: an offset of a sensor; leave line 0 out with a band from " +
                     shortened(sample_rate_hz / static_cast<double>(found.lines.samples)) + " Hz on");
}

void warn_of_poles(const Identification& found, double sample_rate_hz, Texts& warnings) {
  const auto roots = numerics::roots(found.model.a);
  if (!roots) return;
  std::string places;
  std::int64_t count = 0;
  for (const std::complex<double> z : *roots) {
    if (!(std::abs(z) > 1.0)) continue;
    ++count;
    if (z.imag() < 0.0) continue;
    const double frequency = hertz(std::abs(std::log(z)), sample_rate_hz);
    places += (places.empty() ? "" : ", ") + shortened(frequency) + " Hz";
  }
  if (count == 0) return;
  warnings.push_back(
      counted(count, "pole") + " outside the unit circle (" + places +
      "): if the plant is stable, the data are too few or too noisy there; record longer, lower the order, or choose "
      "the band that is excited");
}

void warn_of_settings(const Identification& found, const Settings& s, bool periodic, Texts& warnings) {
  if (s.noise_matrix == NoiseMatrix::identity && !found.lines.is_full_range())
    warnings.push_back(
        "noise_matrix: identity is wrong on a band: the response is biased, the noise variance far too small, and no covariance "
        "is right; it is there for comparison, use exact");
  if (!s.transient && !periodic)
    warnings.push_back(
        "transient: false is right for whole periods in steady state alone; elsewhere the ends of the record bias the model");
  if (found.refinement) warnings.push_back("the search for the maximum of the likelihood did not converge: " + *found.refinement);
}

}  // namespace

std::vector<std::string> model_warnings(const Identification& found, const Settings& settings, double sample_rate_hz,
                                        bool periodic) {
  Texts warnings;
  warn_of_ratio(found, warnings);
  warn_of_order(found, warnings);
  const auto equations = found.lines.equations();
  if (static_cast<double>(equations) < kFewEquations * static_cast<double>(found.free_parameters)) {
    warnings.push_back("few lines: " + counted(equations, "equation") + " for " + counted(found.free_parameters, "parameter") +
                       "; deviations are too small below " + shortened(kFewEquations) +
                       " times as many: record longer, widen the band, or lower the order");
  }
  warn_of_errors(found, sample_rate_hz, warnings);
  warn_of_offset(found, sample_rate_hz, warnings);
  warn_of_poles(found, sample_rate_hz, warnings);
  warn_of_settings(found, settings, periodic, warnings);
  return warnings;
}

}  // namespace bodeflow::koopmans_levin
