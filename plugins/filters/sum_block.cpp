#include "sum_block.hpp"

#include <algorithm>
#include <bodeflow/units.hpp>

#include "notes.hpp"

namespace bodeflow::filters {
namespace {

// Both known. Rates are compared by the engine, along with all others.
void require_alike(const StreamFacts& first, const char* first_name, const StreamFacts& other, const char* other_name) {
  const std::string who = std::string("inputs '") + first_name + "' and '" + other_name + "' ";
  if (first.element != other.element) fail(who + "are not both real or both complex");
  if (first.channels != other.channels) {
    fail(who + "have " + std::to_string(first.channels) + " and " + std::to_string(other.channels) +
         " channels; allowed: the same number");
  }
  if (!same_unit(first.unit, other.unit)) fail(who + "are in " + first.unit + " and " + other.unit + "; allowed: the same unit");
}

}  // namespace

void Sum::describe(Describe& description) {
  description.id("filters.sum").summary("Adds two to four streams with weights.").realtime_safe().in_place().cost_ns(0.3);
  description.doc(
      "y[n] = w_a a[n] + w_b b[n] + w_c c[n] + w_d d[n], channel by channel. weights: [1, -1] gives the control error of a loop, "
      "reference "
      "in a and measurement in b. All inputs have the same rate, channels and unit.");
  description.parameter("weights", std::vector<double>{1.0, 1.0}).unit("1").doc("of a, b, c and d; 1 where the list is shorter");
  description.stream_in(a);
  description.stream_in(b);
  description.stream_in(c).optional();
  description.stream_in(d).optional();
  description.stream_out(out);
}

void Sum::configure(const Parameters& p) {
  const std::vector<double>& weights = p.numbers("weights");
  if (weights.size() > weights_.size()) fail("weights has " + std::to_string(weights.size()) + " values, allowed: at most 4");
  std::copy(weights.begin(), weights.end(), weights_.begin());
}

void Sum::resolve(Facts& f) {
  const In<Any>* first = nullptr;
  for (const In<Any>& input : inputs) {
    const StreamFacts& x = f.in(input);
    if (!x.known) continue;
    const Notes notes = scaled(x.notes, weights_[static_cast<std::size_t>(input.index)]);
    if (first == nullptr) {
      first = &input;
      f.out(out) = x;
      f.out(out).notes = notes;
      continue;
    }
    StreamFacts& y = f.out(out);
    require_alike(f.in(*first), first->name, x, input.name);
    y.notes = added(y.notes, notes);
    if (y.unit.empty()) y.unit = x.unit;
    if (x.length >= 0) y.length = y.length < 0 ? x.length : std::min(x.length, y.length);
  }
}

void Sum::process(Io& io) {
  if (io.element(a) == BF_C64) {
    add<std::complex<double>>(io);
  } else {
    add<double>(io);
  }
}

template <class T>
void Sum::add(Io& io) const {
  for (int channel = 0; channel < io.channels(a); ++channel) {
    const T* x[4] = {};
    std::size_t used = 0;
    double w[4] = {};
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      if (!io.connected(inputs[i])) continue;
      w[used] = weights_[i];
      x[used++] = io.read<T>(inputs[i], channel).data();
    }
    const auto y = io.write<T>(out, channel);
    // One pass, in the order of the inputs: y may share memory with any of them.
    if (used == 2) {
      for (std::size_t n = 0; n < y.size(); ++n) y[n] = x[0][n] * w[0] + x[1][n] * w[1];
      continue;
    }
    for (std::size_t n = 0; n < y.size(); ++n) {
      T sum = x[0][n] * w[0];
      for (std::size_t i = 1; i < used; ++i) sum += x[i][n] * w[i];
      y[n] = sum;
    }
  }
}

}  // namespace bodeflow::filters
