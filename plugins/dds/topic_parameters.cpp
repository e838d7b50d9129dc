#include "topic_parameters.hpp"

namespace bodeflow::dds {

void describe_topic(Describe& d) {
  d.required<std::string>("topic").doc("its name, the same for all who share it");
  d.parameter("domain", std::int64_t{0}).range(0, 232).doc("of DDS: programs of different domains never meet");
  d.parameter("tolerance", 5.0)
      .unit("s")
      .range(0.01, 86400)
      .doc("the run fails when nothing comes or goes for this long while the block waits; the run's watchdog must be longer");
  d.parameter("queue", std::int64_t{4} << 20).range(1024, std::int64_t{1} << 30).doc("bytes that may wait on each side");
}

void describe_writer(Describe& d) {
  d.parameter("readers", std::int64_t{1})
      .range(0, 1000)
      .doc("how many must be there before anything is sent; 0: whoever is there gets it, what comes before is lost");
}

Topic read_topic(const Parameters& p) {
  Topic topic;
  topic.name = p.text("topic");
  if (topic.name.empty()) fail("topic is empty; it needs a name");
  topic.domain = static_cast<std::uint32_t>(p.integer("domain"));
  topic.tolerance_s = p.number("tolerance");
  topic.queue_bytes = static_cast<std::uint64_t>(p.integer("queue"));
  return topic;
}

void read_writer(const Parameters& p, Topic& topic) { topic.readers = static_cast<std::uint32_t>(p.integer("readers")); }

bf_topic_message end_message(std::int64_t position) {
  bf_topic_message message{};
  message.struct_size = sizeof message;
  message.kind = BF_MESSAGE_END;
  message.position = position;
  message.rate = {0, 1};
  message.clock = "";
  return message;
}

}  // namespace bodeflow::dds
