// A stream between hosts: its samples leave here and come in there.
#include <bodeflow/record_layout.hpp>
#include <cstring>
#include <deque>
#include <limits>

#include "execute/run.hpp"
#include "lab/end_base.hpp"
#include "lab/link_slot.hpp"

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

class SampleOutlet final : public End, public StreamEnd {
 public:
  SampleOutlet(const Cut& cut, std::unique_ptr<transport::Outlet> outlet) : cut_(cut), link_(std::move(outlet)) {}

  bool ended(execute::BlockRun& block, execute::Lane& lane) override {
    const Result done = send_end(block, lane);
    if (!done) block.run->control.fail(block.index, done.error());
    return done.has_value();
  }

  void begin_at(std::uint64_t sample) override { offset_ = next_ = sample; }

  tl::expected<std::uint64_t, std::string> leave() override {
    return link_.take_out([&](transport::Outlet*) { return next_; });
  }

  void pause(bool yes) override { link_.pause(yes); }

  tl::expected<void, transport::Failure> rejoin(NewLink link, std::uint64_t, const transport::GoOn& go_on) override {
    return link_.put_in(std::move(link.outlet), [&](transport::Outlet& outlet) -> tl::expected<void, transport::Failure> {
      if (!ended_) return {};
      return outlet.send(head(transport::Kind::end, next_), {}, go_on);
    });
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
      transport::Header header = head(transport::Kind::samples, offset_ + call.position + done);
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
    const auto sent = link_.use([&] { return execute::goes_on(block, lane); },
                                [&](transport::Outlet& outlet, const transport::GoOn& go_on) {
                                  auto done = outlet.send(header, parts_, go_on);
                                  if (done) next_ = static_cast<std::uint64_t>(header.position) + header.count;
                                  if (done && header.kind == transport::Kind::end) ended_ = true;
                                  return done;
                                });
    return sent ? Result{} : Result(tl::unexpected(text_of(cut_, sent.error())));
  }

  Result send_end(execute::BlockRun& block, execute::Lane& lane) {
    if (std::exchange(end_sent_, true)) return {};
    parts_.clear();
    // A part that goes on for a lost one may begin behind the end of a short stream.
    std::uint64_t position = offset_ + static_cast<std::uint64_t>(block.position);
    if (cut_.facts.length >= 0) position = std::min(position, static_cast<std::uint64_t>(cut_.facts.length));
    transport::Header header = head(transport::Kind::end, position);
    header.count = 0;
    return send(block, lane, header);
  }

  Cut cut_;
  LinkSlot<transport::Outlet> link_;
  std::vector<std::span<const std::byte>> parts_;
  std::uint64_t offset_ = 0;  ///< sample of the stream that is the block's first
  bool end_sent_ = false;
  // Under the lock of link_.
  std::uint64_t next_ = 0;  ///< sample of the stream
  bool ended_ = false;
};

/// Gives the `delay` samples before the first real one, then what comes in.
class SampleInlet final : public End, public StreamEnd {
 public:
  SampleInlet(const Cut& cut, std::unique_ptr<transport::Inlet> inlet)
      : cut_(cut), link_(std::move(inlet)), channels_(cut.facts.channels), last_(cut.facts.channels) {
    for (auto& sample : last_) sample.resize(bytes());
  }

  void begin_at(std::uint64_t sample) override {
    offset_ = sample;
    expected_.reset();
  }
  void on_gap(std::function<void(const Gap&)> tell) override { tell_gap_ = std::move(tell); }

  tl::expected<std::uint64_t, std::string> leave() override {
    return link_.take_out([&](transport::Inlet* inlet) -> tl::expected<std::uint64_t, std::string> {
      if (inlet != nullptr)
        for (auto message = inlet->poll(0.0); message && *message; message = inlet->poll(0.0))
          here_.push_back({std::move(**message), {}});
      std::uint64_t next = offset_ + received_;
      bool ended = known_end_.has_value();
      for (const auto& [message, rejoined] : here_) {
        next = std::max(next, rejoined ? offset_ + rejoined->sample
                                       : static_cast<std::uint64_t>(message.header.position) + message.header.count);
        ended = ended || (!rejoined && message.header.kind == transport::Kind::end);
      }
      if (ended) return tl::unexpected("the stream " + cut_.name + " had ended");
      return next;
    });
  }

  void pause(bool yes) override { link_.pause(yes); }

  tl::expected<void, transport::Failure> rejoin(NewLink link, std::uint64_t sample, const transport::GoOn&) override {
    if (cut_.facts.length >= 0) sample = std::min(sample, static_cast<std::uint64_t>(cut_.facts.length));
    link_.put_in(std::move(link.inlet), [&](transport::Inlet&) {
      here_.push_back({{}, Rejoined{std::max(sample, offset_) - offset_, link.epoch}});
    });
    return {};
  }

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
  struct Rejoined {
    std::uint64_t sample = 0;  ///< of this part, at which the stream goes on
    std::uint32_t epoch = 0;
  };
  struct Arrived {
    transport::Message message;
    std::optional<Rejoined> rejoined;  ///< instead of a message
  };

  std::uint64_t bytes() const { return element_size(cut_.facts.element); }

  /// Waits until the stream's first `needed` real samples are here, or its end.
  Result fill(execute::BlockRun& block, std::uint64_t begin, std::uint64_t needed) {
    drop_before(begin - std::min(begin, cut_.delay));
    while (received_ < needed && !known_end_) {
      const auto taken =
          link_.use([&] { return execute::goes_on(block, execute::lane_of(block)); },
                    [&](transport::Inlet& inlet, const transport::GoOn& go_on) { return take_next(inlet, go_on); });
      if (!taken) return tl::unexpected(text_of(cut_, taken.error()));
    }
    return {};
  }

  tl::expected<void, transport::Failure> take_next(transport::Inlet& inlet, const transport::GoOn& go_on) {
    std::string wrong;
    if (!here_.empty()) {
      const Arrived first = std::move(here_.front());
      here_.pop_front();
      if (first.rejoined)
        fill_gap(*first.rejoined);
      else
        wrong = take(first.message);
    } else {
      auto message = inlet.next(go_on);
      if (!message) return tl::unexpected(message.error());
      wrong = take(*message);
    }
    if (!wrong.empty()) return tl::unexpected(transport::Failure{transport::Failure::Kind::refused, wrong});
    return {};
  }

  /// "" or what is wrong with the message.
  std::string take(const transport::Message& message) {
    const transport::Header& header = message.header;
    const std::int64_t at = header.position - static_cast<std::int64_t>(offset_);
    // The first message for a part that goes on for a lost one may lie before its beginning.
    if (expected_ ? at != *expected_ : at > 0)
      return "the other side went on at sample " + std::to_string(header.position) + ", expected " +
             std::to_string(offset_ + received_);
    if (header.kind == transport::Kind::end) {
      known_end_ = received_;
      return "";
    }
    const std::uint64_t channel = header.count * bytes();
    if (header.kind != transport::Kind::samples || header.channels != cut_.facts.channels ||
        header.element != cut_.facts.element || message.payload.size() != channel * header.channels)
      return "the other side sent something else than the stream's samples";
    expected_ = at + static_cast<std::int64_t>(header.count);
    if (*expected_ <= static_cast<std::int64_t>(received_)) return "";
    const std::uint64_t skipped = (received_ - static_cast<std::uint64_t>(at)) * bytes();
    for (std::uint32_t c = 0; c < cut_.facts.channels; ++c) {
      const auto first = message.payload.begin() + static_cast<std::ptrdiff_t>(c * channel);
      const auto last = first + static_cast<std::ptrdiff_t>(channel);
      channels_[c].insert(channels_[c].end(), first + static_cast<std::ptrdiff_t>(skipped), last);
      last_[c].assign(last - static_cast<std::ptrdiff_t>(bytes()), last);
    }
    received_ = static_cast<std::uint64_t>(*expected_);
    return "";
  }

  /// What stands where the lost host's samples are missing.
  void fill_gap(const Rejoined& rejoined) {
    const std::uint64_t count = rejoined.sample - received_;
    for (std::uint32_t c = 0; c < cut_.facts.channels; ++c) {
      std::vector<std::byte> sample = last_[c];
      const double none = std::numeric_limits<double>::quiet_NaN();
      if (cut_.gaps == graph::Gaps::nan)
        for (std::size_t i = 0; i < sample.size(); i += sizeof none) std::memcpy(sample.data() + i, &none, sizeof none);
      for (std::uint64_t i = 0; i < count; ++i) channels_[c].insert(channels_[c].end(), sample.begin(), sample.end());
    }
    const Gap gap{offset_ + received_, count, rejoined.epoch, cut_.facts.rate};
    received_ = rejoined.sample;
    expected_ = static_cast<std::int64_t>(received_);
    if (count > 0 && tell_gap_) tell_gap_(gap);
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
  LinkSlot<transport::Inlet> link_;
  std::function<void(const Gap&)> tell_gap_;
  std::vector<std::vector<std::byte>> channels_;  ///< real samples [first_, received_) of this part
  std::vector<std::vector<std::byte>> last_;      ///< the last sample that came
  std::uint64_t offset_ = 0;                      ///< sample of the stream that is this part's first
  std::uint64_t first_ = 0;
  // Written under the lock of link_.
  std::uint64_t received_ = 0;
  std::optional<std::int64_t> expected_ = 0;  ///< sample of this part that comes next; none: whatever comes
  std::optional<std::uint64_t> known_end_;
  std::deque<Arrived> here_;  ///< before what comes on the link: what came on lost ones, and where their followers go on
};

template <class StreamsEnd>
MadeEnd wrapped(const std::string& name, const BlockDescription& type, const std::shared_ptr<StreamsEnd>& end) {
  MadeEnd made = End::wrap(name, type, end);
  made.stream = end;
  return made;
}

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
  return wrapped(name, sample_outlet(), std::make_shared<SampleOutlet>(cut, std::move(outlet)));
}

MadeEnd make_sample_inlet(const std::string& name, const Cut& cut, std::unique_ptr<transport::Inlet> inlet) {
  return wrapped(name, sample_inlet(), std::make_shared<SampleInlet>(cut, std::move(inlet)));
}

}  // namespace bodeflow::lab
