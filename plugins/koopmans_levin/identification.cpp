#include "identification.hpp"

#include <algorithm>
#include <cmath>

#include "influence.hpp"
#include "maximum_likelihood.hpp"
#include "order_and_ratio.hpp"
#include "time_domain.hpp"

namespace bodeflow::koopmans_levin {

namespace {

// Noise below this share of the greatest eigenvalue is rounding.
constexpr double kRounding = 1e-24;
constexpr Eigen::Index kMostBands = 20;
constexpr Eigen::Index kLinesOfBand = 10;
constexpr double kFactor = 2.0;  // of the ratio, whose effect is told

using Samples = Eigen::Ref<const Eigen::VectorXd>;

Expected<void> check(const Settings& s) {
  if (s.refine && !s.transient) return refused("refine: maximum_likelihood needs transient: true");
  if (s.route == Route::frequency_domain) return {};
  if (s.band) return refused("route: time_domain is the full range: leave out band");
  if (!s.transient) return refused("route: time_domain needs transient: true, which is part of it");
  return {};
}

/// The settings with the output noise that the lines of the noise band show.
Expected<Settings> with_measured_noise(const Samples& input, const Samples& output, Settings s) {
  if (!s.noise_band) return s;
  const auto empty = lines_of(input, output, s.noise_band);
  if (!empty) return tl::make_unexpected(empty.error());
  s.output_noise = noise_floor(empty->output);
  // |X|^2 at a line is exponentially distributed.
  s.output_noise_std = *s.output_noise / std::sqrt(static_cast<double>(empty->size()));
  return s;
}

Expected<Solution> solved(const Samples& input, const Samples& output, const Factors& f, double ratio, const Settings& s) {
  auto solution = solve(f, ratio, s.noise_matrix);
  if (!solution || s.route == Route::frequency_domain) return solution;
  const auto in_time = time_domain_factors(input, output, f.order);
  if (!in_time) return tl::make_unexpected(in_time.error());
  auto classical = solve(*in_time, ratio);
  if (classical) classical->tau = solution->tau;
  return classical;
}

/// The refined model at a ratio, from the solution there.
Expected<RefinedModel> refined_at(const Lines& lines, const Factors& f, double ratio) {
  const auto start = solve(f, ratio);
  if (!start) return tl::make_unexpected(start.error());
  return maximum_likelihood(lines, *start);
}

/// Half of what the refined parameters move by between both ends of the ratio's standard deviation.
Expected<Eigen::VectorXd> moved_by_ratio(const Lines& lines, const Factors& f, const RatioEstimate& e) {
  const double step = std::exp(e.log_ratio_std);
  const auto below = refined_at(lines, f, e.ratio / step), above = refined_at(lines, f, e.ratio * step);
  if (!below) return tl::make_unexpected(below.error());
  if (!above) return tl::make_unexpected(above.error());
  return Eigen::VectorXd(0.5 * (parameters(above->model) - parameters(below->model)));
}

/// Takes the solution, with its covariance where there is one.
Expected<void> take(const Solution& solution, const Factors& f, Identification& found) {
  found.model = solution;
  const Eigen::Index size = 2 * f.order + 1;
  const bool estimated = found.estimate && found.estimate->determined;
  if (!estimated && solution.noise_matrix == NoiseMatrix::identity && !found.lines.is_full_range()) return {};
  auto all = estimated ? Expected<Eigen::MatrixXd>(found.estimate->covariance) : covariance(found.lines, f, solution);
  if (!all) return tl::make_unexpected(all.error());
  found.covariance = all->topLeftCorner(size, size);
  found.noise_std = std::sqrt((*all)(size, size));
  if (estimated || found.noise_free) return {};
  auto sensitivity = ratio_sensitivity(f, solution, found.covariance, kFactor);
  if (sensitivity) found.sensitivity = std::move(*sensitivity);
  return {};
}

/// Takes the refined model.
Expected<void> refine(const Solution& start, const Factors& f, Identification& found) {
  auto refined = maximum_likelihood(found.lines, start);
  if (!refined) return tl::make_unexpected(refined.error());
  if (!refined->converged) found.refinement = refined->reason;
  found.model = refined->model;
  found.covariance = refined->covariance;
  // The noise variance is a mean over the equations, its deviation that of a chi-squared variable.
  const auto free = static_cast<double>(f.equations - f.free_parameters);
  found.noise_std = found.model.noise_unbiased * std::sqrt(2.0 / free);
  if (found.estimate && found.estimate->determined) {
    const auto moved = moved_by_ratio(found.lines, f, *found.estimate);
    if (!moved) return tl::make_unexpected(moved.error());
    found.covariance += *moved * moved->transpose();
    return {};
  }
  const auto below = refined_at(found.lines, f, start.ratio / kFactor), above = refined_at(found.lines, f, start.ratio * kFactor);
  if (below && above) {
    found.sensitivity =
        ratio_sensitivity(parameters(found.model), parameters(below->model), parameters(above->model), found.covariance, kFactor);
  }
  return {};
}

void test_whiteness(Identification& found) {
  Eigen::Index complex_lines = 0;
  for (Eigen::Index i = 0; i < found.lines.size(); ++i) complex_lines += found.lines.is_real(i) ? 0 : 1;
  const Eigen::Index bands = std::min(kMostBands, complex_lines / kLinesOfBand);
  if (bands < 2 || !(found.model.noise > 0.0)) return;
  auto test = whiteness(found.lines, found.model, bands);
  if (test) found.whiteness = std::move(*test);
}

}  // namespace

Expected<Identification> identify(const Samples& input, const Samples& output, const Settings& given) {
  if (auto fine = check(given); !fine) return tl::make_unexpected(fine.error());
  auto lines = lines_of(input, output, given.band);
  if (!lines) return tl::make_unexpected(lines.error());
  const auto settings = with_measured_noise(input, output, given);
  if (!settings) return tl::make_unexpected(settings.error());
  auto chosen = order_and_ratio(*lines, *settings);
  if (!chosen) return tl::make_unexpected(chosen.error());
  const auto f = quick_factors(*lines, chosen->order, settings->transient);
  if (!f) return tl::make_unexpected(f.error());
  const auto solution = solved(input, output, *f, chosen->ratio, *settings);
  if (!solution) return tl::make_unexpected(solution.error());

  Identification found;
  found.lines = std::move(*lines);
  found.free_parameters = f->free_parameters;
  found.noise_free = !(solution->noise > kRounding * solution->squares[0]);
  found.ratio_source = chosen->source;
  found.estimate = std::move(chosen->estimate);
  found.scan = std::move(chosen->scan);
  const auto done = settings->refine && !found.noise_free ? refine(*solution, *f, found) : take(*solution, *f, found);
  if (!done) return tl::make_unexpected(done.error());
  test_whiteness(found);
  return found;
}

}  // namespace bodeflow::koopmans_levin
