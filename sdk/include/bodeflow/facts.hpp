#pragma once

#include <bodeflow/block_type.hpp>
#include <bodeflow/ports.hpp>
#include <bodeflow/rate.hpp>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace bodeflow {
inline namespace v0 {

/// What is true of a stream.
struct StreamFacts {
  bool known = false;
  std::uint32_t element = BF_F64;  ///< BF_F64 or BF_C64
  int channels = 0;
  Rate rate;                 ///< samples per second, exact
  std::int64_t length = -1;  ///< samples until its end, -1: no end of its own
  std::string unit;          ///< "" where unknown or where channels differ
  std::string clock;         ///< clock domain, "" the engine's own
  std::vector<std::string> channel_names;
  std::vector<std::string> channel_units;
  /// What else is known of the signal, for advice before a run: name -> values. README.md lists the names.
  std::map<std::string, std::vector<double>> notes;

  /// A note's values; empty where there is none.
  std::vector<double> note(const std::string& name) const {
    const auto found = notes.find(name);
    return found == notes.end() ? std::vector<double>() : found->second;
  }
};

/// What `resolve` reads of the stream inputs and writes of the stream outputs, and `advise` reads of both. On entry of `resolve`
/// each output that is `same_as` an input has that input's facts; the others are unknown. An output port of a fixed type keeps
/// that type whatever `element` says.
class Facts {
 public:
  /// `settled`: the outputs have their facts already, as `advise` sees them.
  Facts(const BlockType& type, const bf_resolution& r, bool settled = false) : type_(&type) {
    for (std::uint32_t i = 0; i < r.input_count; ++i) inputs_.push_back(owned(r.inputs[i]));
    input_flows_.resize(r.input_count);
    output_flows_.resize(r.output_count);
    for (std::uint32_t o = 0; o < r.output_count; ++o) {
      const PortDraft& port = type.port(BF_STREAM, BF_OUT, static_cast<int>(o));
      StreamFacts facts;
      if (settled) {
        facts = owned(r.outputs[o]);
      } else if (port.same_as >= 0) {
        facts = inputs_.at(static_cast<std::size_t>(port.same_as));
      }
      outputs_.push_back(std::move(facts));
    }
  }

  template <class T>
  const StreamFacts& in(In<T> port) const {
    return inputs_.at(static_cast<std::size_t>(port.index));
  }
  template <class T>
  StreamFacts& out(Out<T> port) {
    return outputs_.at(static_cast<std::size_t>(port.index));
  }
  template <class T>
  const StreamFacts& out(Out<T> port) const {
    return outputs_.at(static_cast<std::size_t>(port.index));
  }

  /// A firing takes k samples of that input (1 otherwise).
  template <class T>
  void samples(In<T> port, std::int64_t k) {
    input_flows_.at(static_cast<std::size_t>(port.index)).samples = counted(port.name, k);
  }
  /// A firing gives k samples to that output (1 otherwise).
  template <class T>
  void samples(Out<T> port, std::int64_t k) {
    output_flows_.at(static_cast<std::size_t>(port.index)).samples = counted(port.name, k);
  }
  /// The edge to that input holds `delay` samples at the start: at firing n the block reads sample n - delay. `initial`:
  /// delay x channels values, channel after channel (complex: re, im pairs); empty: zeros.
  template <class T>
  void delay(In<T> port, std::int64_t delay, std::vector<double> initial = {}) {
    if (delay < 0) fail("a delay of " + std::to_string(delay) + " samples on input '" + port.name + "'; at least 0");
    Flow& flow = input_flows_.at(static_cast<std::size_t>(port.index));
    flow.delay = static_cast<std::uint64_t>(delay);
    flow.initial = std::move(initial);
  }

  /// Hands the outputs and flows to the host. What it points to lives in this object.
  void write(bf_resolution& r) {
    for (std::uint32_t i = 0; i < r.input_count; ++i) check_initial(i);
    names_.clear();
    names_.reserve(2 * outputs_.size());
    notes_.clear();
    notes_.reserve(outputs_.size());
    for (std::uint32_t o = 0; o < r.output_count; ++o) write_output(r.outputs[o], o);
    for (std::uint32_t i = 0; i < r.input_count; ++i) write_flow(r.input_flows[i], input_flows_[i]);
    for (std::uint32_t o = 0; o < r.output_count; ++o) write_flow(r.output_flows[o], output_flows_[o]);
  }

 private:
  struct Flow {
    std::uint32_t samples = 1;
    std::uint64_t delay = 0;
    std::vector<double> initial;
  };

  static std::uint32_t counted(const char* port, std::int64_t k) {
    if (k < 1 || k > INT32_MAX)
      fail("a firing with " + std::to_string(k) + " samples on port '" + port + "'; allowed: 1 to 2147483647");
    return static_cast<std::uint32_t>(k);
  }

  static StreamFacts owned(const bf_stream_facts& f) {
    StreamFacts facts;
    facts.known = f.known != 0;
    facts.element = f.element;
    facts.channels = static_cast<int>(f.channels);
    facts.rate = Rate(f.rate);
    facts.length = f.length;
    if (f.unit != nullptr) facts.unit = f.unit;
    if (f.clock != nullptr) facts.clock = f.clock;
    if (f.channel_names != nullptr) facts.channel_names.assign(f.channel_names, f.channel_names + f.channels);
    if (f.channel_units != nullptr) facts.channel_units.assign(f.channel_units, f.channel_units + f.channels);
    for (std::uint64_t i = 0; i < f.note_count; ++i)
      facts.notes[f.notes[i].name].assign(f.notes[i].values, f.notes[i].values + f.notes[i].count);
    return facts;
  }

  void check_initial(std::size_t input) const {
    const Flow& flow = input_flows_[input];
    const StreamFacts& facts = inputs_[input];
    if (flow.initial.empty() || !facts.known) return;
    const auto needed =
        flow.delay * static_cast<std::uint64_t>(facts.channels) * static_cast<std::uint64_t>(facts.element == BF_C64 ? 2 : 1);
    if (flow.initial.size() == needed) return;
    fail("input '" + type_->port(BF_STREAM, BF_IN, static_cast<int>(input)).name + "' has " +
         std::to_string(flow.initial.size()) + " initial values; needed: " + std::to_string(needed) + " (delay x channels)");
  }

  const char* const* names(const std::vector<std::string>& texts) {
    if (texts.empty()) return nullptr;
    std::vector<const char*> places;
    for (const std::string& t : texts) places.push_back(t.c_str());
    names_.push_back(std::move(places));
    return names_.back().data();
  }

  const bf_note* notes(const StreamFacts& f) {
    auto& list = notes_.emplace_back();
    for (const auto& [name, values] : f.notes) list.push_back({name.c_str(), values.data(), values.size()});
    return list.empty() ? nullptr : list.data();
  }

  void write_output(bf_stream_facts& to, std::size_t o) {
    const PortDraft& port = type_->port(BF_STREAM, BF_OUT, static_cast<int>(o));
    const StreamFacts& f = outputs_[o];
    if (f.known && f.channels < 1) fail("output '" + port.name + "' has " + std::to_string(f.channels) + " channels; at least 1");
    for (const auto* list : {&f.channel_names, &f.channel_units}) {
      if (f.known && !list->empty() && list->size() != static_cast<std::size_t>(f.channels)) {
        fail("output '" + port.name + "' names " + std::to_string(list->size()) + " channels, has " + std::to_string(f.channels));
      }
    }
    to.known = f.known ? 1 : 0;
    to.element = port.element == BF_ANY ? f.element : port.element;
    to.channels = static_cast<std::uint32_t>(f.channels);
    to.rate = f.rate.c();
    to.length = f.length;
    to.unit = f.unit.c_str();
    to.clock = f.clock.c_str();
    to.channel_names = f.known ? names(f.channel_names) : nullptr;
    to.channel_units = f.known ? names(f.channel_units) : nullptr;
    to.notes = f.known ? notes(f) : nullptr;
    to.note_count = f.known ? f.notes.size() : 0;
  }

  static void write_flow(bf_flow& to, const Flow& flow) {
    to.samples = flow.samples;
    to.delay = flow.delay;
    to.initial = flow.initial.empty() ? nullptr : flow.initial.data();
  }

  const BlockType* type_;
  std::vector<StreamFacts> inputs_, outputs_;
  std::vector<Flow> input_flows_, output_flows_;
  std::vector<std::vector<const char*>> names_;
  std::vector<std::vector<bf_note>> notes_;
};

}  // namespace v0
}  // namespace bodeflow
