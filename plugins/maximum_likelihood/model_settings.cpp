#include "model_settings.hpp"

#include <bodeflow/units.hpp>
#include <cmath>
#include <regex>

namespace bodeflow::maximum_likelihood {

namespace {

constexpr std::int64_t kHighestOrder = 30;

std::optional<Eigen::Index> read_order(const std::string& text) {
  if (text == "auto") return {};
  const auto value = convert(text, "1");
  if (!value || !(*value >= 0.0 && *value <= static_cast<double>(kHighestOrder)) || *value != std::floor(*value))
    fail("order: '" + text + "'; allowed: 0 to " + std::to_string(kHighestOrder) + ", or auto");
  return static_cast<Eigen::Index>(*value);
}

void read_delay(const std::string& text, Settings& s) {
  s.estimate_delay = text == "estimate";
  if (s.estimate_delay) return;
  const auto value = convert(text, "s");
  if (!value || !(*value >= 0.0) || !std::isfinite(*value))
    fail("delay: '" + text + "'; allowed: a time of at least 0, such as 150 us, or estimate");
  s.delay_s = *value;
}

/// "a0 = 0", "b2 = 1.5", "b0_out2 = 3".
FixedCoefficient read_fixed(const std::string& text) {
  static const std::regex pattern(R"(\s*([ab])(\d{1,2})(?:_out(\d{1,3}))?\s*=\s*(\S+)\s*)");
  std::smatch match;
  if (!std::regex_match(text, match, pattern))
    fail("fixed: '" + text + "'; allowed: a coefficient and its value, such as b1 = 0");
  FixedCoefficient c;
  c.of_denominator = match[1] == "a";
  c.power = std::stol(match[2]);
  if (match[3].matched) c.output = std::stol(match[3]) - 1;
  if (match[3].matched && c.of_denominator) fail("fixed: '" + text + "': the denominator is that of all outputs");
  const auto value = convert(match[4].str(), "1");
  if (!value || !std::isfinite(*value)) fail("fixed: '" + text + "': '" + match[4].str() + "' is not a number");
  c.value = *value;
  return c;
}

}  // namespace

void describe_settings(Describe& d) {
  d.parameter("domain", "s").choices({"s", "z"}).doc("a model in s, or in z at the sample rate of the data");
  d.parameter("order", "auto").doc("number of poles, or auto: the lowest order whose cost no higher one undercuts significantly");
  d.parameter("highest_order", std::int64_t{8}).range(1, kHighestOrder).doc("of the search for the order");
  d.parameter("numerator_order", std::vector<std::int64_t>{})
      .range(-kHighestOrder, kHighestOrder)
      .doc(
          "one for all outputs, or one each; below 0: relative to the order; default: order - 1 in s, the order in z, with "
          "`delay: estimate` the lowest that no higher one undercuts significantly");
  d.parameter("delay", "0").doc("0, a time such as 150 us, or estimate");
  d.parameter("delay_range", std::vector<double>{})
      .unit("s")
      .range(0, 1e6)
      .doc(
          "[from, to] for delay: estimate; default: from 0 to 5 periods of the highest line, no further than the lines can tell");
  d.parameter("fixed_poles", std::vector<std::complex<double>>{})
      .doc("poles that are known, in rad/s or as values of z, counted in the order: [0] for an integrator");
  d.parameter("fixed", std::vector<std::string>{})
      .doc(
          "coefficients that are known, in rad/s or of z, such as [b0 = 0, a1 = 12.5, b2_out2 = 0]; the highest of the "
          "denominator is 1");
  d.parameter("weighting", "variance")
      .choices({"variance", "none", "relative"})
      .doc("variance: maximum likelihood; none: plain least squares in G; relative: in G relative to |G|");
  d.parameter("hold", "none")
      .choices({"none", "zero_order"})
      .doc("zero_order, for s: input and output are samples, and the input is constant between them");
  d.parameter("starts", std::int64_t{6}).range(1, 100).doc("most starts from which the minimum is searched");
}

Settings read_settings(const Parameters& p) {
  Settings s;
  s.domain = p.text("domain") == "z" ? Domain::z : Domain::s;
  s.order = read_order(p.text("order"));
  s.highest_order = p.integer("highest_order");
  for (const std::int64_t order : p.integers("numerator_order")) s.numerator_orders.push_back(order);
  read_delay(p.text("delay"), s);
  const std::vector<double>& range = p.numbers("delay_range");
  if (!range.empty()) {
    if (range.size() != 2 || !(range[1] > range[0])) fail("delay_range: allowed: two times that rise");
    if (!s.estimate_delay) fail("delay_range is for delay: estimate");
    s.delay_range_s = std::pair(range[0], range[1]);
  }
  const auto poles = p.complex_list("fixed_poles");
  s.fixed_poles = Eigen::Map<const Eigen::VectorXcd>(poles.data(), static_cast<Eigen::Index>(poles.size()));
  for (const std::string& text : p.texts("fixed")) s.fixed.push_back(read_fixed(text));
  if (!s.order && !s.fixed.empty())
    fail("fixed coefficients need a given order: order: auto has a denominator of its own at each");
  const std::string& weighting = p.text("weighting");
  s.weighting = weighting == "variance" ? Weighting::variance : weighting == "none" ? Weighting::even : Weighting::relative;
  s.zero_order_hold = p.text("hold") == "zero_order";
  s.starts = static_cast<int>(p.integer("starts"));
  return s;
}

}  // namespace bodeflow::maximum_likelihood
