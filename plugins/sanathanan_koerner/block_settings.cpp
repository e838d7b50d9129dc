#include "block_settings.hpp"

#include <bodeflow/units.hpp>
#include <cmath>
#include <numbers>

#include "records/band.hpp"

namespace bodeflow::sanathanan_koerner {
namespace {

constexpr std::int64_t kHighestOrder = 1000;
constexpr double kMostStates = 1e6;

States read_states(const std::string& text) {
  if (text == "all") return {};
  if (text == "auto" || text == "gilbert") return {true, text == "gilbert", {}};
  const auto value = convert(text, "1");
  if (!value || !(*value >= 0.0 && *value <= kMostStates) || *value != std::floor(*value))
    fail("states: '" + text + "'; allowed: all, auto, gilbert, or a number from 0 on");
  return {true, false, static_cast<Eigen::Index>(*value)};
}

std::optional<Eigen::Index> read_order(const std::string& text) {
  if (text == "auto") return {};
  const auto value = convert(text, "1");
  if (!value || !(*value >= 0.0 && *value <= static_cast<double>(kHighestOrder)) || *value != std::floor(*value))
    fail("order: '" + text + "'; allowed: 0 to " + std::to_string(kHighestOrder) + ", or auto");
  return static_cast<Eigen::Index>(*value);
}

}  // namespace

void describe_lines(Describe& d) {
  d.parameter("inputs", std::vector<std::string>{}).doc("names of the inputs of the model; default: all");
  d.parameter("outputs", std::vector<std::string>{}).doc("names of the outputs of the model; default: all");
  d.parameter("band", "").doc("frequencies that are fitted, as 1 Hz:50 Hz; default: all lines");
  d.parameter("weighting", "auto")
      .choices({"auto", "absolute", "relative", "variance"})
      .doc(
          "of a line: 1, 1/|G|, or one over the standard deviation of G; auto: the last where the response has it, else the "
          "first");
}

void describe_selection(Describe& d) {
  describe_lines(d);
  d.parameter("tier_band", "").doc("frequencies with full weight, as 1 Hz:50 Hz; the others weigh less");
  d.parameter("tier_below", 0.1).unit("1").range(0, 1).doc("weight of the lines below tier_band");
  d.parameter("tier_above", 1e-4).unit("1").range(0, 1).doc("weight of the lines above tier_band");
}

Weighting read_weighting(const Parameters& p) {
  const std::string& weighting = p.text("weighting");
  if (weighting == "absolute") return Weighting::absolute;
  if (weighting == "relative") return Weighting::relative;
  return weighting == "variance" ? Weighting::variance : Weighting::automatic;
}

Selection read_selection(const Parameters& p) {
  Selection s;
  s.inputs = p.texts("inputs");
  s.outputs = p.texts("outputs");
  s.band = p.text("band");
  s.weighting = read_weighting(p);
  const std::string& tiers = p.text("tier_band");
  if (tiers.empty()) return s;
  const auto band = records::parse_band(tiers, 0.0);
  if (!band) fail("tier_band: " + band.error().text);
  s.tiers = Tiers{band->low_rad_s, band->high_rad_s, p.number("tier_below"), p.number("tier_above")};
  return s;
}

void describe_method(Describe& d) {
  d.parameter("order", "auto").doc("number of poles, shared by all responses, or auto: the one the data support");
  d.parameter("highest_order", std::int64_t{20}).range(1, kHighestOrder).doc("of the search for the order");
  d.parameter("columns", "stacked")
      .choices({"stacked", "by_column"})
      .doc("of several inputs: all responses together, or the denominator from the strongest input and numerators for it");
  d.parameter("stability", "reflect").choices({"reflect", "off"}).doc("unstable poles reflected into the stable half, or left");
  d.parameter("iterations", std::int64_t{30}).range(1, 1000).doc("most iterations; the best iterate is kept");
  d.parameter("tolerance", 1e-8).unit("1").range(0, 1).doc("relative change of the error that ends the iteration");
  d.parameter("states", "all")
      .doc(
          "of several inputs and outputs, where each pole has as many states as there are inputs or outputs: all; auto: the "
          "balanced truncation with the fewest states that changes the response by less than half the error of the fit; gilbert: "
          "by the same rule, of each pole as many as the rank of its residues; or their number");
  d.parameter("refine", false).doc("nonlinear least squares from the result on (Gauss-Newton)");
}

void read_method(const Parameters& p, Settings& s) {
  s.order = read_order(p.text("order"));
  s.highest_order = p.integer("highest_order");
  s.columns = p.text("columns") == "by_column" ? Columns::by_column : Columns::stacked;
  s.stable = p.text("stability") == "reflect";
  s.stop.iterations = static_cast<int>(p.integer("iterations"));
  s.stop.tolerance = p.number("tolerance");
  s.states = read_states(p.text("states"));
  s.refine = p.boolean("refine");
}

void describe_prewarp(Describe& d) {
  d.parameter("prewarp", "auto")
      .doc(
          "the frequency that the bilinear map takes to a quarter of the circle, such as 20 Hz or 127 rad/s, or auto: a scan "
          "from "
          "the middle of the range (geometric) to ten times that");
}

std::optional<double> read_prewarp(const Parameters& p) {
  const std::string& text = p.text("prewarp");
  if (text == "auto") return {};
  const auto hertz = convert(text, "Hz"), angular = convert(text, "rad/s");
  const bool bare = convert(text, "1").has_value();
  const double value = bare ? 0.0 : hertz ? 2.0 * std::numbers::pi * *hertz : angular ? *angular : 0.0;
  if (!(value > 0.0) || !std::isfinite(value))
    fail("prewarp: '" + text + "'; allowed: a frequency above 0 with its unit, such as 20 Hz, or auto");
  return value;
}

}  // namespace bodeflow::sanathanan_koerner
