#include "largest_bandwidth.hpp"

#include <bodeflow/numerics/polynomial.hpp>
#include <cmath>

#include "pole_patterns.hpp"

namespace bodeflow::adaptive_control {
namespace {

constexpr double kStep = 1.01;
constexpr double kFurthest = 100.0;  // factors beyond it, up or down, are not tried

struct Question {
  const RstStructure& structure;
  const DesiredResponse& desired;
  const std::vector<std::complex<double>>& response;
  const std::optional<SampledPlant>& plant;
  const AcceptanceLimits& limits;

  Expected<bool> good(double factor) const {
    const DesiredResponse demands = scaled(desired, factor);
    const auto g_m = desired_points(demands, structure.sample_time, structure.omega);
    if (!g_m) return refused(g_m.error().text);
    const auto a_o = sampled_observer(demands.a_o, structure.sample_time);
    if (!a_o) return refused(a_o.error().text);
    const auto design = RstDesign::make(structure, *g_m, *a_o);
    if (!design) return refused(design.error().text);
    RstResult result;
    if (!design->solve(response.data(), result)) return false;
    if (!plant) return judge(*design, result, response.data(), limits).refusal == Refusal::none;
    if (!roots_inside(result.r_bar, design->n_r_bar(), 1.0)) return false;
    const auto quality = loop_quality(*plant, result.rst);
    return quality && quality->largest_pole < 1.0;
  }
};

}  // namespace

double bandwidth_of(const Eigen::VectorXd& a_m) {
  const double rest = a_m[a_m.size() - 1];
  const auto gain = [&](double w) { return std::abs(rest / numerics::evaluate(a_m, {0.0, w})); };
  const double half = 1.0 / std::sqrt(2.0);
  double low = 0.0, high = std::pow(rest / a_m[0], 1.0 / static_cast<double>(a_m.size() - 1));
  while (gain(high) > half) low = high, high *= 2.0;
  for (int i = 0; i < 60; ++i) (gain(0.5 * (low + high)) > half ? low : high) = 0.5 * (low + high);
  return 0.5 * (low + high);
}

Expected<BandwidthLimit> largest_bandwidth(const RstStructure& structure, const DesiredResponse& desired,
                                           const std::vector<std::complex<double>>& response,
                                           const std::optional<SampledPlant>& plant, const AcceptanceLimits& limits) {
  if (response.size() != structure.omega.size()) return refused("one point of the plant's response is needed for each frequency");
  const Question question{structure, desired, response, plant, limits};
  const auto first = question.good(1.0);
  if (!first) return refused(first.error().text);
  double good = 1.0, bad = 1.0;
  bool bracketed = false;
  const double step = *first ? kStep : 1.0 / kStep;
  for (double factor = step; factor < kFurthest && factor > 1.0 / kFurthest; factor *= step) {
    const auto answer = question.good(factor);
    if (!answer) return refused(answer.error().text);
    (*answer ? good : bad) = factor;
    bracketed = *answer != *first;
    if (bracketed) break;
  }
  if (!bracketed && !*first) return BandwidthLimit{};
  for (int i = 0; i < 20 && bracketed; ++i) {
    const double middle = 0.5 * (good + bad);
    const auto answer = question.good(middle);
    (answer && *answer ? good : bad) = middle;
  }
  return BandwidthLimit{good, bandwidth_of(scaled(desired, good).a_m)};
}

}  // namespace bodeflow::adaptive_control
