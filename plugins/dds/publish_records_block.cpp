#include "publish_records_block.hpp"

#include <cmath>

namespace bodeflow::dds {
namespace {

constexpr std::int64_t kTicks = 1'000'000'000;  // a second: times of records travel in ns

}  // namespace

void PublishRecordsBlock::describe(Describe& d) {
  d.id("dds.publish_records").summary("Publishes records on a topic of the network (Fast DDS).").role("sink").role("network");
  d.doc(
      "Each record is one message, the struct bodeflow::Message of bodeflow.idl, whose payload is the record's bytes. Nothing is "
      "lost between readers that are there. With `keep_last: true` one that joins later gets the last record, and each record "
      "waits "
      "for the one before to arrive.");
  d.message_in(in).doc("records of any type");
  describe_topic(d);
  describe_writer(d);
  d.parameter("keep_last", false).doc("readers that come late get the last record; the reader must say so, too");
}

void PublishRecordsBlock::configure(const Parameters& p) {
  topic_ = read_topic(p);
  read_writer(p, topic_);
  topic_.keeps_last = p.boolean("keep_last");
}

void PublishRecordsBlock::activate(const Activation&) { writer_ = Transport(*this).writer(topic_); }

void PublishRecordsBlock::receive(int, const RecordView& record, Io& io) {
  const auto bytes = record.bytes();
  const bf_part part{bytes.data(), bytes.size()};
  bf_topic_message message{};
  message.struct_size = sizeof message;
  message.kind = BF_MESSAGE_RECORD;
  message.position = std::llround(io.record_time() * static_cast<double>(kTicks));
  message.rate = {kTicks, 1};
  message.clock = "";
  message.parts = &part;
  message.part_count = 1;
  writer_->write(message);
}

void PublishRecordsBlock::finish(Io&) {
  if (!topic_.keeps_last) writer_->write(end_message(0));  // it would take the place of the last record
  writer_->flush();
}

void PublishRecordsBlock::deactivate() { writer_.reset(); }

}  // namespace bodeflow::dds
