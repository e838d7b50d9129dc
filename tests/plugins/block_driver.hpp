#pragma once

#include <bodeflow/block.hpp>
#include <cstdlib>
#include <filesystem>
#include <list>
#include <map>
#include <string>
#include <vector>

namespace bodeflow::test {

/// Samples of one port: channel by channel.
using Channels = std::vector<std::vector<double>>;

/// A block of class B between the ABI and a test: what a host does, for one block. Failures are thrown with the block's text.
template <class B>
class BlockDriver {
 public:
  BlockDriver() {
    host_.struct_size = sizeof host_;
    host_.context = this;
    host_.error = [](const bf_host* h, const char* text) { self(h).error_ = text; };
    host_.extension = extension;
    host_.record_create = create;
    host_.record_retain = [](const bf_host*, const bf_record*) {};
    host_.record_release = [](const bf_host*, const bf_record* r) { destroy(r); };
    check(Border<B>::create(nullptr, &host_, &block_));
    for (const ParameterDraft& p : block_type<B>().draft().parameters) values_.push_back(p.fallback);
  }
  ~BlockDriver() {
    if (block_.self != nullptr) block_.destroy(block_.self);
    for (const bf_record* r : records_) destroy(r);
  }
  BlockDriver(const BlockDriver&) = delete;
  BlockDriver& operator=(const BlockDriver&) = delete;

  /// Folder for output files; none: as in a check.
  void write_to(std::filesystem::path folder) { folder_ = std::move(folder); }

  /// Gives a parameter; its C++ type is the described one.
  template <class T>
  BlockDriver& set(const std::string& name, const T& value) {
    const auto& drafts = block_type<B>().draft().parameters;
    for (std::size_t i = 0; i < drafts.size(); ++i) {
      if (drafts[i].name != name) continue;
      values_[i] = stored(value);
      values_[i].type = drafts[i].type;
      values_[i].given = true;
      return *this;
    }
    throw Failure("no parameter " + name);
  }

  void configure() {
    std::vector<bf_parameter_value> values;
    std::list<std::vector<const char*>> texts;
    for (const StoredValue& s : values_) {
      std::vector<const char*> words;
      for (const std::string& t : s.strings) words.push_back(t.c_str());
      texts.push_back(std::move(words));
      values.push_back({sizeof(bf_parameter_value), s.type, s.given ? 1u : 0u, s.rows, s.columns, s.integer, s.numbers.data(),
                        s.integers.data(), texts.back().data()});
    }
    check(block_.configure(block_.self, values.data(), static_cast<std::uint32_t>(values.size())));
  }

  /// The facts of the outputs.
  std::vector<StreamFacts> resolve(const std::vector<StreamFacts>& inputs) {
    bf_resolution r{};
    r.struct_size = sizeof r;
    std::vector<bf_stream_facts> in(inputs.size()), out(count(BF_OUT));
    std::list<std::vector<const char*>> texts;
    for (std::size_t i = 0; i < inputs.size(); ++i) in[i] = borrowed(inputs[i], texts);
    std::vector<bf_flow> flows(inputs.size() + out.size(), bf_flow{sizeof(bf_flow), 1, 0, nullptr});
    r.input_count = static_cast<std::uint32_t>(in.size());
    r.output_count = static_cast<std::uint32_t>(out.size());
    r.inputs = in.data();
    r.outputs = out.data();
    r.input_flows = flows.data();
    r.output_flows = flows.data() + in.size();
    check(block_.resolve(block_.self, &r));
    input_facts_ = inputs;
    samples_.clear();
    for (const bf_flow& f : flows) samples_.push_back(f.samples);
    outputs_.clear();
    for (const bf_stream_facts& f : out) outputs_.push_back(owned(f));
    return outputs_;
  }

  /// What the block advises to these facts; warnings begin with "warning: ".
  std::vector<std::string> advise(const std::vector<StreamFacts>& inputs) {
    const std::vector<StreamFacts> outputs = resolve(inputs);
    std::list<std::vector<const char*>> texts;
    std::vector<bf_stream_facts> in, out;
    for (const StreamFacts& f : inputs) in.push_back(borrowed(f, texts));
    for (const StreamFacts& f : outputs) out.push_back(borrowed(f, texts));
    std::vector<bf_flow> flows(in.size() + out.size(), bf_flow{sizeof(bf_flow), 1, 0, nullptr});
    const bf_resolution r{sizeof r,
                          static_cast<std::uint32_t>(in.size()),
                          static_cast<std::uint32_t>(out.size()),
                          in.data(),
                          out.data(),
                          flows.data(),
                          flows.data() + in.size()};
    const auto* advice = static_cast<const bf_advice*>(block_.extension(block_.self, BF_EXTENSION_ADVICE));
    std::vector<std::string> said;
    check(advice->advise(block_.self, &r, &said, [](void* to, std::int32_t level, const char* text) {
      static_cast<std::vector<std::string>*>(to)->push_back((level == BF_LOG_WARNING ? "warning: " : "") + std::string(text));
    }));
    return said;
  }

  void activate(std::uint64_t max_count, Rate rate) {
    const bf_activation a{sizeof(bf_activation), 0, max_count, 1, rate.c(), 1, 0};
    check(block_.activate(block_.self, &a));
  }

  /// One call with `count` firings, whose samples `inputs` holds; the outputs, port by port. `done` becomes what a source made of
  /// them.
  std::vector<Channels> process(const std::vector<Channels>& inputs, std::uint64_t count) {
    return call(block_.process, inputs, count, nullptr);
  }
  void receive(const RecordBuilder& record, double time_s, std::uint32_t port = 0) {
    bf_record* made = create(&host_, record.size());
    record.write(made->bytes);
    const bf_message message{port, 0, time_s, made};
    try {
      call(block_.process, std::vector<Channels>(count(BF_IN)), 0, &message);
    } catch (...) {
      destroy(made);
      throw;
    }
    destroy(made);
  }
  void finish() { call(block_.finish, std::vector<Channels>(count(BF_IN)), 0, nullptr); }
  void reset() {
    check(block_.reset(block_.self));
    position_ = 0;
  }
  void deactivate() { block_.deactivate(block_.self); }

  std::uint64_t done() const { return done_; }
  const std::vector<std::string>& log() const { return log_; }
  /// The records sent so far, and the firing that each follows.
  const std::vector<const bf_record*>& records() const { return records_; }
  const std::vector<std::uint64_t>& record_positions() const { return record_positions_; }

 private:
  static BlockDriver& self(const bf_host* h) { return *static_cast<BlockDriver*>(h->context); }

  static StoredValue stored(const char* text) { return stored_value(std::string(text)); }
  template <class T>
  static StoredValue stored(const T& value) {
    return stored_value(value);
  }

  static const void* extension(const bf_host*, const char* id) {
    static const bf_log log{sizeof(bf_log), [](const bf_host* h, std::int32_t level, const char* text) {
                              self(h).log_.push_back((level == BF_LOG_WARNING ? "warning: " : "") + std::string(text));
                            }};
    static const bf_files files{sizeof(bf_files), [](const bf_host*, const char*) -> std::int32_t { return BF_OK; },
                                [](const bf_host* h, const char* name) -> const char* {
                                  BlockDriver& d = self(h);
                                  if (d.folder_.empty()) return nullptr;
                                  d.paths_.push_back((d.folder_ / name).string());
                                  return d.paths_.back().c_str();
                                }};
    if (std::string_view(id) == BF_EXTENSION_LOG) return &log;
    if (std::string_view(id) == BF_EXTENSION_FILES) return &files;
    return nullptr;
  }

  static bf_record* create(const bf_host*, std::uint64_t size) {
    return new bf_record{static_cast<std::uint8_t*>(std::aligned_alloc(64, size)), size};
  }
  static void destroy(const bf_record* r) {
    std::free(r->bytes);
    delete r;
  }

  void check(std::int32_t status) {
    if (status != BF_OK) throw Failure(error_);
  }

  std::size_t count(std::uint32_t direction) const {
    return static_cast<std::size_t>(block_type<B>().count(BF_STREAM, direction));
  }

  bf_stream_facts borrowed(const StreamFacts& f, std::list<std::vector<const char*>>& texts) {
    const auto words = [&texts](const std::vector<std::string>& list) -> const char* const* {
      if (list.empty()) return nullptr;
      std::vector<const char*> places;
      for (const std::string& t : list) places.push_back(t.c_str());
      texts.push_back(std::move(places));
      return texts.back().data();
    };
    bf_stream_facts c{};
    c.struct_size = sizeof c;
    c.known = f.known ? 1 : 0;
    c.element = f.element;
    c.channels = static_cast<std::uint32_t>(f.channels);
    c.rate = f.rate.c();
    c.length = f.length;
    c.unit = f.unit.c_str();
    c.clock = f.clock.c_str();
    c.channel_names = words(f.channel_names);
    c.channel_units = words(f.channel_units);
    auto& notes = notes_.emplace_back();
    for (const auto& [name, values] : f.notes) notes.push_back({name.c_str(), values.data(), values.size()});
    c.notes = notes.data();
    c.note_count = notes.size();
    return c;
  }
  static StreamFacts owned(const bf_stream_facts& c) {
    StreamFacts f;
    f.known = c.known != 0;
    f.element = c.element;
    f.channels = static_cast<int>(c.channels);
    f.rate = Rate(c.rate);
    f.length = c.length;
    if (c.unit != nullptr) f.unit = c.unit;
    if (c.clock != nullptr) f.clock = c.clock;
    for (std::uint64_t i = 0; i < c.note_count; ++i)
      f.notes[c.notes[i].name].assign(c.notes[i].values, c.notes[i].values + c.notes[i].count);
    if (c.channel_names != nullptr) f.channel_names.assign(c.channel_names, c.channel_names + c.channels);
    if (c.channel_units != nullptr) f.channel_units.assign(c.channel_units, c.channel_units + c.channels);
    return f;
  }

  /// Samples that a firing moves on a port, the inputs before the outputs.
  std::uint64_t samples_of(std::size_t port) const { return port < samples_.size() ? samples_[port] : 1; }

  template <class Function>
  std::vector<Channels> call(Function function, const std::vector<Channels>& inputs, std::uint64_t firings,
                             const bf_message* message) {
    std::vector<Channels> in = inputs, out(outputs_.size());
    for (std::size_t p = 0; p < in.size(); ++p) {
      if (in[p].empty() && p < input_facts_.size()) in[p].resize(static_cast<std::size_t>(input_facts_[p].channels));
    }
    for (std::size_t p = 0; p < out.size(); ++p) {
      out[p].assign(static_cast<std::size_t>(outputs_[p].known ? outputs_[p].channels : 0),
                    std::vector<double>(firings * samples_of(in.size() + p)));
    }
    std::list<std::vector<void*>> places;
    const auto streams = [&](std::vector<Channels>& ports, bool elements_of_inputs) {
      std::vector<bf_stream> made;
      for (std::size_t p = 0; p < ports.size(); ++p) {
        std::vector<void*> at;
        for (auto& channel : ports[p]) at.push_back(channel.data());
        places.push_back(std::move(at));
        const bool complex = elements_of_inputs && p < input_facts_.size() && input_facts_[p].element == BF_C64;
        const std::uint64_t samples = firings * samples_of(elements_of_inputs ? p : inputs.size() + p);
        made.push_back({places.back().data(), 0, samples, static_cast<std::uint32_t>(ports[p].size()),
                        static_cast<std::uint32_t>(complex ? BF_C64 : BF_F64)});
      }
      return made;
    };
    const auto in_streams = streams(in, true), out_streams = streams(out, false);
    bf_process p{};
    p.struct_size = sizeof p;
    p.message_count = message == nullptr ? 0 : 1;
    p.messages = message;
    p.inputs = in_streams.data();
    p.outputs = out_streams.data();
    p.position = position_;
    p.count = p.done = firings;
    p.context = this;
    p.emit = [](bf_process* from, std::uint32_t, bf_record* record, std::uint64_t offset) {
      auto& driver = *static_cast<BlockDriver*>(from->context);
      driver.records_.push_back(record);
      driver.record_positions_.push_back(from->position + offset);
    };
    check(function(block_.self, &p));
    position_ += firings;
    done_ = p.done;
    return out;
  }

  bf_host host_{};
  bf_block block_{};
  std::string error_;
  std::vector<StoredValue> values_;
  std::vector<StreamFacts> input_facts_, outputs_;
  std::vector<std::uint32_t> samples_;
  std::vector<std::string> log_;
  std::vector<const bf_record*> records_;
  std::vector<std::uint64_t> record_positions_;
  std::filesystem::path folder_;
  std::list<std::string> paths_;
  std::list<std::vector<bf_note>> notes_;
  std::uint64_t position_ = 0, done_ = 0;
};

/// The text of the Failure that `work` ends with, or "no failure".
template <class Work>
std::string failure_of(Work&& work) {
  try {
    work();
  } catch (const Failure& f) {
    return f.what();
  }
  return "no failure";
}

}  // namespace bodeflow::test
