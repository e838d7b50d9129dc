// A program that joins a DDS domain with given security files and writes or reads one topic, so that tests can see who gets in.
// It does not check the files before, and can be told to lie to its own copy of Fast DDS (--clock, --permit), as an intruder's
// program would.
//
//   member writer|reader TOPIC DOMAIN [KEY=FILE]...
//     KEY: authority certificate key governance permissions revocations permissions_authority; without any a plain participant
//     --clock=SECONDS   the program's clock is wrong by so much
//     --permit          the program believes that it may do everything
//     --mark=LETTER     a writer's samples consist of it
//     --samples=N       a writer writes no more
//     --enough=LETTERS  a reader ends when it has 20 samples of each
//     --tell=FILE       a reader writes the identifiers of its first writer and of itself into the file
//
// It ends with its standard input, or after 30 s, and prints "no security" (of the library), "refused" (by its own library),
// "nobody" (was matched), or what it wrote or read: letter and count of each mark, as in "a3 b20".

#include <dlfcn.h>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>
#include <fnmatch.h>
#include <poll.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/log/Log.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace {

long clock_error_s = 0;
bool permits_itself = false;

}  // namespace

// These stand before the C library's for all shared libraries of the process: Fast DDS and OpenSSL.
extern "C" time_t time(time_t* to) noexcept {
  timespec now{};
  ::clock_gettime(CLOCK_REALTIME, &now);
  const time_t told = now.tv_sec + clock_error_s;
  if (to != nullptr) *to = told;
  return told;
}

extern "C" int fnmatch(const char* pattern, const char* text, int flags) {
  if (permits_itself) return 0;
  using Function = int (*)(const char*, const char*, int);
  static const auto real = reinterpret_cast<Function>(::dlsym(RTLD_NEXT, "fnmatch"));
  return real(pattern, text, flags);
}

namespace {

namespace fdds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;
using Bytes = std::vector<unsigned char>;

constexpr std::size_t kSampleBytes = 100;

/// A sample of bytes as they are, behind the four bytes that tell the encoding.
class BytesType : public fdds::TopicDataType {
 public:
  BytesType() {
    setName("Bytes");
    m_typeSize = 1024;
    m_isGetKeyDefined = false;
  }
  bool serialize(void* data, rtps::SerializedPayload_t* payload) override {
    const Bytes& bytes = *static_cast<Bytes*>(data);
    const unsigned char head[4] = {0, 1, 0, 0};
    payload->length = static_cast<std::uint32_t>(sizeof head + bytes.size());
    payload->encapsulation = CDR_LE;
    std::memcpy(payload->data, head, sizeof head);
    std::memcpy(payload->data + sizeof head, bytes.data(), bytes.size());
    return true;
  }
  bool deserialize(rtps::SerializedPayload_t* payload, void* data) override {
    if (payload->length < 4) return false;
    static_cast<Bytes*>(data)->assign(payload->data + 4, payload->data + payload->length);
    return true;
  }
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override {
    return [data] { return static_cast<std::uint32_t>(static_cast<Bytes*>(data)->size() + 4); };
  }
  void* createData() override { return new Bytes; }
  void deleteData(void* data) override { delete static_cast<Bytes*>(data); }
  bool getKey(void*, rtps::InstanceHandle_t*, bool) override { return false; }
};

struct Request {
  bool writes;
  std::string topic;
  unsigned domain;
  char mark = 'a';
  int samples = 1 << 30;
  std::string enough{}, tell{};
  std::map<std::string, std::string> files{};
};

Request parse(int argc, char** argv) {
  Request request{std::string(argv[1]) == "writer", argv[2], static_cast<unsigned>(std::atoi(argv[3]))};
  for (int k = 4; k < argc; ++k) {
    const std::string word = argv[k], key = word.substr(0, word.find('=')), value = word.substr(word.find('=') + 1);
    if (key == "--clock")
      clock_error_s = std::stol(value);
    else if (key == "--permit")
      permits_itself = true;
    else if (key == "--mark")
      request.mark = value[0];
    else if (key == "--samples")
      request.samples = std::stoi(value);
    else if (key == "--enough")
      request.enough = value;
    else if (key == "--tell")
      request.tell = value;
    else
      request.files[key] = "file://" + value;
  }
  return request;
}

/// True until the input ends; waits 10 ms.
bool goes_on() {
  static const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  pollfd input{STDIN_FILENO, POLLIN, 0};
  return ::poll(&input, 1, 10) == 0 && std::chrono::steady_clock::now() < end;
}

/// Loopback only, found by unicast, so that nothing else on the machine or its network takes part.
fdds::DomainParticipantQos participant_qos(Request& request) {
  fdds::DomainParticipantQos qos;
  const auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  udp->interfaceWhiteList.emplace_back("127.0.0.1");
  udp->maxInitialPeersRange = 16;  // participants of a test
  qos.transport().use_builtin_transports = false;
  qos.transport().user_transports.push_back(udp);
  rtps::Locator_t peer;
  rtps::IPLocator::setIPv4(peer, "127.0.0.1");
  qos.wire_protocol().builtin.initialPeersList.push_back(peer);
  if (request.files.empty()) return qos;

  auto& files = request.files;
  auto& properties = qos.properties().properties();
  const std::string identity = "dds.sec.auth.builtin.PKI-DH.", access = "dds.sec.access.builtin.Access-Permissions.";
  properties.emplace_back("dds.sec.auth.plugin", "builtin.PKI-DH");
  properties.emplace_back(identity + "identity_ca", files["authority"]);
  properties.emplace_back(identity + "identity_certificate", files["certificate"]);
  properties.emplace_back(identity + "private_key", files["key"]);
  if (files.count("revocations") != 0) properties.emplace_back(identity + "identity_crl", files["revocations"]);
  properties.emplace_back("dds.sec.access.plugin", "builtin.Access-Permissions");
  properties.emplace_back(access + "permissions_ca",
                          files.count("permissions_authority") != 0 ? files["permissions_authority"] : files["authority"]);
  properties.emplace_back(access + "governance", files["governance"]);
  properties.emplace_back(access + "permissions", files["permissions"]);
  properties.emplace_back("dds.sec.crypto.plugin", "builtin.AES-GCM-GMAC");
  return qos;
}

/// Leaves at once: the library's destructors may wait for each other.
[[noreturn]] void leave(const std::string& word) {
  std::printf("%s\n", word.c_str());
  std::fflush(stdout);
  ::_exit(0);
}

std::string hexadecimal(const rtps::GUID_t& guid) {
  std::string text;
  char byte[3];
  for (const auto* part = guid.guidPrefix.value; part != guid.guidPrefix.value + 12; ++part) {
    std::snprintf(byte, sizeof byte, "%02x", *part);
    text += byte;
  }
  for (const auto part : guid.entityId.value) {
    std::snprintf(byte, sizeof byte, "%02x", part);
    text += byte;
  }
  return text;
}

/// A whole file at once, for who waits for it.
void tell(const std::string& file, const rtps::GUID_t& writer, const rtps::GUID_t& reader) {
  std::ofstream(file + ".part") << hexadecimal(writer) << ' ' << hexadecimal(reader) << '\n';
  std::rename((file + ".part").c_str(), file.c_str());
}

std::string write(fdds::DomainParticipant& participant, fdds::Topic& topic, const Request& request) {
  auto* publisher = participant.create_publisher(fdds::PUBLISHER_QOS_DEFAULT);
  fdds::DataWriterQos qos;
  qos.reliability().kind = fdds::RELIABLE_RELIABILITY_QOS;
  qos.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
  auto* writer = publisher->create_datawriter(&topic, qos);
  if (writer == nullptr) return "refused";
  Bytes sample(kSampleBytes, static_cast<unsigned char>(request.mark));
  int written = 0;
  while (goes_on()) {
    fdds::PublicationMatchedStatus status;
    writer->get_publication_matched_status(status);
    if (status.current_count > 0 && written < request.samples && writer->write(&sample)) ++written;
  }
  return written == 0 ? "nobody" : request.mark + std::to_string(written);
}

std::string read(fdds::DomainParticipant& participant, fdds::Topic& topic, const Request& request) {
  auto* subscriber = participant.create_subscriber(fdds::SUBSCRIBER_QOS_DEFAULT);
  fdds::DataReaderQos qos;
  qos.reliability().kind = fdds::RELIABLE_RELIABILITY_QOS;
  qos.history().depth = 100;
  qos.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
  auto* reader = subscriber->create_datareader(&topic, qos);
  if (reader == nullptr) return "refused";
  Bytes sample;
  fdds::SampleInfo info;
  std::map<char, int> taken;
  const auto enough = [&] {
    return !request.enough.empty() && std::all_of(request.enough.begin(), request.enough.end(),
                                                  [&](char mark) { return taken.count(mark) != 0 && taken[mark] >= 20; });
  };
  bool matched = false;
  while (goes_on() && !enough()) {
    fdds::SubscriptionMatchedStatus status;
    reader->get_subscription_matched_status(status);
    if (!matched && status.total_count > 0) {
      matched = true;
      if (!request.tell.empty()) tell(request.tell, rtps::iHandle2GUID(status.last_publication_handle), reader->guid());
    }
    while (reader->take_next_sample(&sample, &info) == eprosima::fastrtps::types::ReturnCode_t::RETCODE_OK)
      if (info.valid_data && sample.size() == kSampleBytes) ++taken[static_cast<char>(sample[0])];
  }
  std::string words;
  for (const auto& [mark, count] : taken) words += (words.empty() ? "" : " ") + std::string(1, mark) + std::to_string(count);
  return matched ? words : "nobody";
}

}  // namespace

int main(int argc, char** argv) {
#if !HAVE_SECURITY
  leave("no security");
#endif
  if (argc < 4) return 2;
  fdds::Log::ClearConsumers();  // it would write to standard output, from a thread of its own
  Request request = parse(argc, argv);
  auto* participant =
      fdds::DomainParticipantFactory::get_instance()->create_participant(request.domain, participant_qos(request));
  if (participant == nullptr) leave("refused");
  fdds::TypeSupport type(new BytesType);
  type.register_type(participant);
  auto* topic = participant->create_topic(request.topic, type.get_type_name(), fdds::TOPIC_QOS_DEFAULT);
  if (topic == nullptr) leave("refused");
  leave(request.writes ? write(*participant, *topic, request) : read(*participant, *topic, request));
}
