// generated_reader DOMAIN TOPIC COUNT: prints the header of each message and the sum of its samples.
#include <bodeflowPubSubTypes.h>

#include <chrono>
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

class Printer : public fast::DataReaderListener {
 public:
  void on_data_available(fast::DataReader* reader) override {
    bodeflow::Message message;
    fast::SampleInfo info;
    while (reader->take_next_sample(&message, &info) == ReturnCode_t::RETCODE_OK) {
      if (!info.valid_data) continue;
      const auto& head = message.head();
      double sum = 0.0, value = 0.0;
      for (std::size_t n = 0; n + 8 <= message.payload().size(); n += 8) {
        std::memcpy(&value, message.payload().data() + n, 8);
        sum += value;
      }
      std::cout << "sequence=" << head.sequence_number() << "\nstream=" << head.stream() << "\nposition=" << head.position()
                << "\ncount=" << head.count() << "\nrate=" << head.rate_num() << "/" << head.rate_den()
                << "\nclock=" << head.clock() << "\nsum=" << sum << std::endl;
      const std::lock_guard<std::mutex> lock(mutex_);
      ++got_;
      changed_.notify_all();
    }
  }
  bool wait(int count) {
    std::unique_lock<std::mutex> lock(mutex_);
    return changed_.wait_for(lock, std::chrono::seconds(20), [&] { return got_ >= count; });
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  int got_ = 0;
};

int main(int count, char** arguments) {
  if (count != 4) return 2;
  auto* participant = fast::DomainParticipantFactory::get_instance()->create_participant(
      static_cast<unsigned>(std::atoi(arguments[1])), fast::PARTICIPANT_QOS_DEFAULT);
  if (participant == nullptr) return 1;
  const fast::TypeSupport type(new bodeflow::MessagePubSubType());
  type.register_type(participant);
  auto* topic = participant->create_topic(arguments[2], type.get_type_name(), fast::TOPIC_QOS_DEFAULT);
  auto* subscriber = participant->create_subscriber(fast::SUBSCRIBER_QOS_DEFAULT);
  fast::DataReaderQos qos;
  qos.reliability().kind = fast::RELIABLE_RELIABILITY_QOS;
  qos.history().kind = fast::KEEP_ALL_HISTORY_QOS;
  Printer printer;
  auto* reader = subscriber->create_datareader(topic, qos, &printer);
  const bool all = reader != nullptr && printer.wait(std::atoi(arguments[3]));
  participant->delete_contained_entities();
  fast::DomainParticipantFactory::get_instance()->delete_participant(participant);
  return all ? 0 : 1;
}
