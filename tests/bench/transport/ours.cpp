#include <bodeflow/abi.h>

#include <cstdio>
#include <cstdlib>

#include "link.hpp"
#include "transport/link.hpp"

using namespace bodeflow::transport;

namespace {

std::shared_ptr<Participant> participant(const Way& way) {
  static std::shared_ptr<Participant> joined;
  if (joined) return joined;
  Settings settings;
  settings.domain = way.domain;
  settings.datagram = way.datagram;
  if (way.carrier == "udp") settings.carrier = Settings::Carrier::udp;  // else automatic: what a user has
  auto made = join(settings);
  if (!made) std::puts(made.error().c_str()), std::exit(1);
  return joined = *made;
}

template <class T>
T checked(tl::expected<T, Failure> value) {
  if (!value) std::puts(value.error().text.c_str()), std::exit(1);
  if constexpr (!std::is_void_v<T>) return std::move(*value);
}

Edge edge(const std::string& topic) {
  Edge edge;
  edge.topic = topic;
  edge.stream = 1;
  edge.queue_bytes = 16u << 20;
  return edge;
}

class Ours final : public Sender, public Receiver {
 public:
  void connect() override { checked(outlet->connect({})); }
  void send(std::span<const std::byte> bytes) override {
    Header header;
    header.kind = Kind::samples;
    header.channels = 1;
    header.rate_num = 1000;
    header.element = BF_F64;
    header.count = bytes.size() / 8;
    const std::span<const std::byte> parts[] = {bytes};
    checked(outlet->send(header, parts, {}));
  }
  void drain() override { checked(outlet->drain({})); }
  std::size_t next() override { return checked(inlet->next({})).payload.size(); }

  std::unique_ptr<Outlet> outlet;
  std::unique_ptr<Inlet> inlet;
};

}  // namespace

std::unique_ptr<Sender> our_sender(const Way& way, const std::string& topic) {
  auto ours = std::make_unique<Ours>();
  ours->outlet = checked(open_outlet(participant(way), edge(topic)));
  return ours;
}

std::unique_ptr<Receiver> our_receiver(const Way& way, const std::string& topic) {
  auto ours = std::make_unique<Ours>();
  ours->inlet = checked(open_inlet(participant(way), edge(topic)));
  return ours;
}
