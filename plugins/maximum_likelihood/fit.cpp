#include "fit.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "hold.hpp"
#include "linear_start.hpp"
#include "starts.hpp"

namespace bodeflow::maximum_likelihood {

namespace {

constexpr double kRough = 1e-7;  // tolerance of a first search, which only ranks the starts
constexpr int kRoughEvaluations = 60;
constexpr double kFine = 1e-13;
constexpr int kFineEvaluations = 500;
constexpr double kSameCost = 1e-6;   // relative: another way to the same minimum
constexpr double kRounding = 1e-20;  // of the power of the data: costs below are alike
constexpr int kHoldIterations = 60;
constexpr double kHoldStays = 1e-13;  // change of the images, of the largest |G|

Expected<void> check_size(const Spectra& spectra, const Structure& structure) {
  const Eigen::Index parameters = structure.parameters();
  const double equations = 2.0 * spectra.equations();
  if (parameters < 1) return refused("all coefficients are fixed");
  if (equations > static_cast<double>(parameters)) return {};
  return refused(std::to_string(spectra.lines()) + (spectra.lines() == 1 ? " line is" : " lines are") + " too few for " +
                 std::to_string(parameters) + " parameters: each complex line and output gives two equations, and more than " +
                 std::to_string(parameters) + " are needed; lower the order or measure more lines");
}

// Keeps the better of two minima and writes the attempt down.
void attempt(Fit& fit, std::optional<Minimum>& best, const Start& start) {
  const auto found = search(fit.lines, fit.structure, start.estimate, kRough, kRoughEvaluations);
  if (!found || !std::isfinite(found->cost)) return;
  fit.attempts.push_back({start.name, start.estimate.delay_s, start.cost, found->cost});
  if (!best || found->cost < best->cost) best = *found;
}

// Models, residuals and response, the hold's images aside.
Expected<void> describe(Fit& fit, const Spectra& spectra) {
  fit.models.clear();
  fit.response.resize(spectra.lines(), spectra.outputs());
  for (std::size_t i = 0; i < fit.lines.channels.size(); ++i) {
    const auto model = rational_of(fit.lines, fit.structure, fit.minimum.estimate, i, spectra.sample_time_s);
    if (!model) return refusal_in(model);
    fit.models.push_back(*model);
    for (Eigen::Index k = 0; k < spectra.lines(); ++k) {
      const double omega = spectra.omega_rad_s[k];
      const auto hold = fit.structure.zero_order_hold ? hold_factor(omega, spectra.sample_time_s) : 1.0;
      fit.response(k, static_cast<Eigen::Index>(i)) = hold * model->response(omega);
    }
  }
  fit.residuals = residuals(fit.lines, fit.minimum.estimate);
  return {};
}

Expected<void> polish(Fit& fit, const Estimate& from) {
  const auto fine = search(fit.lines, fit.structure, from, kFine, kFineEvaluations);
  if (!fine) return refusal_in(fine);
  fit.minimum = *fine;
  return {};
}

// Images of the hold and model in turn, until the images stay.
Expected<void> settle_hold(Fit& fit, const Spectra& spectra) {
  Eigen::MatrixXcd before = Eigen::MatrixXcd::Zero(spectra.lines(), spectra.outputs());
  const double largest = spectra.response().cwiseAbs().maxCoeff();
  for (int n = 0; n < kHoldIterations; ++n) {
    const auto added = images(spectra.omega_rad_s, spectra.sample_time_s, fit.models);
    if (!added) return refused("hold: zero_order: " + added.error().text);
    const double change = (*added - before).cwiseAbs().maxCoeff();
    before = *added;
    remove_hold(fit.lines, spectra, fit.structure, before);
    if (const auto done = polish(fit, fit.minimum.estimate); !done) return done;
    if (const auto done = describe(fit, spectra); !done) return done;
    fit.response += before;
    if (change < kHoldStays * largest) return {};
  }
  fit.minimum.converged = false;
  fit.minimum.reason = "the images of the hold and the model do not settle on each other";
  return {};
}

Expected<void> finish(Fit& fit, const Spectra& spectra) {
  if (const auto done = polish(fit, fit.minimum.estimate); !done) return done;
  if (const auto done = describe(fit, spectra); !done) return done;
  return fit.structure.zero_order_hold ? settle_hold(fit, spectra) : Expected<void>{};
}

// A delay that the search took out of its range goes to the end of it and stays there.
Expected<void> keep_in_range(Fit& fit, const Spectra& spectra) {
  const double delay = fit.minimum.estimate.delay_s;
  if (!fit.structure.estimate_delay || (delay >= fit.structure.delay_low_s && delay <= fit.structure.delay_high_s)) return {};
  fit.structure.estimate_delay = false;
  fit.structure.delay_s = std::clamp(delay, fit.structure.delay_low_s, fit.structure.delay_high_s);
  fit.minimum.estimate.delay_s = fit.structure.delay_s;
  fit.delay_at_bound = true;
  return finish(fit, spectra);
}

}  // namespace

double widest_delay(const Spectra& s) {
  const double highest = s.omega_rad_s[s.lines() - 1];
  if (!(highest > 0.0)) return 0.0;
  double spacing = highest;
  for (Eigen::Index k = 1; k < s.lines(); ++k) spacing = std::min(spacing, s.omega_rad_s[k] - s.omega_rad_s[k - 1]);
  return std::min(10.0 * std::numbers::pi / highest, std::numbers::pi / spacing);
}

Expected<Fit> fit_model(const Spectra& spectra, const Structure& structure, int starts, const Fit* grown_from) {
  if (const auto fits = check(spectra); !fits) return refusal_in(fits);
  if (const auto fits = check(structure, spectra.outputs(), spectra.sample_time_s); !fits) return refusal_in(fits);
  if (const auto fits = check_size(spectra, structure); !fits) return refusal_in(fits);
  auto lines = lines_for(spectra, structure);
  if (!lines) return refusal_in(lines);
  Fit fit;
  fit.structure = structure;
  fit.lines = std::move(*lines);
  if (structure.zero_order_hold)
    remove_hold(fit.lines, spectra, structure, Eigen::MatrixXcd::Zero(spectra.lines(), spectra.outputs()));

  std::optional<Minimum> best;
  const std::vector<double> delays = promising_delays(fit.lines, structure);
  std::vector<Start> tried = linear_starts(fit.lines, structure, delays);
  if (tried.empty()) {
    const auto why = linear_start(fit.lines, structure, delays.front(), {}, 1);
    return refused("no start for a search" + (why ? std::string() : ": " + why.error().text));
  }
  if (tried.size() > static_cast<std::size_t>(std::max(starts, 1))) tried.resize(static_cast<std::size_t>(std::max(starts, 1)));
  for (const Start& start : tried) attempt(fit, best, start);
  if (grown_from != nullptr && structure.fixed.empty()) {
    for (const Start& start : grown(fit.lines, structure, *grown_from)) attempt(fit, best, start);
  }
  if (!best) return refused("no search from the starts ended at a finite cost");
  fit.minimum = *best;
  for (const Start& start : reflected(fit)) attempt(fit, best, start);
  fit.minimum = *best;
  if (const auto done = finish(fit, spectra); !done) return refusal_in(done);
  if (const auto done = keep_in_range(fit, spectra); !done) return refusal_in(done);
  fit.correlation = line_correlation(fit.lines, fit.structure, fit.minimum.estimate, spectra.correlated_lines);
  fit.inflation = score_inflation(fit.lines, fit.structure, fit.minimum.estimate, fit.correlation);
  const double least = best->cost;  // before the images of a hold
  fit.reached = std::count_if(fit.attempts.begin(), fit.attempts.end(), [&](const Attempt& a) {
    return a.cost <= least * (1.0 + kSameCost) + spectra.power() * kRounding;
  });
  return fit;
}

}  // namespace bodeflow::maximum_likelihood
