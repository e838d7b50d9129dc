#include "subscribe_block.hpp"

#include <algorithm>
#include <cstring>

namespace bodeflow::dds {

void SubscribeBlock::describe(Describe& d) {
  d.id("dds.subscribe")
      .summary("Takes a stream from a topic of the network (Fast DDS).")
      .role("source")
      .role("network")
      .cost_ns(50);
  d.doc(
      "What the topic carries must be known before it comes, so rate and channels are stated here, and a message that says "
      "otherwise ends the run. The stream begins with the first message that comes and ends with the one that ends the topic. "
      "Its "
      "writer paces the run. Missing samples end the run, but for `latest: true`: then they are counted, and the samples behind "
      "them follow directly.");
  d.stream_out(out).doc("the samples, in the order of their positions");
  describe_topic(d);
  d.required<double>("rate").unit("Hz").above(0.0).doc("samples per second of each channel");
  d.parameter("channels", std::int64_t{1}).range(1, 65536).doc("of the topic's stream");
  d.parameter("complex", false).doc("the samples are complex");
  d.parameter("unit", "").doc("of the samples: topics do not carry it");
  d.parameter("clock", "").doc("clock domain of the stream; \"\" is the engine's own");
  d.parameter("latest", false).doc("takes the newest message instead of each");
}

void SubscribeBlock::configure(const Parameters& p) {
  topic_ = read_topic(p);
  topic_.latest = p.boolean("latest");
  facts_.known = true;
  facts_.rate = Rate::from_hz(p.number("rate"));
  facts_.channels = static_cast<int>(p.integer("channels"));
  facts_.element = p.boolean("complex") ? BF_C64 : BF_F64;
  facts_.unit = p.text("unit");
  facts_.clock = p.text("clock");
}

void SubscribeBlock::resolve(Facts& f) { f.out(out) = facts_; }

void SubscribeBlock::activate(const Activation&) {
  reader_ = Transport(*this).reader(topic_);
  reset();
}

void SubscribeBlock::reset() {
  message_ = {};
  used_ = 0;
  expected_.reset();
  skipped_ = 0;
  ended_ = false;
}

void SubscribeBlock::process(Io& io) {
  for (std::size_t done = 0; done < io.count();) {
    if (used_ == message_.count && !ended_) take();
    if (ended_) return io.end_after(done);
    const auto samples = std::min<std::size_t>(io.count() - done, message_.count - used_);
    copy(io, done, samples);
    done += samples;
    used_ += samples;
  }
}

void SubscribeBlock::take() {
  message_ = reader_->read();
  used_ = 0;
  ended_ = message_.kind == BF_MESSAGE_END;
  if (ended_) message_.count = 0;
  if (!ended_) check_shape();
  check_place();
}

void SubscribeBlock::check_shape() const {
  if (message_.kind != BF_MESSAGE_SAMPLES) fail("topic '" + topic_.name + "' carries no samples; records: dds.subscribe_records");
  const auto refuse = [&](const std::string& found, const std::string& stated) {
    fail("topic '" + topic_.name + "' carries " + found + "; stated here: " + stated);
  };
  if (message_.element != facts_.element) {
    refuse(message_.element == BF_C64 ? "complex samples" : "real samples",
           facts_.element == BF_C64 ? "complex: true" : "complex: false");
  }
  if (message_.channels != static_cast<std::uint32_t>(facts_.channels)) {
    refuse(std::to_string(message_.channels) + " channels", std::to_string(facts_.channels));
  }
  const Rate rate(message_.rate);
  if (rate != facts_.rate) refuse(std::to_string(rate.hz()) + " samples/s", std::to_string(facts_.rate.hz()) + " Hz");
}

void SubscribeBlock::check_place() {
  if (!expected_ && message_.position != 0)
    log_info("topic '" + topic_.name + "': joined a stream that runs, at its sample " + std::to_string(message_.position));
  if (expected_ && message_.position != *expected_) {
    const auto missing = message_.position - *expected_;
    const bool may = topic_.latest && missing > 0;
    if (!may) {
      fail("topic '" + topic_.name + "': the samples go on at " + std::to_string(message_.position) + " instead of " +
           std::to_string(*expected_));
    }
    skipped_ += missing;
  }
  expected_ = message_.position + static_cast<std::int64_t>(message_.count);
}

void SubscribeBlock::copy(Io& io, std::size_t done, std::size_t samples) {
  const std::size_t size = facts_.element == BF_C64 ? 16 : 8;
  for (int c = 0; c < facts_.channels; ++c) {
    const auto* from = message_.parts[0].bytes + (static_cast<std::size_t>(c) * message_.count + used_) * size;
    if (facts_.element == BF_C64) {
      std::memcpy(io.write<std::complex<double>>(out, c).data() + done, from, samples * size);
    } else {
      std::memcpy(io.write<double>(out, c).data() + done, from, samples * size);
    }
  }
}

void SubscribeBlock::finish(Io&) {
  if (skipped_ > 0) log_warning("topic '" + topic_.name + "': " + std::to_string(skipped_) + " samples were skipped");
}

void SubscribeBlock::deactivate() { reader_.reset(); }

}  // namespace bodeflow::dds
