#pragma once

#include <dlfcn.h>

#include <bodeflow/block.hpp>
#include <list>
#include <memory>
#include <string>
#include <vector>

namespace bodeflow::test {

/// Samples of one port, channel by channel; complex ones as re, im, re, im.
using Channels = std::vector<std::vector<double>>;

/// What an input is connected to.
struct Stream {
  StreamFacts facts;
  Channels channels;

  /// A known stream of one real channel.
  static Stream of(std::vector<double> samples, Rate rate = {1000, 1}) { return with(Channels{std::move(samples)}, rate); }
  /// One of several channels.
  static Stream with(Channels channels, Rate rate = {1000, 1}) {
    Stream stream;
    stream.facts.known = true;
    stream.facts.channels = static_cast<int>(channels.size());
    stream.facts.rate = rate;
    stream.channels = std::move(channels);
    return stream;
  }
};

/// A block of a plugin file of this build, driven as a host does: parameters by name, edges with delays, calls of any size.
/// Failures of the block are thrown with its text. In-place memory where `share` is set.
class LoadedBlock {
 public:
  explicit LoadedBlock(const std::string& id) {
    const std::string file = BODEFLOW_BUILD_DIR "/plugins/" + id.substr(0, id.find('.')) + ".so";
    library_.reset(dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL));
    if (!library_) throw Failure(dlerror());
    host_.struct_size = sizeof host_;
    host_.context = this;
    host_.error = [](const bf_host* h, const char* text) { static_cast<LoadedBlock*>(h->context)->error_ = text; };
    host_.extension = [](const bf_host*, const char* name) -> const void* {
      static const bf_log log{sizeof(bf_log), [](const bf_host* h, std::int32_t, const char* text) {
                                static_cast<LoadedBlock*>(h->context)->log_.push_back(text);
                              }};
      return std::string(name) == BF_EXTENSION_LOG ? &log : nullptr;
    };
    const auto* plugin = static_cast<const bf_plugin*>(dlsym(library_.get(), BF_PLUGIN_SYMBOL));
    std::uint32_t count = 0;
    const auto* factories = plugin->factories(&host_, &count);
    for (std::uint32_t i = 0; i < count; ++i) {
      if (factories[i]->id == id) make(*factories[i]);
    }
    if (block_.self == nullptr) throw Failure("no block " + id);
  }
  ~LoadedBlock() {
    if (block_.self != nullptr) block_.destroy(block_.self);
  }
  LoadedBlock(const LoadedBlock&) = delete;
  LoadedBlock& operator=(const LoadedBlock&) = delete;

  /// Gives a parameter; its C++ type is the described one.
  template <class T>
  LoadedBlock& set(const std::string& name, const T& value) {
    values_[index(name)] = given(name, value);
    return *this;
  }

  /// Connects the stream inputs in order; the rest stays unconnected.
  LoadedBlock& feed(std::vector<Stream> inputs) {
    inputs_ = std::move(inputs);
    return *this;
  }

  void configure() {
    std::list<std::vector<const char*>> texts;
    std::vector<bf_parameter_value> values;
    for (const StoredValue& value : values_) values.push_back(borrowed(value, texts));
    check(block_.configure(block_.self, values.data(), static_cast<std::uint32_t>(values.size())));
  }

  /// The facts of the outputs.
  const std::vector<StreamFacts>& resolve() {
    std::vector<bf_stream_facts> in(ports(BF_IN), bf_stream_facts{}), out(ports(BF_OUT), bf_stream_facts{});
    std::list<std::vector<bf_note>> notes;
    input_flows_.assign(in.size(), {sizeof(bf_flow), 1, 0, nullptr});
    output_flows_.assign(out.size(), {sizeof(bf_flow), 1, 0, nullptr});
    for (std::size_t i = 0; i < inputs_.size(); ++i) {
      const StreamFacts& f = inputs_[i].facts;
      in[i] = {sizeof in[i], f.known,  f.element,      static_cast<std::uint32_t>(f.channels),
               f.rate.c(),   f.length, f.unit.c_str(), "",
               nullptr,      nullptr,  nullptr,        0};
      auto& noted = notes.emplace_back();
      for (const auto& [name, numbers] : f.notes) noted.push_back({name.c_str(), numbers.data(), numbers.size()});
      in[i].notes = noted.data();
      in[i].note_count = noted.size();
    }
    for (std::size_t i = inputs_.size(); i < in.size(); ++i) in[i].unit = in[i].clock = "";
    bf_resolution r{sizeof r,
                    static_cast<std::uint32_t>(in.size()),
                    static_cast<std::uint32_t>(out.size()),
                    in.data(),
                    out.data(),
                    input_flows_.data(),
                    output_flows_.data()};
    check(block_.resolve(block_.self, &r));
    outputs_.clear();
    for (const bf_stream_facts& c : out) {
      StreamFacts f;
      f.known = c.known != 0;
      f.element = c.element;
      f.channels = static_cast<int>(c.channels);
      f.rate = Rate(c.rate);
      f.length = c.length;
      f.unit = c.unit;
      if (c.channel_names != nullptr) f.channel_names.assign(c.channel_names, c.channel_names + c.channels);
      for (std::uint64_t i = 0; i < c.note_count; ++i)
        f.notes[c.notes[i].name].assign(c.notes[i].values, c.notes[i].values + c.notes[i].count);
      outputs_.push_back(f);
    }
    return outputs_;
  }

  /// configure, resolve and activate for calls of up to `max_count` firings.
  LoadedBlock& start(std::uint64_t max_count = 4096, std::uint64_t seed = 1) {
    configure();
    resolve();
    const bf_flow& flow = inputs_.empty() ? output_flows_.at(0) : input_flows_.at(0);
    const Rate rate = (inputs_.empty() ? outputs_.at(0).rate : inputs_[0].facts.rate).scaled(1, flow.samples);
    const bf_activation a{sizeof a, 0, max_count, seed, rate.c(), 1, 0};
    check(block_.activate(block_.self, &a));
    return *this;
  }

  /// The samples that `firings` more firings give at the first output, in calls of `chunk`. Outputs share the first input's
  /// memory if `share`.
  Channels run(std::uint64_t firings, std::uint64_t chunk = 256, bool share = false) {
    Channels result(static_cast<std::size_t>(outputs_.at(0).channels));
    for (std::uint64_t done = 0; done < firings && !ended_; done += chunk) call(std::min(chunk, firings - done), share, result);
    return result;
  }

  template <class T>
  void change(const std::string& name, const T& value) {
    std::list<std::vector<const char*>> texts;
    const StoredValue stored = given(name, value);
    const bf_parameter_value c = borrowed(stored, texts);
    check(block_.change(block_.self, static_cast<std::uint32_t>(index(name)), &c));
  }

  void reset() {
    check(block_.reset(block_.self));
    position_ = 0;
    ended_ = false;
  }

  /// Goes on as if that many firings had been made; only for blocks that look at the position alone.
  void jump_to(std::uint64_t position) { position_ = position; }

  const std::vector<bf_flow>& input_flows() const { return input_flows_; }
  const std::vector<bf_flow>& output_flows() const { return output_flows_; }
  const std::vector<std::string>& log() const { return log_; }

 private:
  struct Close {
    void operator()(void* library) const { dlclose(library); }
  };

  void check(std::int32_t status) {
    if (status != BF_OK) throw Failure(error_);
  }

  void make(const bf_factory& factory) {
    type_ = static_cast<const bf_block_descriptor*>(factory.descriptor);
    check(factory.create(&factory, &host_, &block_));
    for (std::uint32_t i = 0; i < type_->parameter_count; ++i) {
      StoredValue value;
      value.assign(type_->parameters[i]->fallback);
      value.type = type_->parameters[i]->type;
      values_.push_back(value);
    }
  }

  std::size_t index(const std::string& name) const {
    for (std::uint32_t i = 0; i < type_->parameter_count; ++i) {
      if (type_->parameters[i]->name == name) return i;
    }
    throw Failure("no parameter " + name);
  }

  template <class T>
  StoredValue given(const std::string& name, const T& value) const {
    StoredValue stored;
    if constexpr (std::is_convertible_v<const T&, std::string>) {
      stored = stored_value(std::string(value));
    } else {
      stored = stored_value(value);
    }
    const std::uint32_t type = type_->parameters[index(name)]->type;
    if (stored.type != type && !(stored.type == BF_STRING && type == BF_CHOICE))
      throw Failure("parameter " + name + " has another type");
    stored.type = type;
    stored.given = true;
    return stored;
  }

  static bf_parameter_value borrowed(const StoredValue& s, std::list<std::vector<const char*>>& texts) {
    texts.emplace_back();
    for (const std::string& text : s.strings) texts.back().push_back(text.c_str());
    return {
        sizeof(bf_parameter_value), s.type, s.given ? 1u : 0u, s.rows, s.columns, s.integer, s.numbers.data(), s.integers.data(),
        texts.back().data()};
  }

  std::size_t ports(std::uint32_t direction) const {
    std::size_t count = 0;
    for (std::uint32_t i = 0; i < type_->port_count; ++i) {
      if (type_->ports[i]->kind == BF_STREAM && type_->ports[i]->direction == direction) ++count;
    }
    return count;
  }

  static std::size_t doubles(std::uint32_t element) { return element == BF_C64 ? 2 : 1; }

  // The samples that the edge hands over at firings position_ .. position_ + count - 1: the input, delayed.
  Channels edge(std::size_t port, std::uint64_t count) const {
    const Stream& stream = inputs_[port];
    const bf_flow& flow = input_flows_[port];
    const std::size_t width = doubles(stream.facts.element);
    Channels samples(stream.channels.size());
    for (std::size_t c = 0; c < samples.size(); ++c) {
      for (std::uint64_t n = position_ * flow.samples * width; n < (position_ + count) * flow.samples * width; ++n) {
        const std::uint64_t held = flow.delay * width;
        const double initial = flow.initial == nullptr || n >= held ? 0.0 : flow.initial[c * held + n];
        samples[c].push_back(n < held ? initial : stream.channels[c].at(n - held));
      }
    }
    return samples;
  }

  void call(std::uint64_t count, bool share, Channels& result) {
    std::vector<Channels> in(ports(BF_IN));
    std::list<std::vector<void*>> places;
    std::vector<bf_stream> in_streams, out_streams;
    for (std::size_t p = 0; p < in.size(); ++p) {
      places.emplace_back();
      const bool connected = p < inputs_.size();
      if (connected) in[p] = edge(p, count);
      for (auto& channel : in[p]) places.back().push_back(channel.data());
      in_streams.push_back({places.back().data(), 0, connected ? count * input_flows_[p].samples : 0,
                            static_cast<std::uint32_t>(in[p].size()),
                            connected ? inputs_[p].facts.element : static_cast<std::uint32_t>(BF_F64)});
    }
    const std::size_t width = doubles(outputs_[0].element);
    Channels out(result.size(), std::vector<double>(count * output_flows_[0].samples * width, -7.0));
    places.emplace_back();
    for (std::size_t c = 0; c < out.size(); ++c) {
      if (share) out[c].clear();
      places.back().push_back(share ? in[0][c].data() : out[c].data());
    }
    out_streams.push_back(
        {places.back().data(), 0, count * output_flows_[0].samples, static_cast<std::uint32_t>(out.size()), outputs_[0].element});
    std::list<Channels> others;  // outputs that the test does not look at
    for (std::size_t o = 1; o < outputs_.size(); ++o) {
      const std::uint64_t samples = count * output_flows_[o].samples;
      auto& other = others.emplace_back(static_cast<std::size_t>(outputs_[o].channels),
                                        std::vector<double>(samples * doubles(outputs_[o].element)));
      places.emplace_back();
      for (auto& channel : other) places.back().push_back(channel.data());
      out_streams.push_back({places.back().data(), 0, samples, static_cast<std::uint32_t>(other.size()), outputs_[o].element});
    }
    bf_process p{};
    p.struct_size = sizeof p;
    p.inputs = in_streams.data();
    p.outputs = out_streams.data();
    p.position = position_;
    p.count = p.done = count;
    check(block_.process(block_.self, &p));
    for (std::size_t c = 0; c < out.size(); ++c) {
      const std::vector<double>& made = share ? in[0][c] : out[c];
      result[c].insert(result[c].end(), made.begin(),
                       made.begin() + static_cast<std::ptrdiff_t>(p.done * output_flows_[0].samples * width));
    }
    ended_ = p.done < count;
    position_ += p.done;
  }

  std::unique_ptr<void, Close> library_;
  bf_host host_{};
  const bf_block_descriptor* type_ = nullptr;
  bf_block block_{};
  std::string error_;
  std::vector<std::string> log_;
  std::vector<StoredValue> values_;
  std::vector<Stream> inputs_;
  std::vector<bf_flow> input_flows_, output_flows_;
  std::vector<StreamFacts> outputs_;
  std::uint64_t position_ = 0;
  bool ended_ = false;
};

/// The text of the Failure that `work` ends with, or "no failure".
template <class Work>
std::string refusal_of(Work&& work) {
  try {
    work();
  } catch (const Failure& failure) {
    return failure.what();
  }
  return "no failure";
}

}  // namespace bodeflow::test
