#include <bodeflow/error.hpp>
#include <cmath>
#include <limits>

#include "checks.hpp"

namespace bodeflow::testing {
namespace {

using limits = std::numeric_limits<double>;
using integers = std::numeric_limits<std::int64_t>;

constexpr unsigned kPatience_s = 10;  // for what is to be refused at once

struct Named {
  std::string text;
  StoredValue value;
  bool inside = true;  ///< a host would hand it over
};

bool in_range(const bf_parameter_descriptor& p, double x) {
  const bool above = (p.flags & BF_PARAMETER_EXCLUSIVE_MIN) != 0 ? x > p.minimum : x >= p.minimum;
  const bool below = (p.flags & BF_PARAMETER_EXCLUSIVE_MAX) != 0 ? x < p.maximum : x <= p.maximum;
  return above && below && std::isfinite(x);
}

std::vector<double> odd_numbers(const bf_parameter_descriptor& p) {
  std::vector<double> list = {limits::quiet_NaN(),  limits::infinity(), -limits::infinity(), 0.0, -1.0,
                              limits::denorm_min(), limits::max()};
  if (std::isfinite(p.minimum)) list.insert(list.end(), {p.minimum - 1.0, p.minimum});
  if (std::isfinite(p.maximum)) list.insert(list.end(), {p.maximum + 1.0, p.maximum});
  return list;
}

std::vector<std::int64_t> odd_integers(const bf_parameter_descriptor& p) {
  std::vector<std::int64_t> list = {integers::min(), integers::max(), 0, -1};
  if (std::abs(p.minimum) < 9e18) list.push_back(static_cast<std::int64_t>(p.minimum) - 1);
  if (std::abs(p.maximum) < 9e18) list.push_back(static_cast<std::int64_t>(p.maximum) + 1);
  return list;
}

Named one_value(const StoredValue& like, const std::string& text, bool inside) {
  Named named{text, like, inside};
  named.value.given = true;
  named.value.rows = 1;
  named.value.columns = 1;
  return named;
}

void add_lists(const bf_parameter_descriptor& p, const StoredValue& like, std::vector<Named>& list) {
  Named none = one_value(like, "an empty list", true);
  none.value.rows = 0;
  none.value.columns = 0;
  none.value.numbers.clear();
  none.value.integers.clear();
  none.value.strings.clear();
  list.push_back(none);
  if (p.type == BF_INTEGERS) {
    for (const std::int64_t x : odd_integers(p)) {
      list.push_back(one_value(like, "a list with " + std::to_string(x), in_range(p, static_cast<double>(x))));
      list.back().value.integers = {x};
    }
  } else if (p.type != BF_STRINGS) {
    for (const double x : odd_numbers(p)) {
      list.push_back(one_value(like, "a list with " + std::to_string(x), in_range(p, x)));
      list.back().value.numbers.assign(p.type == BF_COMPLEX_LIST ? 2 : 1, x);
    }
  }
}

/// Values that a careless block stumbles over.
std::vector<Named> odd_values(const bf_parameter_descriptor& p, const StoredValue& like) {
  std::vector<Named> list;
  switch (p.type) {
    case BF_NUMBER:
      for (const double x : odd_numbers(p)) {
        list.push_back(one_value(like, std::to_string(x), in_range(p, x)));
        list.back().value.numbers = {x};
      }
      break;
    case BF_INTEGER:
      for (const std::int64_t x : odd_integers(p)) {
        list.push_back(one_value(like, std::to_string(x), in_range(p, static_cast<double>(x))));
        list.back().value.integer = x;
      }
      break;
    case BF_BOOL:
      break;
    case BF_STRING:
    case BF_CHOICE:
    case BF_FILE:
      for (const auto& [text, value] : std::vector<std::pair<const char*, std::string>>{
               {"an empty text", ""}, {"a long text", std::string(10000, 'a')}, {"no such word", "\x01 no such word"}}) {
        list.push_back(one_value(like, text, p.type != BF_CHOICE));
        list.back().value.strings = {value};
      }
      break;
    default:
      add_lists(p, like, list);
  }
  return list;
}

void survives(const Case& c, std::uint32_t index, bool inside, const Step& step) {
  bool any = false;
  for (const Named& named : odd_values(*c.block->parameters[index], c.values[index])) {
    if (named.inside != inside) continue;
    any = true;
    step(named.text);
    Case odd = c;
    odd.values[index] = named.value;
    odd.feed.firings = 16;
    try {
      Rig rig(odd);
      rig.configure();
      const Resolved facts = rig.resolve();
      std::uint64_t most = 1;
      for (const FlowFacts& f : facts.input_flows) most = std::max<std::uint64_t>(most, f.samples);
      for (const FlowFacts& f : facts.output_flows) most = std::max<std::uint64_t>(most, f.samples);
      if (most > 1000000) continue;  // no memory for such a firing here
      rig.activate(16);
      rig.run({});
    } catch (const std::exception&) {  // refused with a reason
    }
  }
  if (!any) throw Skip{};
}

}  // namespace

std::vector<BlockCheck> parameter_checks(const bf_block_descriptor& block) {
  std::vector<BlockCheck> checks;
  for (std::uint32_t i = 0; i < block.parameter_count; ++i) {
    const std::string name = std::string("parameter '") + block.parameters[i]->name + "'";
    checks.push_back({"takes or refuses extreme values of " + name,
                      [i](const Case& c, const Step& step) { survives(c, i, true, step); }, kPatience_s, true});
    checks.push_back({"survives values of " + name + " that a host refuses",
                      [i](const Case& c, const Step& step) { survives(c, i, false, step); }, kPatience_s, false});
  }
  return checks;
}

}  // namespace bodeflow::testing
