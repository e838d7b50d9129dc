// Edges inside one process: what strangers send, what states say.
#include <bodeflow/abi.h>

#include <thread>

#include "catch.hpp"
#include "transport/link.hpp"
#include "transport/middleware.hpp"
#include "transport/processes.hpp"

using namespace bodeflow::transport;

namespace {

Settings local() {
  Settings settings;
  settings.domain = test_domain();
  settings.carrier = Settings::Carrier::udp;
  return settings;
}

Edge edge_named(const std::string& topic, double tolerance_s = 3.0) {
  Edge edge;
  edge.topic = topic;
  edge.stream = 5;
  edge.tolerance_s = tolerance_s;
  return edge;
}

class Nobody final : public middleware::WriterSink {
 public:
  void matched(const middleware::Guid& /*reader*/, bool yes) override { readers += yes ? 1 : -1; }
  std::atomic<int> readers{0};
};

tl::expected<void, Failure> send_text(Outlet& outlet, const std::string& text) {
  Header header;
  header.kind = Kind::text;
  const std::span<const std::byte> parts[] = {std::as_bytes(std::span(text))};
  return outlet.send(header, parts, {});
}

}  // namespace

TEST_CASE("malformed and foreign messages are counted and dropped and the stream goes on") {
  const auto participant = join(local());
  REQUIRE(participant);
  const auto edge = edge_named("hostile");
  auto inlet = open_inlet(*participant, edge);
  auto outlet = open_outlet(*participant, edge);
  REQUIRE(inlet);
  REQUIRE(outlet);
  const auto stranger = middleware::join(local(), Settings::Carrier::udp);
  REQUIRE(stranger);
  auto sink = std::make_shared<Nobody>();
  auto writer = (*stranger)->writer({"hostile", middleware::Type::message, middleware::Flow::all}, sink);
  REQUIRE(writer);
  while (sink->readers == 0) std::this_thread::sleep_for(std::chrono::milliseconds(5));

  Header header;
  header.kind = Kind::text;
  header.stream = 6;  // not this edge's
  const auto foreign = encode(header, {});
  auto huge = foreign;
  huge[huge.size() - 1] = std::byte{0xFF};  // a payload of 4 GB
  const std::vector<std::byte> noise(777, std::byte{0xA5});
  for (const auto& bytes : {foreign, huge, noise}) {
    const std::span<const std::byte> parts[] = {bytes};
    REQUIRE((*writer)->write(parts));
  }
  REQUIRE((*writer)->acknowledged(2.0));
  REQUIRE((*outlet)->connect({}));
  REQUIRE(send_text(**outlet, "good"));
  const auto got = (*inlet)->next({});
  REQUIRE(got);
  CHECK(got->payload.size() == 4);
  CHECK((*inlet)->state().refused == 3);
}

TEST_CASE("an edge that stalls shows it within a second while the call waits") {
  const auto participant = join(local());
  REQUIRE(participant);
  auto edge = edge_named("stall");
  edge.queue_bytes = 1000;
  auto inlet = open_inlet(*participant, edge);
  auto outlet = open_outlet(*participant, edge);
  REQUIRE(outlet);
  REQUIRE((*outlet)->connect({}));
  CHECK((*outlet)->state().matched);
  CHECK((*outlet)->state().stalled_s == 0.0);
  REQUIRE(send_text(**outlet, std::string(900, 'x')));
  double shown = 0.0;
  const auto begun = std::chrono::steady_clock::now();
  std::thread sends([&] {
    const auto failed = send_text(**outlet, std::string(900, 'x'));
    CHECK_FALSE(failed);
    CHECK(failed.error().text == "topic 'stall': no reader took anything for 3 s; of 1 messages 1 are not taken");
  });
  while (shown < 0.5) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    shown = (*outlet)->state().stalled_s;
  }
  CHECK(std::chrono::steady_clock::now() - begun < std::chrono::seconds(1));
  CHECK((*outlet)->state().queued_bytes == 900);
  sends.join();
  CHECK((*outlet)->state().waited_s >= 3.0);
}

TEST_CASE("a call that waits ends when its caller says so") {
  const auto participant = join(local());
  REQUIRE(participant);
  auto inlet = open_inlet(*participant, edge_named("stopped"));
  auto outlet = open_outlet(*participant, edge_named("stopped_too"));
  int asked = 0;
  const auto go_on = [&] { return ++asked < 3; };
  const auto got = (*inlet)->next(go_on);
  REQUIRE_FALSE(got);
  CHECK(got.error().kind == Failure::Kind::stopped);
  asked = 0;
  const auto connected = (*outlet)->connect(go_on);
  REQUIRE_FALSE(connected);
  CHECK(connected.error().kind == Failure::Kind::stopped);
  const auto polled = (*inlet)->poll(0.01);
  REQUIRE(polled);
  CHECK_FALSE(polled->has_value());
}

TEST_CASE("what a reader would refuse is not sent") {
  const auto participant = join(local());
  REQUIRE(participant);
  auto outlet = open_outlet(*participant, edge_named("refused"));
  Header header;
  header.kind = Kind::samples;
  const auto sent = (*outlet)->send(header, {}, {});
  REQUIRE_FALSE(sent);
  CHECK(sent.error().kind == Failure::Kind::refused);
  CHECK(sent.error().text == "topic 'refused': not sent: unknown element type 0 (allowed: 1, 2)");
}

TEST_CASE("settings that cannot work are refused by name") {
  auto settings = local();
  settings.lease_s = 0.1;
  CHECK(join(settings).error() == "lease of 0.100000 s (allowed: 0.5 to 3600)");
  settings = local();
  settings.datagram = 100;
  CHECK(join(settings).error() == "datagram of 100 bytes (allowed: 512 to 65500)");
  settings = local();
  settings.discovery = Settings::Discovery::peers;
  settings.peers = {"bench"};
  CHECK(join(settings).error() == "peer 'bench' is not an IPv4 address with or without a port (10.0.0.2:11811)");
  settings = local();
  settings.discovery = Settings::Discovery::server;
  CHECK(join(settings).error() == "no discovery server is named");
  settings = local();
  settings.security = Security{"/nowhere/authority.pem", "", "", "", "", ""};
  CHECK(join(settings).error().find("no file '") == 0);
}
