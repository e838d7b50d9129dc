#include <atomic>
#include <cstring>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/DataWriterListener.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>

#include "transport/fast_dds.hpp"
#include "transport/leave.hpp"
#include "transport/wire.hpp"

namespace bodeflow::transport::fast_dds {
namespace {

using eprosima::fastrtps::Duration_t;
using middleware::Flow;
using middleware::Guid;

constexpr double kBlocking = 0.05;       // of a write: the caller asks between whether to go on
constexpr double kHeartbeat = 0.02;      // a lost tail is asked for again after this
constexpr std::int32_t kHistory = 1024;  // samples under way at most; their bytes are bounded by credit
constexpr std::int32_t kNewest = 64;     // readers: the newest of so many writers
constexpr double kPresent = 2.0;
constexpr std::uint32_t kFirstGuess = 256;  // bytes: payloads are allocated as they come

/// One sample to send, one after the other.
struct Outgoing {
  std::span<const std::span<const std::byte>> parts;
  std::uint32_t size = 0;
};

/// Takes and gives bytes that are CDR already.
class Bytes final : public dds::TopicDataType {
 public:
  explicit Bytes(const char* name) {
    setName(name);
    m_typeSize = kFirstGuess;
    auto_fill_type_information(false);
    auto_fill_type_object(false);
  }
  bool serialize(void* data, rtps::SerializedPayload_t* payload) override {
    const auto& out = *static_cast<const Outgoing*>(data);
    if (payload->max_size < out.size) return false;
    auto* at = payload->data;
    for (const auto part : out.parts) {
      if (!part.empty()) std::memcpy(at, part.data(), part.size());
      at += part.size();
    }
    payload->encapsulation = CDR_LE;
    payload->length = out.size;
    return true;
  }
  bool deserialize(rtps::SerializedPayload_t* payload, void* data) override {
    static_cast<middleware::ReaderSink*>(data)->sample(std::as_bytes(std::span(payload->data, payload->length)));
    return true;
  }
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override {
    return [data] { return static_cast<const Outgoing*>(data)->size; };
  }
  void* createData() override { return new Outgoing; }
  void deleteData(void* data) override { delete static_cast<Outgoing*>(data); }
  bool getKey(void* /*data*/, rtps::InstanceHandle_t* /*handle*/, bool /*md5*/) override { return false; }
};

Guid guid_of(const rtps::InstanceHandle_t& handle) {
  Guid guid{};
  for (unsigned i = 0; i < guid.size(); ++i) guid[i] = handle.value[i];
  return guid;
}

Guid guid_of(const rtps::GUID_t& id) {
  Guid guid{};
  std::copy(id.guidPrefix.value, id.guidPrefix.value + 12, guid.begin());
  std::copy(id.entityId.value, id.entityId.value + 4, guid.begin() + 12);
  return guid;
}

/// What reader and writer have alike.
template <typename Qos>
void set_flow(Qos& qos, Flow flow, std::int32_t depth) {
  qos.reliability().kind = flow == Flow::latest ? dds::BEST_EFFORT_RELIABILITY_QOS : dds::RELIABLE_RELIABILITY_QOS;
  qos.reliability().max_blocking_time = Duration_t(kBlocking);
  const bool keeps = flow == Flow::last || flow == Flow::present;
  qos.durability().kind = keeps ? dds::TRANSIENT_LOCAL_DURABILITY_QOS : dds::VOLATILE_DURABILITY_QOS;
  qos.history().kind = flow == Flow::all ? dds::KEEP_ALL_HISTORY_QOS : dds::KEEP_LAST_HISTORY_QOS;
  qos.history().depth = flow == Flow::all ? kHistory : depth;
  qos.resource_limits().max_samples = std::max(kHistory, depth);
  qos.resource_limits().max_instances = 1;
  qos.resource_limits().max_samples_per_instance = std::max(kHistory, depth);
  qos.resource_limits().allocated_samples = 16;
  qos.endpoint().history_memory_policy = rtps::DYNAMIC_RESERVE_MEMORY_MODE;
  qos.data_sharing().off();  // it loses samples that are held while they are read
  if (flow == Flow::present) {
    qos.liveliness().kind = dds::AUTOMATIC_LIVELINESS_QOS;
    qos.liveliness().lease_duration = Duration_t(kPresent);
  }
}

dds::DataWriterQos writer_qos(Flow flow) {
  dds::DataWriterQos qos;
  set_flow(qos, flow, 1);
  qos.publish_mode().kind = dds::SYNCHRONOUS_PUBLISH_MODE;
  auto& times = qos.reliable_writer_qos().times;
  times.initialHeartbeatDelay = Duration_t(0.0);
  times.heartbeatPeriod = Duration_t(kHeartbeat);
  times.nackResponseDelay = Duration_t(0.0);
  times.nackSupressionDuration = Duration_t(0.0);
  if (flow == Flow::present) qos.liveliness().announcement_period = Duration_t(kPresent / 4.0);
  return qos;
}

dds::DataReaderQos reader_qos(Flow flow) {
  dds::DataReaderQos qos;
  set_flow(qos, flow, flow == Flow::latest ? 1 : kNewest);
  auto& times = qos.reliable_reader_qos().times;
  times.initialAcknackDelay = Duration_t(0.0);
  times.heartbeatResponseDelay = Duration_t(0.0);
  return qos;
}

class WriterListener final : public dds::DataWriterListener {
 public:
  explicit WriterListener(std::weak_ptr<middleware::WriterSink> sink) : sink_(std::move(sink)) {}
  void on_publication_matched(dds::DataWriter* /*writer*/, const dds::PublicationMatchedStatus& info) override {
    if (info.current_count_change == 0) return;
    if (const auto sink = sink_.lock()) sink->matched(guid_of(info.last_subscription_handle), info.current_count_change > 0);
  }

 private:
  std::weak_ptr<middleware::WriterSink> sink_;
};

class FastWriter final : public middleware::Writer {
 public:
  FastWriter(std::shared_ptr<Domain> domain, std::shared_ptr<WriterListener> listener, dds::DataWriter* writer)
      : domain_(std::move(domain)), listener_(std::move(listener)), writer_(writer) {}
  FastWriter(const FastWriter&) = delete;
  FastWriter& operator=(const FastWriter&) = delete;
  ~FastWriter() override {
    leave([domain = std::move(domain_), listener = std::move(listener_), writer = writer_]() mutable {
      writer->set_listener(nullptr);
      domain->publisher()->delete_datawriter(writer);
      domain.reset();
    });
  }
  Guid guid() const override { return guid_of(writer_->guid()); }
  bool write(std::span<const std::span<const std::byte>> parts) override {
    Outgoing out{parts, 0};
    for (const auto part : parts) out.size += static_cast<std::uint32_t>(part.size());
    return writer_->write(&out);
  }
  bool acknowledged(double seconds) override {
    return writer_->wait_for_acknowledgments(Duration_t(seconds)) == ReturnCode_t::RETCODE_OK;
  }

 private:
  std::shared_ptr<Domain> domain_;
  std::shared_ptr<WriterListener> listener_;
  dds::DataWriter* writer_;
};

/// Takes samples on whichever thread comes first: the library's, as they arrive, or the reader's, when it has room again.
class ReaderListener final : public dds::DataReaderListener {
 public:
  explicit ReaderListener(std::weak_ptr<middleware::ReaderSink> sink) : sink_(std::move(sink)) {}

  void on_data_available(dds::DataReader* reader) override { take(*reader); }
  void on_subscription_matched(dds::DataReader* /*reader*/, const dds::SubscriptionMatchedStatus& info) override {
    if (info.current_count_change == 0) return;
    if (const auto sink = sink_.lock()) sink->matched(guid_of(info.last_publication_handle), info.current_count_change > 0);
  }
  void on_liveliness_changed(dds::DataReader* /*reader*/, const dds::LivelinessChangedStatus& info) override {
    if (info.alive_count_change == 0) return;
    if (const auto sink = sink_.lock()) sink->matched(guid_of(info.last_publication_handle), info.alive_count_change > 0);
  }

  /// One thread takes at a time, and none waits for another: the library calls with locks that taking needs.
  void take(dds::DataReader& reader) {
    const auto sink = sink_.lock();
    if (!sink) return;
    more_.store(true);
    while (more_.load() && taking_.try_lock()) {
      more_.store(false);
      dds::SampleInfo info;
      while (sink->room() && reader.take_next_sample(sink.get(), &info) == ReturnCode_t::RETCODE_OK) {
        if (info.valid_data) sink->from(guid_of(info.publication_handle));
      }
      taking_.unlock();
    }
  }

 private:
  std::weak_ptr<middleware::ReaderSink> sink_;
  std::atomic<bool> more_{false};
  std::mutex taking_;
};

class FastReader final : public middleware::Reader {
 public:
  FastReader(std::shared_ptr<Domain> domain, std::shared_ptr<ReaderListener> listener, dds::DataReader* reader)
      : domain_(std::move(domain)), listener_(std::move(listener)), reader_(reader) {}
  FastReader(const FastReader&) = delete;
  FastReader& operator=(const FastReader&) = delete;
  ~FastReader() override {
    leave([domain = std::move(domain_), listener = std::move(listener_), reader = reader_]() mutable {
      reader->set_listener(nullptr);
      domain->subscriber()->delete_datareader(reader);
      domain.reset();
    });
  }
  Guid guid() const override { return guid_of(reader_->guid()); }
  void pull() override { listener_->take(*reader_); }

 private:
  std::shared_ptr<Domain> domain_;
  std::shared_ptr<ReaderListener> listener_;
  dds::DataReader* reader_;
};

Failure refused(const std::string& what, const std::string& topic) {
  return {Failure::Kind::library, "Fast DDS made no " + what + " of topic '" + topic + "': " + last_error()};
}

}  // namespace

dds::TypeSupport type_support(middleware::Type type) {
  return dds::TypeSupport(new Bytes(type == middleware::Type::message ? "bodeflow::Message" : "bodeflow::Credit"));
}

WriterResult open_writer(std::shared_ptr<Domain> domain, const middleware::Topic& topic,
                         std::weak_ptr<middleware::WriterSink> sink) {
  auto* made = domain->topic(topic);
  if (made == nullptr) return tl::unexpected(refused("topic", topic.name));
  auto listener = std::make_shared<WriterListener>(std::move(sink));
  auto* writer = domain->publisher()->create_datawriter(made, writer_qos(topic.flow), listener.get(),
                                                        dds::StatusMask::publication_matched());
  if (writer == nullptr) return tl::unexpected(refused("writer", topic.name));
  return std::make_unique<FastWriter>(std::move(domain), std::move(listener), writer);
}

ReaderResult open_reader(std::shared_ptr<Domain> domain, const middleware::Topic& topic,
                         std::weak_ptr<middleware::ReaderSink> sink) {
  auto* made = domain->topic(topic);
  if (made == nullptr) return tl::unexpected(refused("topic", topic.name));
  auto listener = std::make_shared<ReaderListener>(std::move(sink));
  const auto mask = dds::StatusMask::data_available()
                    << dds::StatusMask::subscription_matched() << dds::StatusMask::liveliness_changed();
  auto* reader = domain->subscriber()->create_datareader(made, reader_qos(topic.flow), listener.get(), mask);
  if (reader == nullptr) return tl::unexpected(refused("reader", topic.name));
  return std::make_unique<FastReader>(std::move(domain), std::move(listener), reader);
}

}  // namespace bodeflow::transport::fast_dds
