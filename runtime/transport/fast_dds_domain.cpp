#include <arpa/inet.h>
#include <fastdds/rtps/transport/TCPv4TransportDescriptor.h>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastdds/rtps/transport/shared_mem/SharedMemTransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>
#include <sys/socket.h>
#include <sys/statvfs.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdio>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/log/Log.hpp>

#include "transport/fast_dds.hpp"
#include "transport/leave.hpp"

namespace bodeflow::transport::fast_dds {
namespace {

using Carrier = Settings::Carrier;
using eprosima::fastrtps::Duration_t;
using eprosima::fastrtps::rtps::IPLocator;

constexpr std::uint32_t kSocketBuffer = 4u << 20;                   // a burst of 1 MB samples; the kernel may grant less
constexpr std::uint64_t kLargestSegment = std::uint64_t{16} << 20;  // of shared memory, touched whole when it is made
constexpr std::uint64_t kSmallestSegment = std::uint64_t{2} << 20;
constexpr std::uint64_t kSegmentShare = 8;          // of what is free: many processes fit even where a container has 64 MB
constexpr std::uint32_t kSharedMessage = 1u << 20;  // larger samples go in pieces
constexpr std::uint32_t kPeerRange = 8;             // participants that a peer without a port may have on its host
constexpr std::uint16_t kServerPort = 11811;
constexpr std::uint16_t kTcpPort = 5100;
constexpr std::uint16_t kTcpPorts = 8;

struct Address {
  std::string host;
  std::uint16_t port = 0;
};

tl::expected<Address, std::string> parse_address(const std::string& text) {
  const auto colon = text.rfind(':');
  Address address{text.substr(0, colon), 0};
  in_addr parsed{};
  bool good = inet_pton(AF_INET, address.host.c_str(), &parsed) == 1;
  if (colon != std::string::npos) {
    const char* end = text.data() + text.size();
    const auto number = std::from_chars(text.data() + colon + 1, end, address.port);
    good = good && number.ec == std::errc{} && number.ptr == end && address.port != 0;
  }
  if (!good) return tl::unexpected("peer '" + text + "' is not an IPv4 address with or without a port (10.0.0.2:11811)");
  return address;
}

/// Bytes of a new segment; 0: there is no room for one.
std::uint32_t segment_size() {
  struct statvfs space {};
  if (statvfs("/dev/shm", &space) != 0) return 0;
  const std::uint64_t mine = std::uint64_t{space.f_bavail} * space.f_frsize / kSegmentShare;
  return mine < kSmallestSegment ? 0 : static_cast<std::uint32_t>(std::min(mine, kLargestSegment));
}

void add_transport(dds::DomainParticipantQos& qos, const Settings& settings, Carrier carrier) {
  using namespace eprosima::fastdds::rtps;
  auto interfaces = settings.interfaces;
  if (!interfaces.empty()) interfaces.emplace_back("127.0.0.1");
  auto& transports = qos.transport().user_transports;
  qos.transport().use_builtin_transports = false;
  if (carrier == Carrier::shared_memory) {
    auto memory = std::make_shared<SharedMemTransportDescriptor>();
    memory->segment_size(segment_size());
    memory->max_message_size(kSharedMessage);
    transports.push_back(memory);
  } else if (carrier == Carrier::tcp) {
    auto tcp = std::make_shared<TCPv4TransportDescriptor>();
    tcp->sendBufferSize = tcp->receiveBufferSize = kSocketBuffer;
    tcp->interfaceWhiteList = interfaces;
    tcp->enable_tcp_nodelay = true;
    transports.push_back(tcp);
  } else {
    auto udp = std::make_shared<UDPv4TransportDescriptor>();
    udp->sendBufferSize = udp->receiveBufferSize = kSocketBuffer;
    udp->maxMessageSize = settings.security ? std::max(settings.datagram, kSmallestSecureDatagram) : settings.datagram;
    udp->interfaceWhiteList = interfaces;
    udp->maxInitialPeersRange = kPeerRange;
    transports.push_back(udp);
  }
}

std::uint16_t first_tcp_port(std::uint32_t domain) { return static_cast<std::uint16_t>(kTcpPort + kTcpPorts * domain); }

/// A TCP port that nobody on this host listens on, and this process's claim to it: a socket whose name only one process has.
struct TcpPort {
  std::uint16_t port = 0;
  std::shared_ptr<void> claim;
};

bool binds(int socket, const sockaddr* address, std::size_t size) {
  return bind(socket, address, static_cast<socklen_t>(size)) == 0;
}

bool is_free(std::uint16_t port) {
  const int probe = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const int yes = 1;
  setsockopt(probe, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  const bool free = binds(probe, reinterpret_cast<const sockaddr*>(&address), sizeof address);
  close(probe);
  return free;
}

/// One of this host's addresses.
bool is_here(const std::string& host) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  if (inet_pton(AF_INET, host.c_str(), &address.sin_addr) != 1) return false;
  const int probe = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const bool here = binds(probe, reinterpret_cast<const sockaddr*>(&address), sizeof address);
  close(probe);
  return here;
}

/// The first free one of the eight of the domain; none: port 0.
TcpPort claim_tcp_port(std::uint32_t domain) {
  for (std::uint16_t i = 0; i < kTcpPorts; ++i) {
    const auto port = static_cast<std::uint16_t>(first_tcp_port(domain) + i);
    sockaddr_un name{};
    name.sun_family = AF_UNIX;
    const auto length = std::snprintf(name.sun_path + 1, sizeof name.sun_path - 1, "bodeflow-tcp-%u", unsigned{port});
    const int held = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    const auto size = offsetof(sockaddr_un, sun_path) + 1 + static_cast<std::size_t>(length);
    if (binds(held, reinterpret_cast<const sockaddr*>(&name), size) && is_free(port)) {
      return {port, std::shared_ptr<void>(nullptr, [held](void*) { close(held); })};
    }
    close(held);
  }
  return {};
}

rtps::Locator_t locator(const Address& address, Carrier carrier) {
  rtps::Locator_t made;
  made.kind = carrier == Carrier::tcp ? LOCATOR_KIND_TCPv4 : LOCATOR_KIND_UDPv4;
  IPLocator::setIPv4(made, address.host);
  if (carrier == Carrier::tcp) {
    IPLocator::setPhysicalPort(made, address.port);
  } else {
    made.port = address.port;
  }
  return made;
}

void add_server(dds::DomainParticipantQos& qos, Address address, Carrier carrier, std::size_t index) {
  if (address.port == 0) address.port = kServerPort;
  rtps::RemoteServerAttributes server;
  server.ReadguidPrefix("44.53.00.5f.45.50.52.4f.53.49.4d.41");
  server.guidPrefix.value[2] = static_cast<rtps::octet>(index);  // servers of a list are numbered from 0
  auto where = locator(address, carrier);
  if (carrier == Carrier::tcp) IPLocator::setLogicalPort(where, address.port);
  server.metatrafficUnicastLocatorList.push_back(where);
  qos.wire_protocol().builtin.discovery_config.m_DiscoveryServers.push_back(server);
}

tl::expected<void, std::string> add_peers(dds::DomainParticipantQos& qos, const Settings& settings, Carrier carrier,
                                          std::uint16_t tcp_port) {
  auto& builtin = qos.wire_protocol().builtin;
  if (carrier == Carrier::tcp) {
    auto& tcp = static_cast<eprosima::fastdds::rtps::TCPv4TransportDescriptor&>(*qos.transport().user_transports.front());
    tcp.add_listener_port(tcp_port);
  }
  if (carrier == Carrier::shared_memory) return {};
  if (settings.discovery == Settings::Discovery::multicast && carrier == Carrier::udp) return {};
  const bool servers = settings.discovery == Settings::Discovery::server;
  if (servers && settings.peers.empty()) return tl::unexpected<std::string>("no discovery server is named");
  if (servers) {
    builtin.discovery_config.discoveryProtocol = rtps::DiscoveryProtocol_t::CLIENT;
    builtin.discovery_config.discoveryServer_client_syncperiod = Duration_t(0.1);
  } else if (carrier == Carrier::udp) {
    builtin.metatrafficUnicastLocatorList.push_back(rtps::Locator_t());  // any address, the usual port: and so no multicast
  }
  for (std::size_t i = 0; i < settings.peers.size(); ++i) {
    auto address = parse_address(settings.peers[i]);
    if (!address) return tl::unexpected(address.error());
    // Ports where nobody listens keep the library from reaching the others, so one is named or taken: the first process's.
    if (carrier == Carrier::tcp && !servers && address->port == 0) address->port = first_tcp_port(settings.domain);
    if (carrier == Carrier::tcp && address->port == tcp_port && is_here(address->host)) continue;  // not to itself
    if (servers) {
      add_server(qos, *address, carrier, i);
    } else {
      auto peer = locator(*address, carrier);
      // Behind each TCP port there is one participant, so its logical port is that of the domain's first.
      if (carrier == Carrier::tcp) {
        IPLocator::setLogicalPort(peer, static_cast<std::uint16_t>(qos.wire_protocol().port.getUnicastPort(settings.domain, 0)));
      }
      builtin.initialPeersList.push_back(peer);
    }
  }
  return {};
}

tl::expected<void, std::string> add_security(dds::DomainParticipantQos& qos, const Security& security) {
  auto& properties = qos.properties().properties();
  const auto set = [&](const char* name, const std::string& value) { properties.emplace_back(name, value); };
  std::string missing;
  const auto file = [&](const std::string& name, const std::filesystem::path& path) {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(path, ignored) && missing.empty()) missing = path.string();
    set(name.c_str(), "file://" + std::filesystem::absolute(path, ignored).string());
  };
  set("dds.sec.auth.plugin", "builtin.PKI-DH");
  file("dds.sec.auth.builtin.PKI-DH.identity_ca", security.authority);
  file("dds.sec.auth.builtin.PKI-DH.identity_certificate", security.certificate);
  file("dds.sec.auth.builtin.PKI-DH.private_key", security.key);
  if (!security.revocations.empty()) file("dds.sec.auth.builtin.PKI-DH.identity_crl", security.revocations);
  set("dds.sec.access.plugin", "builtin.Access-Permissions");
  file("dds.sec.access.builtin.Access-Permissions.permissions_ca", security.authority);
  file("dds.sec.access.builtin.Access-Permissions.governance", security.governance);
  file("dds.sec.access.builtin.Access-Permissions.permissions", security.permissions);
  set("dds.sec.crypto.plugin", "builtin.AES-GCM-GMAC");
  if (!missing.empty()) return tl::unexpected("no file '" + missing + "' (security of this participant)");
  return {};
}

/// Keeps the last error.
class ErrorKeeper final : public dds::LogConsumer {
 public:
  void Consume(const dds::Log::Entry& entry) override {
    if (entry.kind != dds::Log::Kind::Error) return;
    const std::lock_guard lock(mutex());
    text() = entry.message;
  }
  static std::mutex& mutex() {
    static std::mutex mutex;
    return mutex;
  }
  static std::string& text() {
    static std::string text;
    return text;
  }
};

class FastNode final : public middleware::Node {
 public:
  explicit FastNode(std::shared_ptr<Domain> domain) : domain_(std::move(domain)) {}
  ~FastNode() override {
    leave([domain = std::move(domain_)]() mutable { domain.reset(); });
  }
  WriterResult writer(const middleware::Topic& topic, std::weak_ptr<middleware::WriterSink> sink) override {
    return open_writer(domain_, topic, std::move(sink));
  }
  ReaderResult reader(const middleware::Topic& topic, std::weak_ptr<middleware::ReaderSink> sink) override {
    return open_reader(domain_, topic, std::move(sink));
  }

 private:
  std::shared_ptr<Domain> domain_;
};

}  // namespace

void catch_errors() {
  static std::once_flag once;
  std::call_once(once, [] {
    dds::Log::ClearConsumers();
    dds::Log::SetVerbosity(dds::Log::Kind::Error);
    dds::Log::RegisterConsumer(std::make_unique<ErrorKeeper>());
  });
}

std::string last_error() {
  dds::Log::Flush();
  const std::lock_guard lock(ErrorKeeper::mutex());
  return ErrorKeeper::text().empty() ? "Fast DDS gives no reason" : ErrorKeeper::text();
}

tl::expected<dds::DomainParticipantQos, std::string> participant_qos(const Settings& settings, Carrier carrier,
                                                                     std::uint16_t tcp_port) {
  dds::DomainParticipantQos qos;
  qos.name(settings.name);
  if (carrier == Carrier::udp && (settings.datagram < 512 || settings.datagram > 65500)) {
    return tl::unexpected("datagram of " + std::to_string(settings.datagram) + " bytes (allowed: 512 to 65500)");
  }
  add_transport(qos, settings, carrier);
  auto& discovery = qos.wire_protocol().builtin.discovery_config;
  discovery.leaseDuration = Duration_t(settings.lease_s);
  discovery.leaseDuration_announcementperiod = Duration_t(std::min(1.0, settings.lease_s / 4.0));
  discovery.initial_announcements.count = 10;
  discovery.initial_announcements.period = Duration_t(0.1);
  if (auto done = add_peers(qos, settings, carrier, tcp_port); !done) return tl::unexpected(done.error());
  if (settings.security) {
    if (auto done = add_security(qos, *settings.security); !done) return tl::unexpected(done.error());
  }
  return qos;
}

Domain::Domain(dds::DomainParticipant* participant, std::shared_ptr<void> port_claim)
    : port_claim_(std::move(port_claim)), participant_(participant) {}

Domain::~Domain() {
  participant_->delete_contained_entities();
  dds::DomainParticipantFactory::get_instance()->delete_participant(participant_);
}

bool Domain::open() {
  publisher_ = participant_->create_publisher(dds::PUBLISHER_QOS_DEFAULT);
  subscriber_ = participant_->create_subscriber(dds::SUBSCRIBER_QOS_DEFAULT);
  for (const auto type : {middleware::Type::message, middleware::Type::credit}) {
    if (type_support(type).register_type(participant_) != ReturnCode_t::RETCODE_OK) return false;
  }
  return publisher_ != nullptr && subscriber_ != nullptr;
}

dds::Topic* Domain::topic(const middleware::Topic& wanted) {
  const std::lock_guard lock(mutex_);
  auto& topic = topics_[wanted.name];
  if (topic == nullptr) {
    topic = participant_->create_topic(wanted.name, type_support(wanted.type).get_type_name(), dds::TOPIC_QOS_DEFAULT);
  }
  return topic;
}

}  // namespace bodeflow::transport::fast_dds

namespace bodeflow::transport::middleware {

tl::expected<std::shared_ptr<Node>, std::string> join(const Settings& settings, Settings::Carrier carrier) {
  fast_dds::catch_errors();
  if (carrier == Settings::Carrier::shared_memory && fast_dds::segment_size() == 0)
    return tl::unexpected<std::string>("shared memory (/dev/shm) has no room for a segment of 2 MB");
  fast_dds::TcpPort port;
  if (carrier == Settings::Carrier::tcp) {
    port = fast_dds::claim_tcp_port(settings.domain);
    if (port.port == 0)
      return tl::unexpected<std::string>("this host has no free TCP port for domain " + std::to_string(settings.domain));
  }
  auto qos = fast_dds::participant_qos(settings, carrier, port.port);
  if (!qos) return tl::unexpected(qos.error());
  auto* participant = fast_dds::dds::DomainParticipantFactory::get_instance()->create_participant(settings.domain, *qos);
  if (participant == nullptr) return tl::unexpected("Fast DDS made no participant: " + fast_dds::last_error());
  auto domain = std::make_shared<fast_dds::Domain>(participant, port.claim);
  const bool open = domain->open();
  auto node = std::make_shared<fast_dds::FastNode>(std::move(domain));
  if (!open) return tl::unexpected("Fast DDS made no publisher or subscriber: " + fast_dds::last_error());
  return node;
}

}  // namespace bodeflow::transport::middleware
