#include "publish_block.hpp"

namespace bodeflow::dds {

void PublishBlock::describe(Describe& d) {
  d.id("dds.publish")
      .summary("Publishes a stream on a topic of the network (Fast DDS).")
      .role("sink")
      .role("network")
      .cost_ns(50);
  d.doc(
      "Each call's samples are one message, the struct bodeflow::Message of bodeflow.idl: any DDS program can read them. Nothing "
      "is lost between readers that are there; the slowest of them holds the graph back. `latest: true` never waits and gives "
      "readers the newest message. A message that ends the topic follows the last sample.");
  d.stream_in(in).doc("what is published, real or complex");
  describe_topic(d);
  describe_writer(d);
  d.parameter("latest", false).doc("readers get the newest message instead of each, and hold nothing back");
}

void PublishBlock::configure(const Parameters& p) {
  topic_ = read_topic(p);
  read_writer(p, topic_);
  topic_.latest = p.boolean("latest");
}

void PublishBlock::resolve(Facts& f) { facts_ = f.in(in); }

void PublishBlock::activate(const Activation&) {
  parts_.resize(static_cast<std::size_t>(facts_.channels));
  writer_ = Transport(*this).writer(topic_);
}

void PublishBlock::process(Io& io) {
  const bool complex = facts_.element == BF_C64;
  for (std::size_t c = 0; c < parts_.size(); ++c) {
    const auto channel = static_cast<int>(c);
    const void* samples = complex ? static_cast<const void*>(io.read<std::complex<double>>(in, channel).data())
                                  : static_cast<const void*>(io.read<double>(in, channel).data());
    parts_[c] = {static_cast<const std::uint8_t*>(samples), io.count() * (complex ? 16u : 8u)};
  }
  bf_topic_message message{};
  message.struct_size = sizeof message;
  message.kind = BF_MESSAGE_SAMPLES;
  message.element = facts_.element;
  message.channels = static_cast<std::uint32_t>(facts_.channels);
  message.position = static_cast<std::int64_t>(io.position());
  message.count = io.count();
  message.rate = facts_.rate.c();
  message.clock = facts_.clock.c_str();
  message.parts = parts_.data();
  message.part_count = parts_.size();
  writer_->write(message);
}

void PublishBlock::finish(Io& io) {
  writer_->write(end_message(static_cast<std::int64_t>(io.position())));
  writer_->flush();
}

void PublishBlock::deactivate() { writer_.reset(); }

}  // namespace bodeflow::dds
