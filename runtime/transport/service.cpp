#include "transport/service.hpp"

#include <chrono>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <new>
#include <utility>

#include "transport/progress.hpp"

namespace bodeflow::transport {
namespace {

constexpr std::uint32_t kMostDomain = 232;  // ports end there
constexpr double kLongestTolerance = 86400.0;
constexpr double kShownStall_s = 0.7;

struct Free {
  void operator()(std::uint8_t* bytes) const { std::free(bytes); }
};

/// Bytes from a 64-byte boundary on: records are read in place.
class Aligned {
 public:
  std::span<const std::uint8_t> assign(std::span<const std::byte> bytes) {
    if (bytes.size() > size_) {
      const auto rounded = (bytes.size() + 63) / 64 * 64;
      bytes_.reset(static_cast<std::uint8_t*>(std::aligned_alloc(64, rounded)));
      if (!bytes_) throw std::bad_alloc();
      size_ = rounded;
    }
    if (!bytes.empty()) std::memcpy(bytes_.get(), bytes.data(), bytes.size());
    return {bytes_.get(), bytes.size()};
  }

 private:
  std::unique_ptr<std::uint8_t, Free> bytes_;
  std::size_t size_ = 0;
};

/// As `go_on`, but a no counts half a second later: who stopped the run notes that first, and the block's failure is not the
/// reason.
GoOn patient(const GoOn& go_on) {
  if (!go_on) return {};
  return [go_on, since = std::optional<std::chrono::steady_clock::time_point>()]() mutable {
    if (go_on()) return true;
    if (!since) since = std::chrono::steady_clock::now();
    return std::chrono::steady_clock::now() - *since < std::chrono::milliseconds(500);
  };
}

/// How long the samples of a message last, in seconds: so long the next one may take.
double length_of(const Header& header) {
  return header.kind == Kind::samples && header.rate_num > 0
             ? static_cast<double>(header.count) * static_cast<double>(header.rate_den) / static_cast<double>(header.rate_num)
             : 0.0;
}

/// Tells a block's log, once each time, that its topic stands still.
class StallTeller {
 public:
  explicit StallTeller(std::string topic) : topic_(std::move(topic)) {}

  /// `due_s`: the wait that is in order.
  void look(const bf_host* host, const EdgeState& state, double due_s, const char* what) {
    if (told_ || state.stalled_s < due_s + kShownStall_s) return;
    told_ = true;
    write(host, BF_LOG_WARNING, std::string("stands still: ") + what + " for " + seconds_text(due_s + kShownStall_s));
  }
  void goes_on(const bf_host* host) {
    if (std::exchange(told_, false)) write(host, BF_LOG_INFO, "goes on");
  }

 private:
  void write(const bf_host* host, std::int32_t level, const std::string& text) const {
    const auto* log = static_cast<const bf_log*>(host->extension(host, BF_EXTENSION_LOG));
    if (log != nullptr) log->write(host, level, ("topic '" + topic_ + "' " + text).c_str());
  }

  std::string topic_;
  bool told_ = false;
};

struct TopicWriter {
  std::unique_ptr<Outlet> outlet;
  GoOn go_on;
  StallTeller stall;
  std::vector<std::span<const std::byte>> parts;
  bool begun = false;
};

struct TopicReader {
  std::unique_ptr<Inlet> inlet;
  GoOn go_on;
  StallTeller stall;
  bool streams = false;  ///< it has carried samples: records may be rare
  Message message;
  Aligned payload;
  bf_part part{};
};

tl::expected<Edge, std::string> edge_of(const bf_topic* topic) {
  const auto wrong = [](std::string text) { return tl::unexpected<std::string>(std::move(text)); };
  if (topic == nullptr || topic->name == nullptr || *topic->name == '\0') return wrong("a topic without a name");
  Edge edge;
  edge.topic = topic->name;
  if (edge.topic.size() > 200) return wrong("a topic's name longer than 200 bytes");
  if (topic->domain > kMostDomain) return wrong("DDS domain " + std::to_string(topic->domain) + " (allowed: 0 to 232)");
  if (!(topic->tolerance_s > 0.0 && topic->tolerance_s <= kLongestTolerance)) return wrong("a tolerance beyond 0 to 86400 s");
  if (topic->readers > 1000) return wrong("more than 1000 readers");
  edge.open = true;
  edge.lossless = (topic->flags & BF_TOPIC_LATEST) == 0;
  edge.keeps_last = (topic->flags & BF_TOPIC_KEEPS_LAST) != 0;
  edge.tolerance_s = topic->tolerance_s;
  edge.queue_bytes = topic->queue_bytes;
  edge.readers = static_cast<int>(topic->readers);
  return edge;
}

Header header_of(const bf_topic_message& message) {
  Header header;
  header.kind = static_cast<Kind>(message.kind);
  header.element = message.element;
  header.channels = message.channels;
  header.position = message.position;
  header.count = message.count;
  header.rate_num = message.rate.num;
  header.rate_den = message.rate.den == 0 ? 1 : message.rate.den;
  if (message.clock != nullptr) header.clock = message.clock;
  return header;
}

void fill(bf_topic_message& out, TopicReader& reader) {
  const auto& header = reader.message.header;
  const auto payload = reader.payload.assign(reader.message.payload);
  reader.part = {payload.data(), payload.size()};
  out.kind = static_cast<std::uint32_t>(header.kind);
  out.element = header.element;
  out.channels = header.channels;
  out.position = header.position;
  out.count = header.count;
  out.rate = {header.rate_num, header.rate_den};
  out.source_ns = header.source_ns;
  out.clock = header.clock.c_str();
  out.parts = &reader.part;
  out.part_count = 1;
}

}  // namespace

/// What a plugin calls: nothing is thrown through it.
struct ServiceFunctions {
  static void* open_writer(const bf_transport* transport, const bf_host* host, const bf_topic* topic) noexcept {
    return opened(transport, host, topic,
                  [](Service& service, const auto& participant, Edge edge) -> tl::expected<void*, std::string> {
                    edge.stream = stream_id(edge.topic);
                    edge.epoch = static_cast<std::uint32_t>(std::time(nullptr));  // a writer that comes later is higher
                    auto outlet = open_outlet(participant, edge);
                    if (!outlet) return tl::unexpected(outlet.error().text);
                    return new TopicWriter{std::move(*outlet), patient(service.go_on_), StallTeller(edge.topic), {}};
                  });
  }

  static void* open_reader(const bf_transport* transport, const bf_host* host, const bf_topic* topic) noexcept {
    return opened(transport, host, topic,
                  [](Service& service, const auto& participant, const Edge& edge) -> tl::expected<void*, std::string> {
                    auto inlet = open_inlet(participant, edge);
                    if (!inlet) return tl::unexpected(inlet.error().text);
                    return new TopicReader{
                        std::move(*inlet), patient(service.go_on_), StallTeller(edge.topic), false, {}, {}, {}};
                  });
  }

  static std::int32_t write(const bf_host* host, void* writer, const bf_topic_message* message) noexcept {
    return guarded(host, [&]() -> tl::expected<void, Failure> {
      auto& to = *static_cast<TopicWriter*>(writer);
      to.parts.clear();
      for (std::uint64_t i = 0; i < message->part_count; ++i) {
        to.parts.push_back(std::as_bytes(std::span(message->parts[i].bytes, message->parts[i].size)));
      }
      const Header header = header_of(*message);
      const double due_s = length_of(header);
      const auto go_on = [&] {
        if (to.begun) to.stall.look(host, to.outlet->state(), due_s, "its readers took nothing");
        return !to.go_on || to.go_on();
      };
      auto sent = to.outlet->send(header, to.parts, go_on);
      if (sent) to.stall.goes_on(host);
      to.begun = sent.has_value();
      return sent;
    });
  }

  static std::int32_t flush(const bf_host* host, void* writer) noexcept {
    return guarded(host, [&]() -> tl::expected<void, Failure> {
      auto& to = *static_cast<TopicWriter*>(writer);
      return to.outlet->drain(to.go_on);
    });
  }

  static std::int32_t read(const bf_host* host, void* reader, double seconds, bf_topic_message* message) noexcept {
    return guarded(host, [&]() -> tl::expected<void, Failure> {
      auto& from = *static_cast<TopicReader*>(reader);
      message->kind = BF_MESSAGE_NONE;
      if (seconds < 0.0) {
        const double due_s = length_of(from.message.header);
        const auto go_on = [&] {
          if (from.streams) from.stall.look(host, from.inlet->state(), due_s, "nothing came");
          return !from.go_on || from.go_on();
        };
        auto next = from.inlet->next(go_on);
        if (!next) return tl::unexpected(next.error());
        from.message = std::move(*next);
      } else {
        auto next = from.inlet->poll(seconds);
        if (!next) return tl::unexpected(next.error());
        if (!*next) return {};
        from.message = std::move(**next);
      }
      from.streams = from.message.header.kind == Kind::samples;
      from.stall.goes_on(host);
      fill(*message, from);
      return {};
    });
  }

  static void close_writer(void* writer) noexcept { delete static_cast<TopicWriter*>(writer); }
  static void close_reader(void* reader) noexcept { delete static_cast<TopicReader*>(reader); }

 private:
  template <class Open>
  static void* opened(const bf_transport* transport, const bf_host* host, const bf_topic* topic, Open open) noexcept {
    void* end = nullptr;
    guarded(host, [&]() -> tl::expected<void, Failure> {
      const auto refused = [](std::string text) { return tl::unexpected(Failure{Failure::Kind::refused, std::move(text)}); };
      auto& service = *static_cast<Service*>(transport->context);
      auto edge = edge_of(topic);
      if (!edge) return refused(std::move(edge.error()));
      auto participant = service.participant(topic->domain);
      if (!participant) return refused(std::move(participant.error()));
      auto made = open(service, *participant, std::move(*edge));
      if (!made) return refused(std::move(made.error()));
      end = *made;
      return {};
    });
    return end;
  }

  template <class Call>
  static std::int32_t guarded(const bf_host* host, Call&& call) noexcept {
    try {
      auto done = call();
      if (done) return BF_OK;
      host->error(host, done.error().text.c_str());
    } catch (const std::exception& exception) {
      host->error(host, exception.what());
    } catch (...) {
      host->error(host, "the transport failed");
    }
    return BF_FAILED;
  }
};

Service::Service(Settings settings, GoOn go_on) : settings_(std::move(settings)), go_on_(std::move(go_on)) {
  c_.struct_size = sizeof c_;
  c_.context = this;
  c_.open_writer = &ServiceFunctions::open_writer;
  c_.open_reader = &ServiceFunctions::open_reader;
  c_.write = &ServiceFunctions::write;
  c_.flush = &ServiceFunctions::flush;
  c_.read = &ServiceFunctions::read;
  c_.close_writer = &ServiceFunctions::close_writer;
  c_.close_reader = &ServiceFunctions::close_reader;
}

tl::expected<std::shared_ptr<Participant>, std::string> Service::participant(std::uint32_t domain) {
  const std::lock_guard lock(mutex_);
  auto& participant = participants_[domain];
  if (participant) return participant;
  auto settings = settings_;
  settings.domain = domain;
  auto joined = join(settings);
  if (!joined) return tl::unexpected(joined.error());
  return participant = *joined;
}

}  // namespace bodeflow::transport
