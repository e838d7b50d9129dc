#include "multisine_parameters.hpp"

#include <bodeflow/numerics/random.hpp>
#include <string>

#include "amplitude_spectrum.hpp"
#include "source.hpp"

namespace bodeflow::generators {

void describe_lines(Describe& d) {
  d.optional<std::int64_t>("lines.first").range(1, 1 << 28).doc("first line");
  d.optional<std::int64_t>("lines.last").range(1, 1 << 28).doc("last line that may be excited, below N / 2");
  d.parameter("lines.step", std::int64_t{1}).range(1, 1 << 28).doc("distance of the lines");
  d.optional<std::vector<std::int64_t>>("lines.list")
      .range(1, 1 << 28)
      .doc("lines one by one, ascending, in place of first, last and step");
  d.parameter("lines.parity", "all").choices({"all", "odd", "even"}).doc("which of these lines are taken");
  d.optional<std::int64_t>("detection.group")
      .range(2, 1 << 28)
      .doc("of each so many odd lines in turn one is left out at random, where odd nonlinear distortion shows");
  d.parameter("detection.seed", std::int64_t{1})
      .range(0, 9e18)
      .doc("chooses them: the same in all realisations, and in all runs");
}

LineNumbers named_lines(const Parameters& p, std::int64_t period) {
  const bool range = p.has("lines.first") || p.has("lines.last") || p.given("lines.step");
  if (p.has("lines.list") && range) fail("lines has a list as well as first, last or step; allowed: one of the two");
  if (!p.has("lines.list") && (!p.has("lines.first") || !p.has("lines.last"))) fail("lines needs first and last, or a list");
  const LineNumbers all =
      p.has("lines.list")
          ? valid(lines_in_list(p.integers("lines.list"), period))
          : valid(lines_in_range(p.integer("lines.first"), p.integer("lines.last"), p.integer("lines.step"), period));
  return valid(lines_of_parity(all, p.text("lines.parity")));
}

LineNumbers excited_lines(const Parameters& p, const LineNumbers& named) {
  if (!p.has("detection.group")) {
    if (p.given("detection.seed")) fail("detection.seed is given without detection.group");
    return named;
  }
  const numerics::Random random(static_cast<std::uint64_t>(p.integer("detection.seed")));
  return valid(without_detection_lines(named, p.integer("detection.group"), random));
}

std::vector<double> named_amplitudes(const Parameters& p, const LineNumbers& named, double line_distance_hz) {
  const bool curve = p.has("spectrum.frequencies") || p.has("spectrum.amplitudes");
  if (curve) {
    if (p.given("amplitude")) fail("amplitude is given as well as spectrum; allowed: one of the two");
    if (!p.has("spectrum.frequencies") || !p.has("spectrum.amplitudes")) fail("spectrum needs frequencies and amplitudes");
    std::vector<double> frequencies;
    for (const std::int64_t line : named) frequencies.push_back(static_cast<double>(line) * line_distance_hz);
    return valid(amplitudes_on_curve(p.numbers("spectrum.frequencies"), p.numbers("spectrum.amplitudes"), frequencies));
  }
  const std::vector<double>& amplitudes = p.numbers("amplitude");
  if (amplitudes.size() == 1) return std::vector<double>(named.size(), amplitudes[0]);
  if (amplitudes.size() != named.size()) {
    fail("amplitude has " + std::to_string(amplitudes.size()) + " values, allowed: 1, or one for each of the " +
         std::to_string(named.size()) + " lines");
  }
  return amplitudes;
}

}  // namespace bodeflow::generators
