// dds_subscriber TOPIC [DOMAIN]: prints position, channels and the first samples of each message of a stream, until it ends.
#include <bodeflowPubSubTypes.h>

#include <condition_variable>
#include <cstdlib>
#include <cstring>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <iostream>
#include <mutex>

namespace fast = eprosima::fastdds::dds;

constexpr int kSamples = 1, kEnd = 4;  // kinds of bodeflow.idl

class Printer : public fast::DataReaderListener {
 public:
  void on_data_available(fast::DataReader* reader) override {
    bodeflow::Message message;
    fast::SampleInfo info;
    while (reader->take_next_sample(&message, &info) == ReturnCode_t::RETCODE_OK) {
      if (!info.valid_data) continue;
      if (message.head().kind() == kSamples) print(message);
      if (message.head().kind() == kEnd) end();
    }
  }
  void wait() {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [this] { return ended_; });
  }

 private:
  static void print(const bodeflow::Message& message) {
    const auto& head = message.head();
    const std::size_t doubles = head.element() == 2 ? 2 : 1;  // a complex sample is two
    std::cout << "position " << head.position() << ", " << head.count() << " samples of " << head.channels() << " channels:";
    for (std::size_t c = 0; c < head.channels(); ++c) {
      double first = 0.0;
      std::memcpy(&first, message.payload().data() + c * head.count() * doubles * sizeof first, sizeof first);
      std::cout << ' ' << first;
    }
    std::cout << std::endl;
  }
  void end() {
    const std::lock_guard<std::mutex> lock(mutex_);
    ended_ = true;
    changed_.notify_all();
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  bool ended_ = false;
};

int main(int count, char** arguments) {
  if (count < 2) {
    std::cerr << "usage: dds_subscriber TOPIC [DOMAIN]\n";
    return 2;
  }
  const auto domain = static_cast<unsigned>(count > 2 ? std::atoi(arguments[2]) : 0);
  auto* participant = fast::DomainParticipantFactory::get_instance()->create_participant(domain, fast::PARTICIPANT_QOS_DEFAULT);
  if (participant == nullptr) return 1;
  const fast::TypeSupport type(new bodeflow::MessagePubSubType());
  type.register_type(participant);
  auto* topic = participant->create_topic(arguments[1], type.get_type_name(), fast::TOPIC_QOS_DEFAULT);
  auto* subscriber = participant->create_subscriber(fast::SUBSCRIBER_QOS_DEFAULT);
  fast::DataReaderQos qos;  // reliable and keep all: nothing is lost, and the graph waits for this program
  qos.reliability().kind = fast::RELIABLE_RELIABILITY_QOS;
  qos.history().kind = fast::KEEP_ALL_HISTORY_QOS;
  Printer printer;
  if (subscriber->create_datareader(topic, qos, &printer) == nullptr) return 1;
  printer.wait();
  participant->delete_contained_entities();
  fast::DomainParticipantFactory::get_instance()->delete_participant(participant);
  return 0;
}
