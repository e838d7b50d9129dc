#include "structure.hpp"

#include <bodeflow/numerics/polynomial.hpp>
#include <cmath>

namespace bodeflow::maximum_likelihood {

namespace {

constexpr Eigen::Index kHighestOrder = 30;

Expected<void> check_numerator(const Structure& m, Eigen::Index order) {
  if (order < 0 || order > kHighestOrder) {
    return refused("a numerator order of " + std::to_string(order) + "; allowed: 0 to " + std::to_string(kHighestOrder));
  }
  if (order <= m.order) return {};
  const std::string orders = "the numerator order " + std::to_string(order) + " is above the order " + std::to_string(m.order);
  if (m.domain == Domain::z) return refused(orders + ": such a model of z answers before it is excited");
  if (m.zero_order_hold) return refused(orders + ": such a model has no answer to a held input");
  return {};
}

Expected<void> check_fixed(const Structure& m) {
  for (const FixedCoefficient& f : m.fixed) {
    const std::string name = "fixed coefficient " + name_of(f, m.numerator_orders.size());
    if (!std::isfinite(f.value)) return refused("the " + name + " is not finite");
    if (!f.of_denominator && (f.output < 0 || f.output >= static_cast<Eigen::Index>(m.numerator_orders.size())))
      return refused("the " + name + ": there is no such output");
    const Eigen::Index highest = f.of_denominator ? m.order - 1 : m.numerator_orders[static_cast<std::size_t>(f.output)];
    if (f.power >= 0 && f.power <= highest) continue;
    if (f.of_denominator && f.power == m.order)
      return refused("the " + name + ": the highest coefficient of the denominator is 1 already");
    return refused("the " + name + ": the highest one is " + (f.of_denominator ? "a" : "b") + std::to_string(highest));
  }
  return {};
}

}  // namespace

Eigen::Index Structure::parameters() const {
  Eigen::Index count = free_poles() + (estimate_delay ? 1 : 0) - static_cast<Eigen::Index>(fixed.size());
  for (const Eigen::Index order_of_numerator : numerator_orders) count += order_of_numerator + 1;
  return count;
}

std::string name_of(const FixedCoefficient& c, std::size_t outputs) {
  std::string name = (c.of_denominator ? "a" : "b") + std::to_string(c.power);
  if (!c.of_denominator && outputs > 1) name += "_out" + std::to_string(c.output + 1);
  return name;
}

Expected<void> check(const Structure& m, Eigen::Index outputs, double sample_time_s) {
  if (m.order < 0 || m.order > kHighestOrder)
    return refused("an order of " + std::to_string(m.order) + "; allowed: 0 to " + std::to_string(kHighestOrder));
  if (static_cast<Eigen::Index>(m.numerator_orders.size()) != outputs) {
    return refused(std::to_string(m.numerator_orders.size()) + " numerator orders for " + std::to_string(outputs) + " outputs");
  }
  for (const Eigen::Index order : m.numerator_orders) {
    if (const auto fits = check_numerator(m, order); !fits) return fits;
  }
  if (m.free_poles() < 0)
    return refused(std::to_string(m.fixed_poles.size()) + " fixed poles in a model of order " + std::to_string(m.order));
  if (const auto pairs = numerics::split_roots(m.fixed_poles); !pairs) return refused("fixed poles: " + pairs.error().text);
  if (const auto fits = check_fixed(m); !fits) return fits;
  if (!(sample_time_s > 0.0) && m.domain == Domain::z)
    return refused("the domain z needs the sample rate of the data, and the response does not have it; choose domain: s");
  if (!(sample_time_s > 0.0) && m.zero_order_hold)
    return refused("hold: zero_order needs the sample rate of the data, and the response does not have it");
  if (m.domain == Domain::z && m.zero_order_hold)
    return refused("hold: zero_order belongs to domain: s; a model of z says nothing between the samples");
  if (!std::isfinite(m.delay_s) || m.delay_s < 0.0) return refused("the delay must be at least 0 s and finite");
  if (m.estimate_delay && !(m.delay_low_s >= 0.0 && m.delay_high_s > m.delay_low_s && std::isfinite(m.delay_high_s)))
    return refused("the range of the delay must rise, from at least 0 s");
  return {};
}

}  // namespace bodeflow::maximum_likelihood
