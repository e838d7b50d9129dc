#include <algorithm>
#include <bodeflow/error.hpp>
#include <bodeflow/testing/hook.hpp>

#include "checks.hpp"

namespace bodeflow::testing {
namespace {

void expect_same(const Case& c, const Trace& first, const std::string& a, const Trace& second, const std::string& b) {
  if (const std::string found = difference(c, first, a, second, b); !found.empty()) fail(found);
}

std::string calls_name(const Calls& calls) {
  std::string text = "calls of " + std::to_string(calls.size);
  if (calls.first != 0) text += " after one of " + std::to_string(calls.first);
  return text;
}

/// The ways to cut a run that must all give the same.
std::vector<Calls> cuts() {
  std::vector<Calls> list;
  for (const auto& [first, size] :
       std::vector<std::pair<std::uint64_t, std::uint64_t>>{{0, 1}, {0, 7}, {0, 64}, {0, 256}, {1, 64}, {13, 256}, {999, 1000}}) {
    Calls calls;
    calls.first = first;
    calls.size = size;
    list.push_back(calls);
  }
  return list;
}

void life_cycle(const Case& c, const Step& step) {
  { const Rig unused(c); }
  Rig rig(c);
  rig.configure();
  {
    Rig configured(c);
    configured.configure();
  }
  step("activate");
  rig.activate(1000);
  rig.deactivate();
  step("activate again");
  rig.activate(1000);
  const Trace trace = rig.run({});
  if (rig.host().records_alive() != 0) fail("keeps " + std::to_string(rig.host().records_alive()) + " records");
  rig.deactivate();
  if (!trace.failure.empty()) throw Skip{"refuses the suite's samples: " + trace.failure};
}

void any_calls(const Case& c, const Step& step) {
  const Trace whole = fresh_run(c, {});
  for (const Calls& calls : cuts()) {
    step(calls_name(calls));
    expect_same(c, whole, "calls of 1000", fresh_run(c, calls), calls_name(calls));
  }
}

void instances(const Case& c, const Step&) {
  Rig a(c), b(c);
  a.configure();
  b.configure();
  a.activate(1000);
  const Trace first = a.run({});
  b.activate(1000);
  expect_same(c, first, "the first instance", b.run({}), "the second");
}

void reset(const Case& c, const Step& step) {
  Rig rig(c);
  rig.configure();
  rig.activate(1000);
  const Trace first = rig.run({});
  step("reset");
  rig.reset();
  expect_same(c, first, "a fresh block", rig.run({}), "one that was reset");
  rig.reset();
  rig.reset();
  expect_same(c, first, "a fresh block", rig.run({}), "one that was reset twice");
}

void activate_again(const Case& c, const Step&) {
  Rig rig(c);
  rig.configure();
  rig.activate(1000);
  const Trace first = rig.run({});
  rig.deactivate();
  rig.activate(1000);
  expect_same(c, first, "a fresh block", rig.run({}), "one that was activated again");
}

void no_samples(const Case& c, const Step&) {
  Case empty = c;
  empty.feed.firings = 0;
  const Trace trace = fresh_run(empty, {});
  if (trace.firings != 0) fail("makes firings of its own");
}

void memory(const Case& c, const Step&) {
  Calls zeros, ones;
  zeros.fill = 0x00;
  ones.fill = 0xFF;
  const Trace first = fresh_run(c, zeros);
  if (!first.inputs_intact) fail("changes samples of an input");
  const std::string found = difference(c, first, "zeros in the output before", fresh_run(c, ones), "other values in it");
  if (!found.empty()) fail("leaves samples of an output unwritten, or reads them: " + found);
}

void in_place(const Case& c, const Step&) {
  if ((c.block->flags & BF_BLOCK_IN_PLACE) == 0) throw Skip{};
  Calls shared;
  shared.in_place = true;
  expect_same(c, fresh_run(c, {}), "memory of its own", fresh_run(c, shared), "output in the input's memory");
  shared.size = 7;
  expect_same(c, fresh_run(c, {}), "memory of its own", fresh_run(c, shared), "output in the input's memory, calls of 7");
}

void realtime(const Case& c, const Step&) {
  if ((c.block->flags & BF_BLOCK_REALTIME_SAFE) == 0) throw Skip{};
  if (bodeflow_hook_begin == nullptr || bodeflow_hook_end == nullptr) throw Skip{"the test program has no hook"};
  Calls calls;
  calls.hooked = true;
  calls.size = 256;
  fresh_run(c, calls);
}

void resolve(const Case& c, const Step& step) {
  Rig rig(c);
  rig.configure();
  step("inputs that are not known yet");
  const Resolved unknown = rig.resolve(false);
  step("known inputs");
  const Resolved first = rig.resolve();
  if (!(rig.resolve() == first)) fail("gives other facts when asked again");
  step("inputs that are not known yet, again");
  if (!(rig.resolve(false) == unknown)) fail("gives other facts for unknown inputs after it saw known ones");
  if (!(rig.resolve() == first)) fail("gives other facts after it saw unknown inputs");
  for (const OutputFacts& f : first.outputs) {
    if (!f.known) fail("leaves an output unknown although all inputs are known");
    if (f.channels == 0) fail("gives an output without channels");
    if (f.element != BF_F64 && f.element != BF_C64) fail("gives an output of element type " + std::to_string(f.element));
    if (!f.rate.known()) fail("gives an output without a rate");
  }
}

void bad_samples(const Case& c, const Step& step) {
  if (c.block->port_count == 0) throw Skip{};
  Case bad = c;
  bad.feed.signal = Feed::Signal::bad;
  Rig rig(bad);
  rig.configure();
  rig.activate(1000);
  step("NaN, infinite, denormal and huge samples");
  rig.run({});  // to refuse them with a reason is right as well
  step("reset after them");
  rig.reset();
  bad.feed.signal = Feed::Signal::ordinary;
  expect_same(c, fresh_run(c, {}), "a fresh block", rig.run({}), "one that was reset after bad samples");
}

void empty_records(const Case& c, const Step& step) {
  const bool receives = std::any_of(c.block->ports, c.block->ports + c.block->port_count,
                                    [](const bf_port_descriptor* p) { return p->kind == BF_MESSAGE && p->direction == BF_IN; });
  if (!receives) throw Skip{};
  Case sent = c;
  sent.feed.messages = Feed::Messages::empty;
  step("a record without content");
  fresh_run(sent, {});  // to refuse it with a reason is right as well
}

/// Another value of a live parameter that lies in its range, or nothing.
bool other_value(const bf_parameter_descriptor& p, StoredValue& value) {
  const auto inside = [&](double x) { return x > p.minimum && x < p.maximum; };
  const auto other = [&](double x) {
    for (const double candidate : {0.5 * x, 0.75 * x, x + 0.25, x - 0.25, 0.5 * (p.minimum + p.maximum)}) {
      if (inside(candidate) && candidate != x) return candidate;
    }
    return x;
  };
  switch (p.type) {
    case BF_BOOL:
      value.integer = value.integer == 0 ? 1 : 0;
      return true;
    case BF_INTEGER:
      value.integer += inside(static_cast<double>(value.integer + 1)) ? 1 : -1;
      return inside(static_cast<double>(value.integer));
    case BF_NUMBER:
      if (value.numbers.empty()) return false;
      value.numbers[0] = other(value.numbers[0]);
      return true;
    case BF_CHOICE:
      if (p.choice_count < 2 || value.strings.empty()) return false;
      value.strings[0] = value.strings[0] == p.choices[0] ? p.choices[1] : p.choices[0];
      return true;
    default:
      return !value.numbers.empty() || !value.integers.empty() || !value.strings.empty();
  }
}

void live(const Case& c, const Step& step) {
  bool any = false;
  for (std::uint32_t i = 0; i < c.block->parameter_count; ++i) {
    const bf_parameter_descriptor& p = *c.block->parameters[i];
    Calls change;
    change.change_value = c.values[i];
    if ((p.flags & BF_PARAMETER_LIVE) == 0 || !other_value(p, change.change_value)) continue;
    any = true;
    change.change_value.given = true;
    change.change_at = 100;
    change.change_parameter = i;
    Rig rig(c);
    rig.configure();
    rig.activate(1000);
    const Trace whole = rig.run(change);
    step(std::string("reset after a change of ") + p.name);
    rig.reset();
    expect_same(c, fresh_run(c, {}), "a fresh block", rig.run({}), std::string("one that was reset after a change of ") + p.name);
    for (const std::uint64_t size : {1u, 7u, 64u, 999u}) {
      step(std::string("change of ") + p.name + ", calls of " + std::to_string(size));
      change.size = size;
      expect_same(c, whole, std::string("a change of ") + p.name + " and calls of 1000", fresh_run(c, change),
                  "calls of " + std::to_string(size));
    }
  }
  if (!any) throw Skip{};
}

}  // namespace

Trace fresh_run(const Case& the_case, const Calls& calls) {
  Rig rig(the_case);
  rig.configure();
  rig.activate(calls.size);
  return rig.run(calls);
}

std::vector<BlockCheck> case_checks() {
  return {
      {"passes through its life cycle in order", life_cycle},
      {"resolve is pure and copes with inputs that are not known yet", resolve},
      {"gives the same bits and records for every size and boundary of calls", any_calls},
      {"gives the same bits in a second instance", instances},
      {"is as fresh after reset", reset},
      {"is as fresh after deactivate and activate", activate_again},
      {"finishes after zero samples", no_samples},
      {"writes every sample of its outputs and nothing else", memory},
      {"works in place as it claims", in_place},
      {"neither allocates, locks nor does input or output in process, as it claims", realtime},
      {"gives the same bits for every cut when a live parameter changes", live},
      {"survives NaN, infinite, denormal and huge samples", bad_samples},
      {"survives records without content", empty_records},
  };
}

}  // namespace bodeflow::testing
