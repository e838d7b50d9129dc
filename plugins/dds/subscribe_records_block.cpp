#include "subscribe_records_block.hpp"

namespace bodeflow::dds {

void SubscribeRecordsBlock::describe(Describe& d) {
  d.id("dds.subscribe_records").summary("Takes records from a topic of the network (Fast DDS).").role("source").role("network");
  d.doc(
      "With a stream on `pace` a record is sent at the sample at which it is found, so that a second run gives other positions. "
      "At "
      "the end of the graph the block waits until the topic ends, or `count` records are there, and sends the rest. A payload "
      "that "
      "is no record ends the run.");
  d.stream_in(pace).optional().doc("any stream: looks for records whenever samples of it come");
  d.message_out(out).doc("the records, in the order of the topic");
  describe_topic(d);
  d.parameter("count", std::int64_t{0}).range(0, 1'000'000'000).doc("records to wait for; 0: until the topic ends");
  d.parameter("keep_last", false).doc("the topic keeps its last record for readers that come late: then state a count");
}

void SubscribeRecordsBlock::configure(const Parameters& p) {
  topic_ = read_topic(p);
  topic_.keeps_last = p.boolean("keep_last");
  limit_ = p.integer("count");
  if (topic_.keeps_last && limit_ == 0) fail("keep_last needs count: a topic that keeps its last record has no end");
}

void SubscribeRecordsBlock::activate(const Activation&) {
  reader_ = Transport(*this).reader(topic_);
  reset();
}

void SubscribeRecordsBlock::reset() {
  count_ = 0;
  ended_ = false;
}

void SubscribeRecordsBlock::process(Io& io) {
  while (!ended_) {
    const auto message = reader_->read(0.0);
    if (message.kind == BF_MESSAGE_NONE) return;
    hand_over(message, io);
  }
}

void SubscribeRecordsBlock::finish(Io& io) {
  while (!ended_) hand_over(reader_->read(), io);
}

void SubscribeRecordsBlock::hand_over(const bf_topic_message& message, Io& io) {
  if (message.kind == BF_MESSAGE_END) {
    ended_ = true;
    return;
  }
  if (message.kind != BF_MESSAGE_RECORD) fail("topic '" + topic_.name + "' carries no records; samples: dds.subscribe");
  const auto record = RecordView::check({message.parts[0].bytes, message.parts[0].size});
  if (!record) fail("topic '" + topic_.name + "': what came is no record: " + record.error().text);
  io.emit(out, *record);
  ended_ = ++count_ == limit_;
}

void SubscribeRecordsBlock::deactivate() { reader_.reset(); }

}  // namespace bodeflow::dds
