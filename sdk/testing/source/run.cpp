#include "run.hpp"

#include <algorithm>
#include <bodeflow/record.hpp>
#include <bodeflow/testing/hook.hpp>
#include <cstring>

#include "signal.hpp"

namespace bodeflow::testing {
namespace {

/// Fills channel c of input i with the feed's signal, behind the initial samples of a delayed edge.
void fill(void* place, const Lane& lane, std::size_t input, std::size_t channel, std::size_t samples, const FlowFacts& flow,
          const Feed& feed) {
  const auto sample = [&](std::size_t of_channel, std::uint64_t n) {
    if (feed.signal == Feed::Signal::bad) return bad_sample(input, of_channel, n);
    if (feed.period == 0) return ordinary_sample(input, of_channel, n);
    return ordinary_sample(input, of_channel, n % feed.period) + 0.01 * ordinary_sample(input + 50, of_channel, n);
  };
  auto* values = static_cast<double*>(place);
  const std::size_t parts = lane.element == BF_C64 ? 2 : 1;
  for (std::size_t n = 0; n < samples; ++n) {
    for (std::size_t part = 0; part < parts; ++part) {
      if (n < flow.delay) {
        const std::size_t at = (channel * flow.delay + n) * parts + part;
        values[n * parts + part] = at < flow.initial.size() ? flow.initial[at] : 0.0;
      } else {
        values[n * parts + part] = sample(channel + 1000 * part, n - flow.delay);
      }
    }
  }
}

}  // namespace

Run::Run(const Rig& rig, const Calls& calls) : rig_(rig), calls_(calls) {
  make_inputs();
  make_outputs();
  if (calls.in_place) share_memory();
  in_.resize(inputs_.size());
  out_.resize(outputs_.size());
  process_.struct_size = sizeof process_;
  process_.inputs = in_.data();
  process_.outputs = out_.data();
  process_.context = this;
  process_.emit = &Run::emit;
  if (rig.case_.feed.messages == Feed::Messages::empty) make_messages();
}

Run::~Run() {
  for (bf_record* record : sent_) TestHost::release(record);
}

void Run::emit(bf_process* process, std::uint32_t port, bf_record* record, std::uint64_t offset) {
  Run& run = *static_cast<Run*>(process->context);
  const int armed = bodeflow_hook_pause != nullptr ? bodeflow_hook_pause(0) : 0;
  if (port >= run.rig_.message_outputs_) run.error_ = "sends on a message output that is not described";
  if (offset > process->count) run.error_ = "sends a record beyond the end of the call";
  if (const auto checked = RecordView::check({record->bytes, static_cast<std::size_t>(record->size)}); !checked) {
    run.error_ = "sends bytes that are no record: " + checked.error().text;
  }
  run.trace_.records.push_back({port, process->position + offset, {record->bytes, record->bytes + record->size}});
  TestHost::release(record);
  if (bodeflow_hook_pause != nullptr) bodeflow_hook_pause(armed);
}

void Run::make_inputs() {
  const auto known = rig_.input_facts(true);
  for (std::size_t i = 0; i < known.size(); ++i) {
    const FlowFacts& flow = rig_.facts_.input_flows[i];
    Lane lane{known[i].element, flow.samples, {}, {}};
    const auto samples = static_cast<std::size_t>(rig_.firings() * lane.samples);
    for (std::uint32_t c = 0; c < known[i].channels; ++c) {
      lane.buffers.push_back(std::make_shared<GuardedBuffer>(samples, element_size(lane.element), std::uint8_t{0}));
      lane.places.push_back(lane.buffers.back()->data());
      fill(lane.places.back(), lane, i, c, samples, flow, rig_.case_.feed);
    }
    inputs_.push_back(std::move(lane));
  }
}

void Run::make_outputs() {
  for (std::size_t o = 0; o < rig_.outputs_.size(); ++o) {
    const OutputFacts& f = rig_.facts_.outputs[o];
    if (!f.known) fail(std::string("output '") + rig_.outputs_[o]->name + "' is not resolved although all inputs are known");
    Lane lane{f.element, rig_.facts_.output_flows[o].samples, {}, {}};
    const auto samples = static_cast<std::size_t>(rig_.firings() * lane.samples);
    for (std::uint32_t c = 0; c < f.channels; ++c) {
      lane.buffers.push_back(std::make_shared<GuardedBuffer>(samples, element_size(lane.element), calls_.fill));
      lane.places.push_back(lane.buffers.back()->data());
    }
    outputs_.push_back(std::move(lane));
  }
}

void Run::share_memory() {
  for (std::size_t k = 0; k < std::min(inputs_.size(), outputs_.size()); ++k) {
    const bool equal = inputs_[k].element == outputs_[k].element && inputs_[k].places.size() == outputs_[k].places.size() &&
                       inputs_[k].samples == outputs_[k].samples && rig_.facts_.input_flows[k].delay == 0;
    if (!equal) continue;
    outputs_[k].buffers = inputs_[k].buffers;
    outputs_[k].places = inputs_[k].places;
  }
}

void Run::make_messages() {
  for (std::uint32_t i = 0; i < rig_.message_inputs_.size(); ++i) {
    const char* type = rig_.message_inputs_[i]->record_type;
    const RecordBuilder builder(type == nullptr ? "empty" : type);
    bf_record* record = rig_.host_->c()->record_create(rig_.host_->c(), builder.size());
    if (record == nullptr) throw std::bad_alloc();
    builder.write(record->bytes);
    sent_.push_back(record);
    messages_.push_back({i, 0, 0.0, record});
  }
}

void Run::place(std::uint64_t position, std::uint64_t count) {
  const auto view = [&](const Lane& l) {
    return bf_stream{l.places.data(), position * l.samples, count * l.samples, static_cast<std::uint32_t>(l.places.size()),
                     l.element};
  };
  process_.position = position;
  process_.count = process_.done = count;
  for (std::size_t i = 0; i < in_.size(); ++i) in_[i] = view(inputs_[i]);
  for (std::size_t o = 0; o < out_.size(); ++o) out_[o] = view(outputs_[o]);
}

std::uint64_t Run::next_count(std::uint64_t position, std::uint64_t total) {
  const std::uint64_t count = std::min(position == 0 && calls_.first != 0 ? calls_.first : calls_.size, total - position);
  if (calls_.change_at < 0) return count;
  const auto at = static_cast<std::uint64_t>(calls_.change_at);
  if (position == at) {
    const ValueView view(calls_.change_value);
    rig_.require(rig_.block_.change(rig_.block_.self, calls_.change_parameter, &view.c()), "change");
  }
  return position < at ? std::min(count, at - position) : count;
}

bool Run::took(std::int32_t result, const char* function) {
  if (result == BF_OK) return true;
  trace_.failure = std::string(function) + " fails: " + rig_.host_->take_error();
  return false;
}

bool Run::process() {
  if (!calls_.hooked) return took(rig_.block_.process(rig_.block_.self, &process_), "process");
  bodeflow_hook_begin();
  const std::int32_t result = rig_.block_.process(rig_.block_.self, &process_);
  const bodeflow_hook_counts counts = bodeflow_hook_end();
  if (!took(result, "process")) return false;
  if (counts.first == nullptr) return true;
  fail(std::string("process calls ") + counts.first + " at firing " + std::to_string(process_.position) + " (" +
       std::to_string(counts.allocations) + " times memory, " + std::to_string(counts.locks) + " locks, " +
       std::to_string(counts.calls) + " times input, output or sleep in one call)");
}

void Run::call_all() {
  const bool streams = !in_.empty() || !out_.empty();
  const std::uint64_t total = streams ? rig_.firings() : 0;
  process_.messages = messages_.data();
  process_.message_count = static_cast<std::uint32_t>(messages_.size());
  for (bool ended = false; !ended && (trace_.firings < total || process_.message_count != 0);) {
    place(trace_.firings, next_count(trace_.firings, total));
    if (!process()) return;
    if (process_.done > process_.count) {
      fail("process says that it made " + std::to_string(process_.done) + " of " + std::to_string(process_.count) + " firings");
    }
    ended = process_.done < process_.count;
    trace_.firings += process_.done;
    process_.message_count = 0;
  }
  place(trace_.firings, 0);
  took(rig_.block_.finish(rig_.block_.self, &process_), "finish");
}

Trace Run::whole() {
  call_all();
  if (!error_.empty()) fail(error_);
  if (!trace_.failure.empty()) trace_.firings = 0;  // how much of the call was done before it failed is not defined
  collect();
  return std::move(trace_);
}

void Run::collect() {
  const auto intact = [](const Lane& lane, const char* what, const char* name) {
    for (std::size_t c = 0; c < lane.buffers.size(); ++c) {
      if (!lane.buffers[c]->intact())
        fail(std::string("writes outside of ") + what + " '" + name + "', channel " + std::to_string(c));
    }
  };
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    const Lane& lane = inputs_[i];
    intact(lane, "input", rig_.inputs_[i]->name);
    const auto samples = static_cast<std::size_t>(rig_.firings() * lane.samples);
    for (std::size_t c = 0; c < lane.places.size(); ++c) {
      GuardedBuffer fresh(samples, element_size(lane.element), 0);
      fill(fresh.data(), lane, i, c, samples, rig_.facts_.input_flows[i], rig_.case_.feed);
      if (std::memcmp(fresh.data(), lane.places[c], samples * element_size(lane.element)) != 0) trace_.inputs_intact = false;
    }
  }
  for (std::size_t o = 0; o < outputs_.size(); ++o) {
    const Lane& lane = outputs_[o];
    intact(lane, "output", rig_.outputs_[o]->name);
    std::vector<std::vector<std::uint8_t>> channels;
    for (const void* place : lane.places) {
      const auto* bytes = static_cast<const std::uint8_t*>(place);
      channels.emplace_back(bytes, bytes + trace_.firings * lane.samples * element_size(lane.element));
    }
    trace_.outputs.push_back(std::move(channels));
  }
}

}  // namespace bodeflow::testing
