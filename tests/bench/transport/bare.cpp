// Fast DDS alone: raw bytes with the transports, QoS and timings of runtime/transport. A sample is taken in the library's thread
// and handed to the one that waits for it, as a program that computes with it does.
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastdds/rtps/transport/shared_mem/SharedMemTransportDescriptor.h>

#include <atomic>
#include <condition_variable>
#include <cstring>
#include <deque>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/DataWriterListener.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <mutex>
#include <thread>
#include <vector>

#include "link.hpp"

namespace fast = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;
using eprosima::fastrtps::Duration_t;

namespace {

class Raw final : public fast::TopicDataType {
 public:
  Raw() {
    setName("bench::Raw");
    m_typeSize = 256;
  }
  bool serialize(void* data, rtps::SerializedPayload_t* payload) override {
    const auto& bytes = *static_cast<const std::span<const std::byte>*>(data);
    const std::uint8_t head[8] = {0, 1, 0, 0, 0, 0, 0, 0};
    std::memcpy(payload->data, head, 8);
    std::memcpy(payload->data + 8, bytes.data(), bytes.size());
    payload->encapsulation = CDR_LE;
    payload->length = static_cast<std::uint32_t>(bytes.size() + 8);
    return true;
  }
  bool deserialize(rtps::SerializedPayload_t* payload, void* data) override {
    const auto* bytes = reinterpret_cast<const std::byte*>(payload->data) + 8;
    static_cast<std::vector<std::byte>*>(data)->assign(bytes, bytes + payload->length - 8);
    return true;
  }
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override {
    return [data] { return static_cast<std::uint32_t>(static_cast<const std::span<const std::byte>*>(data)->size() + 8); };
  }
  void* createData() override { return new std::vector<std::byte>; }
  void deleteData(void* data) override { delete static_cast<std::vector<std::byte>*>(data); }
  bool getKey(void*, rtps::InstanceHandle_t*, bool) override { return false; }
};

fast::DomainParticipant* participant(const Way& way) {
  static fast::DomainParticipant* made = nullptr;
  if (made != nullptr) return made;
  fast::DomainParticipantQos qos;
  qos.transport().use_builtin_transports = false;
  if (way.carrier == "shm") {
    auto memory = std::make_shared<eprosima::fastdds::rtps::SharedMemTransportDescriptor>();
    memory->segment_size(16u << 20);
    memory->max_message_size(1u << 20);
    qos.transport().user_transports.push_back(memory);
  } else {
    auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
    udp->sendBufferSize = udp->receiveBufferSize = 4u << 20;
    udp->maxMessageSize = way.datagram;
    qos.transport().user_transports.push_back(udp);
  }
  made = fast::DomainParticipantFactory::get_instance()->create_participant(way.domain, qos);
  static_cast<void>(fast::TypeSupport(new Raw).register_type(made));
  return made;
}

template <class Qos>
void set(Qos& qos) {
  qos.reliability().kind = fast::RELIABLE_RELIABILITY_QOS;
  qos.reliability().max_blocking_time = Duration_t(0.05);
  qos.durability().kind = fast::VOLATILE_DURABILITY_QOS;
  qos.history().kind = fast::KEEP_ALL_HISTORY_QOS;
  qos.resource_limits().max_samples = 1024;
  qos.resource_limits().max_instances = 1;
  qos.resource_limits().max_samples_per_instance = 1024;
  qos.resource_limits().allocated_samples = 16;
  qos.endpoint().history_memory_policy = rtps::DYNAMIC_RESERVE_MEMORY_MODE;
  qos.data_sharing().off();
}

class BareSender final : public Sender, public fast::DataWriterListener {
 public:
  BareSender(const Way& way, const std::string& name) {
    auto* part = participant(way);
    auto* topic = part->create_topic(name, "bench::Raw", fast::TOPIC_QOS_DEFAULT);
    fast::DataWriterQos qos;
    set(qos);
    qos.publish_mode().kind = fast::SYNCHRONOUS_PUBLISH_MODE;
    auto& times = qos.reliable_writer_qos().times;
    times.initialHeartbeatDelay = times.nackResponseDelay = times.nackSupressionDuration = Duration_t(0.0);
    times.heartbeatPeriod = Duration_t(0.02);
    writer_ = part->create_publisher(fast::PUBLISHER_QOS_DEFAULT)->create_datawriter(topic, qos, this);
  }
  void on_publication_matched(fast::DataWriter*, const fast::PublicationMatchedStatus& info) override {
    readers_ = info.current_count;
  }
  void connect() override {
    while (readers_ == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  void send(std::span<const std::byte> bytes) override {
    while (!writer_->write(&bytes)) {
    }
  }
  void drain() override { writer_->wait_for_acknowledgments(Duration_t(30.0)); }

 private:
  std::atomic<int> readers_{0};
  fast::DataWriter* writer_;
};

class BareReceiver final : public Receiver, public fast::DataReaderListener {
 public:
  BareReceiver(const Way& way, const std::string& name) {
    auto* part = participant(way);
    auto* topic = part->create_topic(name, "bench::Raw", fast::TOPIC_QOS_DEFAULT);
    fast::DataReaderQos qos;
    set(qos);
    qos.reliable_reader_qos().times.initialAcknackDelay = Duration_t(0.0);
    qos.reliable_reader_qos().times.heartbeatResponseDelay = Duration_t(0.0);
    part->create_subscriber(fast::SUBSCRIBER_QOS_DEFAULT)->create_datareader(topic, qos, this);
  }
  void on_data_available(fast::DataReader* reader) override {
    fast::SampleInfo info;
    std::vector<std::byte> sample;
    while (reader->take_next_sample(&sample, &info) == ReturnCode_t::RETCODE_OK) {
      const std::lock_guard lock(mutex_);
      samples_.push_back(std::move(sample));
      came_.notify_one();
      sample = {};
    }
  }
  std::size_t next() override {
    std::unique_lock lock(mutex_);
    came_.wait(lock, [&] { return !samples_.empty(); });
    const auto sample = std::move(samples_.front());
    samples_.pop_front();
    return sample.size();
  }

 private:
  std::mutex mutex_;
  std::condition_variable came_;
  std::deque<std::vector<std::byte>> samples_;
};

}  // namespace

std::unique_ptr<Sender> bare_sender(const Way& way, const std::string& topic) { return std::make_unique<BareSender>(way, topic); }
std::unique_ptr<Receiver> bare_receiver(const Way& way, const std::string& topic) {
  return std::make_unique<BareReceiver>(way, topic);
}
