#include "lab/channel.hpp"

#include <fmt/format.h>

#include <chrono>

namespace bodeflow::lab {
namespace {

constexpr std::uint64_t kQueueBytes = std::uint64_t{80} << 20;
/// A side that says nothing for so long has gone: both say something every half second.
constexpr double kTolerance_s = 10.0;

transport::Edge edge(const std::string& topic) {
  transport::Edge edge;
  edge.topic = topic;
  edge.stream = transport::stream_id(topic);
  edge.queue_bytes = kQueueBytes;
  edge.tolerance_s = kTolerance_s;
  return edge;
}

}  // namespace

std::string part_name(const std::string& run, int epoch) { return epoch == 0 ? run : fmt::format("{}-{}", run, epoch); }

transport::Edge edge_of(const LinksName& links, const std::string& phase, int repeat, std::size_t cut, double tolerance_s,
                        std::uint64_t queue_bytes) {
  transport::Edge made = edge(fmt::format("bodeflow/{}/{}@{}/{}", links.name, phase, repeat, cut));
  made.epoch = links.epoch;
  made.tolerance_s = tolerance_s;
  made.queue_bytes = queue_bytes;
  return made;
}

tl::expected<std::unique_ptr<Channel>, std::string> Channel::open(const std::shared_ptr<transport::Participant>& participant,
                                                                  const std::string& run, const std::string& host,
                                                                  bool launcher) {
  const std::string topic = fmt::format("bodeflow/{}/host/{}", run, host.empty() ? "launcher" : host);
  auto outlet = transport::open_outlet(participant, edge(topic + (launcher ? "/to" : "/from")));
  if (!outlet) return tl::unexpected(outlet.error().text);
  auto inlet = transport::open_inlet(participant, edge(topic + (launcher ? "/from" : "/to")));
  if (!inlet) return tl::unexpected(inlet.error().text);
  auto channel = std::make_unique<Channel>();
  channel->outlet_ = std::move(*outlet);
  channel->inlet_ = std::move(*inlet);
  return channel;
}

tl::expected<void, std::string> Channel::connect(const transport::GoOn& go_on) {
  auto connected = outlet_->connect(go_on);
  if (!connected) return tl::unexpected(connected.error().text);
  return {};
}

tl::expected<std::optional<Channel::Heard>, std::string> Channel::hear(double seconds) {
  auto message = inlet_->poll(seconds);
  if (!message) return tl::unexpected(message.error().text);
  if (!*message) return std::optional<Heard>();
  Heard heard;
  heard.bytes = std::move((*message)->payload);
  if ((*message)->header.kind == transport::Kind::text) {
    const auto* text = reinterpret_cast<const char*>(heard.bytes.data());
    heard.said = nlohmann::json::parse(text, text + heard.bytes.size(), nullptr, false);
    if (!heard.said.is_object()) return tl::unexpected(std::string("the other side does not speak JSON"));
    heard.bytes.clear();
  }
  return heard;
}

tl::expected<void, std::string> Channel::give(transport::Kind kind, std::span<const std::byte> bytes,
                                              const transport::GoOn& go_on) {
  transport::Header header;
  header.kind = kind;
  header.rate_num = 1;
  auto sent = outlet_->send(header, {&bytes, 1}, go_on);
  if (!sent) return tl::unexpected(sent.error().text);
  return {};
}

tl::expected<void, std::string> Channel::say(const nlohmann::json& message, const transport::GoOn& go_on) {
  const std::string text = message.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  return give(transport::Kind::text, std::as_bytes(std::span(text)), go_on);
}

tl::expected<void, std::string> Channel::send(std::span<const std::byte> bytes, const transport::GoOn& go_on) {
  return give(transport::Kind::record, bytes, go_on);
}

void Channel::drain(double seconds) {
  const auto until = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  (void)outlet_->drain([&] { return std::chrono::steady_clock::now() < until; });
}

}  // namespace bodeflow::lab
