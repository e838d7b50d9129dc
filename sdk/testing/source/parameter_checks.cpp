#include <bodeflow/error.hpp>
#include <cmath>
#include <limits>

#include "checks.hpp"

namespace bodeflow::testing {
namespace {

using limits = std::numeric_limits<double>;
using integers = std::numeric_limits<std::int64_t>;

struct Named {
  std::string text;
  StoredValue value;
};

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

Named scalar(const StoredValue& like, const std::string& text) {
  Named named{text, like};
  named.value.given = true;
  named.value.rows = 1;
  named.value.columns = 1;
  return named;
}

void add_lists(const bf_parameter_descriptor& p, const StoredValue& like, std::vector<Named>& list) {
  Named none = scalar(like, "an empty list");
  none.value.rows = 0;
  none.value.columns = 0;
  none.value.numbers.clear();
  none.value.integers.clear();
  none.value.strings.clear();
  list.push_back(none);
  for (const double x : odd_numbers(p)) {
    Named one = scalar(like, "a list with " + std::to_string(x));
    if (p.type == BF_NUMBERS || p.type == BF_MATRIX) one.value.numbers = {x};
    if (p.type == BF_COMPLEX_LIST) one.value.numbers = {x, x};
    if (p.type != BF_INTEGERS && p.type != BF_STRINGS) list.push_back(one);
  }
  for (const std::int64_t x : odd_integers(p)) {
    Named one = scalar(like, "a list with " + std::to_string(x));
    one.value.integers = {x};
    if (p.type == BF_INTEGERS) list.push_back(one);
  }
}

/// Values that a careless block stumbles over.
std::vector<Named> odd_values(const bf_parameter_descriptor& p, const StoredValue& like) {
  std::vector<Named> list;
  switch (p.type) {
    case BF_NUMBER:
      for (const double x : odd_numbers(p)) {
        list.push_back(scalar(like, std::to_string(x)));
        list.back().value.numbers = {x};
      }
      break;
    case BF_INTEGER:
      for (const std::int64_t x : odd_integers(p)) {
        list.push_back(scalar(like, std::to_string(x)));
        list.back().value.integer = x;
      }
      break;
    case BF_BOOL:
      break;
    case BF_STRING:
    case BF_CHOICE:
    case BF_FILE:
      for (const auto& [text, value] :
           std::vector<std::pair<const char*, std::string>>{{"an empty text", ""},
                                                            {"a long text", std::string(10000, 'a')},
                                                            {"a word that is none of the choices", "\x01 no such word"}}) {
        list.push_back(scalar(like, text));
        list.back().value.strings = {value};
      }
      break;
    default:
      add_lists(p, like, list);
  }
  return list;
}

void survives(const Case& c, std::uint32_t index, const Step& step) {
  const auto values = odd_values(*c.block->parameters[index], c.values[index]);
  if (values.empty()) throw Skip{"no other values"};
  for (const Named& named : values) {
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
}

}  // namespace

std::vector<BlockCheck> parameter_checks(const bf_block_descriptor& block) {
  std::vector<BlockCheck> checks;
  for (std::uint32_t i = 0; i < block.parameter_count; ++i) {
    checks.push_back({std::string("survives parameter '") + block.parameters[i]->name + "' at or beyond its limits",
                      [i](const Case& c, const Step& step) { survives(c, i, step); }});
  }
  return checks;
}

}  // namespace bodeflow::testing
