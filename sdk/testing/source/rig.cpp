#include "rig.hpp"

#include <algorithm>
#include <bodeflow/record.hpp>
#include <bodeflow/testing/hook.hpp>

#include "run.hpp"

namespace bodeflow::testing {
namespace {

OutputFacts copied(const bf_stream_facts& f) {
  OutputFacts facts;
  facts.known = f.known != 0;
  if (!facts.known) return facts;
  facts.element = f.element;
  facts.channels = f.channels;
  facts.rate = Rate(f.rate);
  facts.length = f.length;
  facts.unit = f.unit == nullptr ? "" : f.unit;
  facts.clock = f.clock == nullptr ? "" : f.clock;
  if (f.channel_names != nullptr) facts.channel_names.assign(f.channel_names, f.channel_names + f.channels);
  if (f.channel_units != nullptr) facts.channel_units.assign(f.channel_units, f.channel_units + f.channels);
  return facts;
}

FlowFacts copied(const bf_flow& f, std::uint32_t channels, std::uint32_t element) {
  FlowFacts flow{f.samples, f.delay, {}};
  if (f.initial != nullptr) flow.initial.assign(f.initial, f.initial + f.delay * channels * (element == BF_C64 ? 2u : 1u));
  return flow;
}

}  // namespace

Rig::Rig(const Case& the_case) : case_(the_case), host_(std::make_unique<TestHost>()) {
  const bf_block_descriptor& d = *case_.block;
  for (std::uint32_t i = 0; i < d.port_count; ++i) {
    const bf_port_descriptor* p = d.ports[i];
    if (p->kind == BF_STREAM) (p->direction == BF_IN ? inputs_ : outputs_).push_back(p);
    if (p->kind == BF_MESSAGE && p->direction == BF_IN) message_inputs_.push_back(p);
    if (p->kind == BF_MESSAGE && p->direction == BF_OUT) ++message_outputs_;
  }
  for (const bf_port_descriptor* port : inputs_) {
    auto& list = notes_.emplace_back();
    const auto found = case_.feed.notes.find(port->name);
    if (found == case_.feed.notes.end()) continue;
    for (const auto& [name, values] : found->second) list.push_back({name.c_str(), values.data(), values.size()});
  }
  require(case_.factory->create(case_.factory, host_->c(), &block_), "create");
  if (block_.struct_size == 0 || block_.destroy == nullptr || block_.process == nullptr)
    fail("create gives an incomplete bf_block");
}

Rig::~Rig() {
  if (active_) block_.deactivate(block_.self);
  if (block_.destroy != nullptr) block_.destroy(block_.self);
}

void Rig::require(std::int32_t result, const char* function) const {
  if (result != BF_OK) fail(std::string(function) + " fails: " + host_->take_error());
}

void Rig::configure() {
  std::vector<ValueView> views;
  views.reserve(case_.values.size());
  std::vector<bf_parameter_value> values;
  for (const StoredValue& v : case_.values) values.push_back(views.emplace_back(v).c());
  require(block_.configure(block_.self, values.data(), static_cast<std::uint32_t>(values.size())), "configure");
}

std::vector<bf_stream_facts> Rig::input_facts(bool known) const {
  std::vector<bf_stream_facts> facts;
  const Feed& feed = case_.feed;
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    const bf_port_descriptor* port = inputs_[i];
    bf_stream_facts f{};
    f.struct_size = sizeof f;
    f.length = -1;
    f.unit = f.clock = "";
    f.rate = {0, 1};
    const bool may_be_open = (port->flags & BF_PORT_OPTIONAL) != 0;
    const bool connected = !may_be_open || (feed.optional_connected && feed.unconnected.count(port->name) == 0);
    if (known && connected) {
      f.known = 1;
      const auto own = feed.channels_of.find(port->name);
      f.element = port->element == BF_ANY ? feed.element : port->element;
      f.channels = own == feed.channels_of.end() ? feed.channels : own->second;
      f.rate = feed.rate.c();
      f.notes = notes_[i].data();
      f.note_count = notes_[i].size();
    }
    facts.push_back(f);
  }
  return facts;
}

Resolved Rig::resolve(bool known) {
  std::vector<bf_stream_facts> in = input_facts(known), out(outputs_.size());
  for (bf_stream_facts& f : out) {
    f = {};
    f.struct_size = sizeof f;
    f.length = -1;
    f.unit = f.clock = "";
    f.rate = {0, 1};
  }
  std::vector<bf_flow> in_flows(in.size(), {sizeof(bf_flow), 1, 0, nullptr}),
      out_flows(out.size(), {sizeof(bf_flow), 1, 0, nullptr});
  bf_resolution r{sizeof(bf_resolution),
                  static_cast<std::uint32_t>(in.size()),
                  static_cast<std::uint32_t>(out.size()),
                  in.data(),
                  out.data(),
                  in_flows.data(),
                  out_flows.data()};
  require(block_.resolve(block_.self, &r), "resolve");
  if (known) advise(r);
  Resolved facts;
  for (const auto& f : out) facts.outputs.push_back(copied(f));
  for (std::size_t i = 0; i < in.size(); ++i) facts.input_flows.push_back(copied(in_flows[i], in[i].channels, in[i].element));
  for (const auto& f : out_flows) facts.output_flows.push_back(copied(f, 0, BF_F64));
  return facts;
}

/// A block that gives advice gives it for facts that are known, and fails at none.
void Rig::advise(const bf_resolution& resolved) const {
  if (block_.extension == nullptr) return;
  const auto* advice = static_cast<const bf_advice*>(block_.extension(block_.self, BF_EXTENSION_ADVICE));
  if (advice == nullptr) return;
  const auto tell = [](void*, std::int32_t level, const char* text) {
    if (level != BF_LOG_INFO && level != BF_LOG_WARNING) fail("advise tells with level " + std::to_string(level));
    if (text == nullptr || *text == '\0') fail("advise tells nothing");
  };
  require(advice->advise(block_.self, &resolved, nullptr, tell), "advise");
}

void Rig::activate(std::uint64_t max_count) {
  facts_ = resolve();
  std::uint32_t samples = 1;
  Rate of_stream{0, 1};
  if (!inputs_.empty()) {
    of_stream = case_.feed.rate;
    samples = facts_.input_flows[0].samples;
  } else if (!facts_.outputs.empty()) {
    of_stream = facts_.outputs[0].rate;
    samples = facts_.output_flows[0].samples;
  }
  bf_activation a{sizeof(bf_activation), 0, max_count, 12345, of_stream.scaled(1, samples).c(), 1, 0};
  require(block_.activate(block_.self, &a), "activate");
  active_ = true;
}

std::uint64_t Rig::firings() const {
  constexpr std::uint64_t kMostSamples = 1 << 21;  // of one lane: keeps the memory of a test within a few dozen megabytes
  std::uint64_t most = 1;
  for (std::size_t i = 0; i < inputs_.size(); ++i) most = std::max<std::uint64_t>(most, facts_.input_flows[i].samples);
  for (const FlowFacts& f : facts_.output_flows) most = std::max<std::uint64_t>(most, f.samples);
  return std::min(case_.feed.firings, kMostSamples / most);
}

Trace Rig::run(const Calls& calls) { return Run(*this, calls).whole(); }

void Rig::reset() { require(block_.reset(block_.self), "reset"); }

void Rig::deactivate() {
  block_.deactivate(block_.self);
  active_ = false;
}

}  // namespace bodeflow::testing
