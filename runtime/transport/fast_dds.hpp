#pragma once

// Fast DDS is included here and in fast_dds*.cpp only: it costs seconds a file.
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/qos/DomainParticipantQos.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/Topic.hpp>
#include <map>
#include <mutex>

#include "transport/middleware.hpp"

namespace bodeflow::transport::fast_dds {

namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;

/// The library's errors go here instead of to standard output; the last one explains a refusal.
void catch_errors();
std::string last_error();

/// A DDS participant with its publisher, subscriber and topics. Deleted by `leave`.
class Domain {
 public:
  Domain(dds::DomainParticipant* participant, std::shared_ptr<void> port_claim);
  Domain(const Domain&) = delete;
  Domain& operator=(const Domain&) = delete;
  ~Domain();

  /// Creates the publisher and the subscriber; false: refused.
  bool open();
  /// The topic, created at its first use and kept; null: refused.
  dds::Topic* topic(const middleware::Topic& wanted);

  dds::Publisher* publisher() const { return publisher_; }
  dds::Subscriber* subscriber() const { return subscriber_; }

 private:
  std::mutex mutex_;
  std::shared_ptr<void> port_claim_;
  dds::DomainParticipant* participant_;
  dds::Publisher* publisher_ = nullptr;
  dds::Subscriber* subscriber_ = nullptr;
  std::map<std::string, dds::Topic*> topics_;
};

using WriterResult = tl::expected<std::unique_ptr<middleware::Writer>, Failure>;
using ReaderResult = tl::expected<std::unique_ptr<middleware::Reader>, Failure>;
WriterResult open_writer(std::shared_ptr<Domain> domain, const middleware::Topic& topic,
                         std::weak_ptr<middleware::WriterSink> sink);
ReaderResult open_reader(std::shared_ptr<Domain> domain, const middleware::Topic& topic,
                         std::weak_ptr<middleware::ReaderSink> sink);

/// The type of that name that copies bytes.
dds::TypeSupport type_support(middleware::Type type);

}  // namespace bodeflow::transport::fast_dds
