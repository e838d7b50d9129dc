// A part that goes on for a lost one begins in the middle of its phase.
#include <algorithm>

#include "lab/split.hpp"
#include "plan/exact.hpp"

namespace bodeflow::lab {
namespace {

/// A count that ends so much earlier; -1 has no end.
void shorten(std::int64_t& count, std::int64_t by) {
  if (count >= 0) count = std::max<std::int64_t>(0, count - by);
}

/// a - b; 0 where that is negative.
Rate left_of(const Rate& a, const Rate& b) {
  const plan::Wide left = plan::Wide{a.num} * b.den - plan::Wide{b.num} * a.den;
  return plan::fraction(std::max<plan::Wide>(0, left), plan::Wide{a.den} * b.den).value_or(Rate{});
}

}  // namespace

Rate begin_part_at(Part& part, const Rate& end, std::int64_t period) {
  for (plan::Facts::Block& block : part.facts.blocks) {
    const std::int64_t firings = period * block.repetitions;
    shorten(block.firings, firings);
    for (std::size_t i = 0; i < block.inputs.size(); ++i)
      shorten(block.inputs[i].length, firings * static_cast<std::int64_t>(block.input_flows[i].samples));
    for (std::size_t i = 0; i < block.outputs.size(); ++i)
      shorten(block.outputs[i].length, firings * static_cast<std::int64_t>(block.output_flows[i].samples));
  }
  const Rate begin(period * part.facts.period.num, part.facts.period.den);
  // 0.1 in a graph means a tenth: what is left of it is exact too, so that no change comes a sample late.
  for (graph::ScheduledChange& change : part.phase.schedule) change.time_s = left_of(Rate::from_hz(change.time_s), begin).hz();
  return left_of(end, begin);
}

}  // namespace bodeflow::lab
