#include "effects/feed_through.hpp"

#include "effects/response_words.hpp"

namespace bodeflow::residual {
namespace {

/// Weighted mean of what is missing, and the size of the response.
double mean_missing(const Situation& s) {
  double sum = 0.0, weights = 0.0;
  for (std::size_t k = 0; k < s.missing.size(); ++k) {
    const double weight = s.missing_std[k] > 0.0 ? 1.0 / (s.missing_std[k] * s.missing_std[k]) : 0.0;
    sum += weight * s.missing[k].real();
    weights += weight;
  }
  return weights > 0.0 ? sum / weights : 0.0;
}

double least_response(const Situation& s) {
  double least = 0.0;
  for (const auto& g : s.response)
    if (std::abs(g) > 0.0 && (least <= 0.0 || std::abs(g) < least)) least = std::abs(g);
  return least > 0.0 ? least : 1.0;
}

}  // namespace

void FeedThrough::describe(DescribeEffect& effect) {
  effect.id("residual.feed_through")
      .summary("The input reaches the output directly, beside the plant.")
      .doc(
          "A constant D of either sign is added to the response: cross-talk between channels, a sensor that sees the actuator, "
          "or the sum "
          "of all modes above the band.")
      .acts(Acts::parallel);
}

std::vector<FitParameter> FeedThrough::parameters(const Situation& s) const {
  return {real("feed_through", lines::ratio_unit(s.output_unit, s.input_unit), 0.1 * least_response(s))
              .says("output for a unit of the input, at once")};
}

std::vector<std::vector<double>> FeedThrough::starts(const Situation& s) const {
  std::vector<std::vector<double>> starts = {{0.0}};
  if (const double found = mean_missing(s); std::abs(found) > 0.0) starts.push_back({found});
  return starts;
}

std::string FeedThrough::sentence(std::span<const double> value, std::span<const double> std, const Situation& s) const {
  return "feed-through of the input to the output, " +
         lines::with_std(value[0], std[0], lines::ratio_unit(s.output_unit, s.input_unit));
}

std::complex<double> FeedThrough::transfer(const double* p, std::complex<double>) const { return p[0]; }

}  // namespace bodeflow::residual
