// A stream between hosts: its samples leave here and come in there.
#include <bodeflow/record_layout.hpp>
#include <cstring>

#include "execute/run.hpp"
#include "lab/end_base.hpp"

namespace bodeflow::lab {
namespace {

using Result = tl::expected<void, std::string>;

BlockDescription description(std::uint32_t direction, const char* id, const char* port) {
  BlockDescription type;
  type.id = id;
  PortDescription described;
  described.direction = direction;
  described.name = port;
  type.ports.push_back(described);
  return type;
}

/// Samples that one message may carry.
std::uint64_t most_samples(const StreamFacts& facts) {
  constexpr std::uint64_t kMessage = 1 << 20;
  return std::max<std::uint64_t>(1, kMessage / (facts.channels * element_size(facts.element)));
}

class SampleOutlet final : public End {
 public:
  SampleOutlet(const Cut& cut, std::unique_ptr<transport::Outlet> outlet) : cut_(cut), outlet_(std::move(outlet)) {}

  bool ended(execute::BlockRun& block, execute::Lane& lane) override {
    const Result done = send_end(block, lane);
    if (!done) block.run->control.fail(block.index, done.error());
    return done.has_value();
  }

 protected:
  Result process(execute::BlockRun& block, bf_process& call) override {
    if (call.count == 0) return {};
    const bf_stream& in = call.inputs[0];
    const std::uint64_t bytes = element_size(cut_.facts.element), most = most_samples(cut_.facts);
    for (std::uint64_t done = 0; done < call.count;) {
      const std::uint64_t count = std::min(most, call.count - done);
      parts_.clear();
      for (std::uint32_t c = 0; c < in.channel_count; ++c)
        parts_.emplace_back(static_cast<const std::byte*>(in.channels[c]) + (in.offset + done) * bytes, count * bytes);
      transport::Header header = head(transport::Kind::samples, call.position + done);
      header.count = count;
      if (auto sent = send(block, execute::lane_of(block), header); !sent) return sent;
      done += count;
    }
    return {};
  }

  Result finish(execute::BlockRun& block) override { return send_end(block, execute::last_lane_of(block)); }

 private:
  transport::Header head(transport::Kind kind, std::uint64_t position) const {
    transport::Header header;
    header.kind = kind;
    header.position = static_cast<std::int64_t>(position);
    header.rate_num = cut_.facts.rate.num;
    header.rate_den = cut_.facts.rate.den;
    header.clock = cut_.facts.clock;
    if (kind != transport::Kind::samples) return header;
    header.channels = cut_.facts.channels;
    header.element = cut_.facts.element;
    return header;
  }

  Result send(execute::BlockRun& block, execute::Lane& lane, const transport::Header& header) {
    const auto sent = outlet_->send(header, parts_, [&] { return execute::goes_on(block, lane); });
    return sent ? Result{} : Result(tl::unexpected(text_of(cut_, sent.error())));
  }

  Result send_end(execute::BlockRun& block, execute::Lane& lane) {
    if (std::exchange(end_sent_, true)) return {};
    parts_.clear();
    return send(block, lane, head(transport::Kind::end, static_cast<std::uint64_t>(block.position)));
  }

  Cut cut_;
  std::unique_ptr<transport::Outlet> outlet_;
  std::vector<std::span<const std::byte>> parts_;
  bool end_sent_ = false;
};

/// Gives the `delay` samples before the first real one, then what comes in.
class SampleInlet final : public End {
 public:
  SampleInlet(const Cut& cut, std::unique_ptr<transport::Inlet> inlet) : cut_(cut), inlet_(std::move(inlet)) {}

 protected:
  Result process(execute::BlockRun& block, bf_process& call) override {
    const std::uint64_t begin = call.position;
    std::uint64_t end = begin + call.count;
    const std::uint64_t needed = cut_.ahead ? end - std::min(end, cut_.delay) : end;
    if (auto there = fill(block, begin, needed); !there) return there;
    if (known_end_ && *known_end_ < end) end = std::max(begin, *known_end_);
    call.done = end - begin;
    give(call.outputs[0], begin, end);
    return {};
  }

  Result finish(execute::BlockRun&) override { return {}; }

 private:
  std::uint64_t bytes() const { return element_size(cut_.facts.element); }

  /// Waits until the stream's first `needed` real samples are here, or its end.
  Result fill(execute::BlockRun& block, std::uint64_t begin, std::uint64_t needed) {
    drop_before(begin - std::min(begin, cut_.delay));
    while (received_ < needed && !known_end_) {
      auto message = inlet_->next([&] { return execute::goes_on(block, execute::lane_of(block)); });
      if (!message) return tl::unexpected(text_of(cut_, message.error()));
      if (std::string wrong = take(*message); !wrong.empty()) return tl::unexpected(text_of(cut_, {{}, wrong}));
    }
    return {};
  }

  /// "" or what is wrong with the message.
  std::string take(const transport::Message& message) {
    const transport::Header& header = message.header;
    if (static_cast<std::uint64_t>(header.position) != received_)
      return "the other side went on at sample " + std::to_string(header.position) + ", expected " + std::to_string(received_);
    if (header.kind == transport::Kind::end) {
      known_end_ = received_;
      return "";
    }
    const std::uint64_t channel = header.count * bytes();
    if (header.kind != transport::Kind::samples || header.channels != cut_.facts.channels ||
        header.element != cut_.facts.element || message.payload.size() != channel * header.channels)
      return "the other side sent something else than the stream's samples";
    channels_.resize(cut_.facts.channels);
    for (std::uint32_t c = 0; c < cut_.facts.channels; ++c) {
      const auto first = message.payload.begin() + static_cast<std::ptrdiff_t>(c * channel);
      channels_[c].insert(channels_[c].end(), first, first + static_cast<std::ptrdiff_t>(channel));
    }
    received_ += header.count;
    return "";
  }

  void drop_before(std::uint64_t sample) {
    if (sample <= first_) return;
    const std::uint64_t gone = std::min(sample, received_) - first_;
    for (auto& channel : channels_) channel.erase(channel.begin(), channel.begin() + static_cast<std::ptrdiff_t>(gone * bytes()));
    first_ += gone;
  }

  /// Samples [begin, end) of the delayed stream.
  void give(const bf_stream& out, std::uint64_t begin, std::uint64_t end) const {
    for (std::uint32_t c = 0; c < out.channel_count; ++c) {
      auto* to = static_cast<std::byte*>(out.channels[c]) + out.offset * bytes();
      std::uint64_t at = begin;
      for (; at < std::min(end, cut_.delay); ++at, to += bytes()) give_initial(c, at, to);
      if (at < end) std::memcpy(to, channels_[c].data() + (at - cut_.delay - first_) * bytes(), (end - at) * bytes());
    }
  }

  void give_initial(std::uint32_t channel, std::uint64_t sample, std::byte* to) const {
    if (cut_.initial.empty())
      std::memset(to, 0, bytes());
    else
      std::memcpy(to, reinterpret_cast<const std::byte*>(cut_.initial.data()) + (channel * cut_.delay + sample) * bytes(),
                  bytes());
  }

  Cut cut_;
  std::unique_ptr<transport::Inlet> inlet_;
  std::vector<std::vector<std::byte>> channels_;  ///< real samples [first_, received_)
  std::uint64_t first_ = 0, received_ = 0;
  std::optional<std::uint64_t> known_end_;
};

}  // namespace

const BlockDescription& sample_outlet() {
  static const BlockDescription type = description(BF_IN, "lab.sample_outlet", "in");
  return type;
}

const BlockDescription& sample_inlet() {
  static const BlockDescription type = description(BF_OUT, "lab.sample_inlet", "out");
  return type;
}

MadeEnd make_sample_outlet(const std::string& name, const Cut& cut, std::unique_ptr<transport::Outlet> outlet) {
  return End::wrap(name, sample_outlet(), std::make_shared<SampleOutlet>(cut, std::move(outlet)));
}

MadeEnd make_sample_inlet(const std::string& name, const Cut& cut, std::unique_ptr<transport::Inlet> inlet) {
  return End::wrap(name, sample_inlet(), std::make_shared<SampleInlet>(cut, std::move(inlet)));
}

}  // namespace bodeflow::lab
