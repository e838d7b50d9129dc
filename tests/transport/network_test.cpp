// Edges between hosts: network namespaces joined by a bridge. Nothing is tested where they are not permitted, and a line says so.
#include <thread>

#include "catch.hpp"
#include "transport/processes.hpp"

namespace {

bool there(const Hosts& hosts) {
  if (hosts.missing().empty()) return true;
  WARN("not tested: " << hosts.missing());
  return false;
}

void sleep_s(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }

void complete(Process& sender, Process& receiver, double messages) {
  const int sent = sender.wait(), received = receiver.wait();
  INFO(sender.output() << "\n" << receiver.output());
  CHECK(sent == 0);
  CHECK(received == 0);
  CHECK(receiver.number("messages") == messages);
  CHECK(receiver.number("wrong") == 0);
  CHECK(receiver.number("gaps") == 0);
}

}  // namespace

TEST_CASE("hosts: every sample arrives once and in order over UDP") {
  const Hosts hosts(2);
  if (!there(hosts)) return;
  Process receiver(hosts.on(1, peer("receive", {"count=3000"})));
  Process sender(hosts.on(0, peer("send", {"count=3000"})));
  complete(sender, receiver, 3000);
}

TEST_CASE("hosts: a peer named on one side is enough without multicast") {
  const Hosts hosts(2);
  if (!there(hosts)) return;
  Process receiver(hosts.on(1, peer("receive", {"peer=" + Hosts::address(0)})));
  Process sender(hosts.on(0, peer("send", {"peer="})));
  complete(sender, receiver, 100);
}

TEST_CASE("hosts: every sample arrives over TCP") {
  const Hosts hosts(2);
  if (!there(hosts)) return;
  Process receiver(hosts.on(1, peer("receive", {"count=1000", "carrier=tcp", "peer="})));
  REQUIRE(receiver.prints("joined"));
  sleep_s(0.5);  // Fast DDS may not try again when it meets a process that has only just joined
  Process sender(hosts.on(0, peer("send", {"count=1000", "carrier=tcp", "peer=" + Hosts::address(1)})));
  complete(sender, receiver, 1000);
}

TEST_CASE("hosts: nothing is lost where one datagram in twenty is") {
  const Hosts hosts(2);
  if (!there(hosts)) return;
  Process receiver(hosts.on(1, peer("receive", {"count=400", "loss=0.05"})));
  Process sender(hosts.on(0, peer("send", {"count=400", "loss=0.05"})));
  complete(sender, receiver, 400);
  CHECK(receiver.number("filtered") > 0);
}

TEST_CASE("hosts: nothing is lost while a link is down for less than the tolerance") {
  const Hosts hosts(2);
  if (!there(hosts)) return;
  Process receiver(hosts.on(1, peer("receive", {"count=1000"})));
  Process sender(hosts.on(0, peer("send", {"count=1000", "pause_us=500"})));
  REQUIRE(receiver.prints("first_sequence"));
  hosts.link(1, false);
  sleep_s(1.5);
  hosts.link(1, true);
  complete(sender, receiver, 1000);
  CHECK(receiver.number("stalled") > 1.0);
}

TEST_CASE("hosts: nothing is lost while a link is down for five seconds", "[long]") {
  const Hosts hosts(2);
  if (!there(hosts)) return;
  Process receiver(hosts.on(1, peer("receive", {"count=5000"})));
  Process sender(hosts.on(0, peer("send", {"count=5000", "pause_us=500"})));
  REQUIRE(receiver.prints("first_sequence"));
  hosts.link(1, false);
  sleep_s(5.0);
  hosts.link(1, true);
  complete(sender, receiver, 5000);
}

TEST_CASE("hosts: a link that is down for longer than the tolerance fails the edge on both sides with counts") {
  const Hosts hosts(2);
  if (!there(hosts)) return;
  Process receiver(hosts.on(1, peer("receive", {"count=100000", "tolerance=1"})));
  Process sender(hosts.on(0, peer("send", {"count=100000", "tolerance=1", "pause_us=200"})));
  REQUIRE(receiver.prints("first_sequence"));
  hosts.link(1, false);
  CHECK(receiver.wait() == 1);
  CHECK(sender.wait() == 1);
  INFO(sender.output() << "\n" << receiver.output());
  CHECK(receiver.number("wrong") == 0);
  CHECK(receiver.value("error").find(" messages") != std::string::npos);
  CHECK(sender.value("error").find(" messages ") != std::string::npos);
}

TEST_CASE("hosts: processes find each other by a discovery server and stream on when it is killed") {
  const Hosts hosts(3);
  if (!there(hosts)) return;
  if (shell("command -v fast-discovery-server > /dev/null") != 0) {
    WARN("not tested: fast-discovery-server is not installed (fastdds-tools)");
    return;
  }
  Process server(hosts.on(2, {"fast-discovery-server", "-i", "0", "-l", Hosts::address(2), "-p", "11811"}));
  Process receiver(hosts.on(1, peer("receive", {"count=1500", "server=" + Hosts::address(2)})));
  Process sender(hosts.on(0, peer("send", {"count=1500", "pause_us=500", "server=" + Hosts::address(2)})));
  REQUIRE(receiver.prints("first_sequence"));
  server.signal(9);
  complete(sender, receiver, 1500);
}

TEST_CASE("hosts: a board spans them and texts go between them") {
  const Hosts hosts(3);
  if (!there(hosts)) return;
  Process a(hosts.on(0, peer("board", {"say=alpha", "seconds=2.5"})));
  Process b(hosts.on(1, peer("board", {"say=beta", "seconds=2.5"})));
  Process c(hosts.on(2, peer("board", {"seconds=2.5"})));
  CHECK(c.prints("alpha"));
  CHECK(c.prints("beta"));
  Process mailbox(hosts.on(1, peer("mailbox", {})));
  Process post(hosts.on(2, peer("post", {"bytes=100000"})));
  CHECK(post.wait() == 0);
  CHECK(mailbox.wait() == 0);
  CHECK(mailbox.number("got") == 100000);
}
