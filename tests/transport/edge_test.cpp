// Edges between two processes on one host, counted sample by sample.
#include <sys/stat.h>

#include <filesystem>

#include "catch.hpp"
#include "transport/processes.hpp"

namespace {

/// Options that both ends get, beside their own.
struct Ends {
  std::vector<std::string> both, sender, receiver;
};

std::vector<std::string> joined(std::vector<std::string> a, const std::vector<std::string>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

void all_arrive(const Ends& ends, double messages) {
  Process receiver(peer("receive", joined(ends.both, ends.receiver)));
  Process sender(peer("send", joined(ends.both, ends.sender)));
  const int sent = sender.wait(), received = receiver.wait();
  INFO(sender.output() << "\n" << receiver.output());
  CHECK(sent == 0);
  CHECK(received == 0);
  CHECK(receiver.number("messages") == messages);
  CHECK(receiver.number("wrong") == 0);
  CHECK(receiver.number("gaps") == 0);
  CHECK(receiver.number("refused") == 0);
  CHECK(sender.number("messages") == messages);
}

}  // namespace

TEST_CASE("every sample arrives once and in order over shared memory") {
  all_arrive({{"topic=order", "count=5000", "bytes=8192"}, {}, {}}, 5000);
  all_arrive({{"topic=order", "count=60", "bytes=1000000"}, {}, {}}, 60);
  all_arrive({{"topic=order", "count=8000", "bytes=64"}, {}, {}}, 8000);
}

TEST_CASE("every sample arrives once and in order over each carrier alone") {
  all_arrive({{"topic=udp", "carrier=udp", "count=1500"}, {}, {}}, 1500);
  all_arrive({{"topic=udp", "carrier=udp", "count=15", "bytes=1000000"}, {}, {}}, 15);
  all_arrive({{"topic=tcp", "carrier=tcp", "peer=127.0.0.1", "count=1500"}, {}, {}}, 1500);
  all_arrive({{"topic=shm", "carrier=shared_memory", "count=1500"}, {}, {}}, 1500);
}

TEST_CASE("a sender with shared memory and a receiver with UDP alone understand each other") {
  all_arrive({{"topic=mixed", "count=1000"}, {}, {"carrier=udp"}}, 1000);
  all_arrive({{"topic=mixed", "count=1000"}, {"carrier=udp"}, {}}, 1000);
}

TEST_CASE("a message that is larger than the queue goes alone") {
  all_arrive({{"topic=large", "count=6", "bytes=1000000", "queue=100000"}, {}, {}}, 6);
}

TEST_CASE("a slow consumer holds the sender back and memory stays within the queue") {
  Process receiver(peer("receive", {"topic=slow", "count=400", "bytes=80000", "queue=400000", "pause_us=2000"}));
  Process sender(peer("send", {"topic=slow", "count=400", "bytes=80000", "queue=400000"}));
  CHECK(sender.wait() == 0);
  CHECK(receiver.wait() == 0);
  INFO(sender.output() << "\n" << receiver.output());
  CHECK(receiver.number("wrong") == 0);
  CHECK(receiver.number("messages") == 400);
  CHECK(sender.number("waited") > 0.5);  // 400 times 2 ms, but for the queue
  // 32 MB went through; without credit the history of the library would hold them. The segment of shared memory counts too.
  CHECK(sender.number("resident_kb") < 60000);
  CHECK(receiver.number("resident_kb") < 60000);
}

TEST_CASE("memory stays within the queue on an open edge too") {
  Process receiver(
      peer("receive", {"topic=open", "open=1", "stream=0", "count=1200", "bytes=80000", "queue=400000", "pause_us=1000"}));
  Process sender(peer("send", {"topic=open", "open=1", "count=1200", "bytes=80000", "queue=400000"}));
  CHECK(sender.wait() == 0);
  CHECK(receiver.wait() == 0);
  INFO(sender.output() << "\n" << receiver.output());
  CHECK(receiver.number("wrong") == 0);
  CHECK(receiver.number("messages") == 1200);
  CHECK(sender.number("resident_kb") < 60000);  // of 96 MB
  CHECK(receiver.number("resident_kb") < 60000);
}

TEST_CASE("a sender whose reader is killed says how many messages were not taken") {
  Process receiver(peer("receive", {"topic=killed", "count=1000", "die_after=50", "queue=100000"}));
  Process sender(peer("send", {"topic=killed", "count=1000", "queue=100000", "tolerance=1"}));
  CHECK(sender.wait() == 1);
  CHECK(receiver.prints("dying"));
  INFO(sender.output());
  CHECK((sender.value("failure") == "tolerance" || sender.value("failure") == "peer"));
  // The queue holds 11 messages of 8192 bytes; at least that many less one eighth were under way when the reader died.
  const auto sent = sender.number("messages");
  CHECK(sent >= 50);
  CHECK(sent <= 62);
  const auto error = sender.value("error");
  CHECK(error.find("topic 'killed': ") == 0);
  CHECK(error.find("of " + std::to_string(static_cast<int>(sent)) + " messages ") != std::string::npos);
  CHECK(sender.number("stalled") > 0.9);
}

TEST_CASE("a reader whose writer is killed fails after the tolerance and says what came") {
  Process receiver(peer("receive", {"topic=writer", "count=1000000", "tolerance=1"}));
  Process sender(peer("send", {"topic=writer", "count=1000000", "pause_us=500"}));
  REQUIRE(receiver.prints("first_sequence=0"));
  sender.signal(9);
  CHECK(receiver.wait() == 1);
  INFO(receiver.output());
  CHECK(receiver.number("wrong") == 0);
  const auto messages = std::to_string(static_cast<int>(receiver.number("messages"))) + " messages";
  CHECK(receiver.value("error").find(messages) != std::string::npos);
}

TEST_CASE("a writer that ends without a word is told as gone") {
  Process receiver(peer("receive", {"topic=gone", "count=1000", "tolerance=0.5"}));
  Process sender(peer("send", {"topic=gone", "count=10"}));
  CHECK(sender.wait() == 0);
  CHECK(receiver.wait() == 1);
  CHECK(receiver.value("failure") == "peer");
  CHECK(receiver.value("error") == "topic 'gone': the writer has gone after 10 messages, and none came for 0.5 s");
}

TEST_CASE("nobody to talk to within the tolerance is an error that says so") {
  Process sender(peer("send", {"topic=alone", "tolerance=0.3"}));
  Process receiver(peer("receive", {"topic=alone_too", "tolerance=0.3"}));
  CHECK(sender.wait() == 1);
  CHECK(sender.value("error") == "topic 'alone': only 0 of 1 readers came within 0.3 s");
  CHECK(receiver.wait() == 1);
  CHECK(receiver.value("error") == "topic 'alone_too': no writer came within 0.3 s");
}

TEST_CASE("a writer that comes again with a higher epoch goes on from its first message") {
  Process receiver(peer("receive", {"topic=again", "count=20", "tolerance=8"}));
  Process first(peer("send", {"topic=again", "count=10", "epoch=1"}));
  CHECK(first.wait() == 0);
  Process second(peer("send", {"topic=again", "count=10", "epoch=2"}));
  CHECK(second.wait() == 0);
  CHECK(receiver.wait() == 0);
  CHECK(receiver.number("messages") == 20);
  CHECK(receiver.number("gaps") == 0);
  CHECK(receiver.number("reconnects") >= 1);
}

TEST_CASE("a reader that comes in the place of a killed one is told what it missed and gets the rest") {
  Process first(peer("receive", {"topic=place", "count=1000", "die_after=20", "queue=100000", "lease=1"}));
  Process sender(peer("send", {"topic=place", "count=60", "queue=100000", "tolerance=8"}));
  REQUIRE(first.prints("dying"));
  Process second(peer("receive", {"topic=place", "count=1000", "tolerance=5"}));
  CHECK(second.wait() == 1);
  INFO(sender.output() << "\n" << second.output());
  CHECK(second.value("error").find("messages of stream 1 are missing before message ") != std::string::npos);
  CHECK(second.number("gaps") >= 20);
}

TEST_CASE("a reader that joins late gets the last message of an edge that keeps it") {
  Process early(peer("receive", {"topic=last", "count=5", "keeps_last=1"}));
  Process sender(peer("send", {"topic=last", "count=5", "keeps_last=1", "linger=1.5", "bytes=800"}));
  REQUIRE(early.wait() == 0);
  CHECK(early.number("wrong") == 0);
  Process late(peer("receive", {"topic=last", "count=1", "keeps_last=1", "any_first=1"}));
  CHECK(late.wait() == 0);
  CHECK(late.number("first_sequence") == 4);
  CHECK(sender.wait() == 0);
}

TEST_CASE("two graphs with the same topic and other streams do not mix") {
  Process receiver_a(peer("receive", {"topic=same", "stream=11", "count=300"}));
  Process receiver_b(peer("receive", {"topic=same", "stream=22", "count=300"}));
  Process sender_a(peer("send", {"topic=same", "stream=11", "count=300"}));
  Process sender_b(peer("send", {"topic=same", "stream=22", "count=300"}));
  for (auto* process : {&sender_a, &sender_b, &receiver_a, &receiver_b}) {
    CHECK(process->wait() == 0);
    CHECK(process->number("messages") == 300);
  }
  CHECK(receiver_a.number("wrong") == 0);
  CHECK(receiver_b.number("wrong") == 0);
}

TEST_CASE("an edge with two readers waits for both and brings all to both") {
  Process a(peer("receive", {"topic=two", "count=500"}));
  Process sender(peer("send", {"topic=two", "count=500", "readers=2"}));
  Process b(peer("receive", {"topic=two", "count=500", "pause_us=500"}));
  for (auto* process : {&sender, &a, &b}) CHECK(process->wait() == 0);
  CHECK(a.number("wrong") == 0);
  CHECK(b.number("wrong") == 0);
  CHECK(a.number("messages") == 500);
  CHECK(b.number("messages") == 500);
}

TEST_CASE("an edge of the latest never holds its writer back") {
  Process receiver(peer("receive", {"topic=latest", "lossless=0", "count=5", "pause_us=20000", "any_first=1"}));
  Process sender(peer("send", {"topic=latest", "lossless=0", "count=300", "pause_us=1000", "bytes=800"}));
  CHECK(sender.wait() == 0);
  CHECK(receiver.wait() == 0);
  CHECK(sender.number("waited") < 0.2);
}

TEST_CASE("texts reach a mailbox and a post without a reader says so") {
  Process mailbox(peer("mailbox", {"topic=letters"}));
  Process sender(peer("post", {"topic=letters", "bytes=3000000"}));
  CHECK(sender.wait() == 0);
  CHECK(mailbox.wait() == 0);
  CHECK(mailbox.number("got") == 3000000);
  Process nobody(peer("post", {"topic=nobody", "seconds=0.3"}));
  CHECK(nobody.wait() == 1);
  CHECK(nobody.value("error") == "mailbox 'nobody': nobody reads it within 0.3 s");
}

TEST_CASE("a board shows those who are there and forgets the killed within its liveliness") {
  Process reader(peer("board", {"seconds=4.5"}));
  Process ends(peer("board", {"say=ends", "seconds=1"}));
  Process dies(peer("board", {"say=dies", "seconds=20"}));
  REQUIRE(reader.prints("dies"));
  REQUIRE(reader.prints("ends"));
  dies.signal(9);
  CHECK(reader.wait() == 0);
  INFO(reader.output());
  CHECK(reader.value("t44").empty());
}

namespace {

/// Files of the library's ports in a domain: they are numbered by it, whatever else runs here.
int shared_files(unsigned domain) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator("/dev/shm")) {
    const auto name = entry.path().filename().string();
    for (unsigned port = 7400 + 250 * domain; port < 7650 + 250 * domain; ++port) {
      if (name.find("port" + std::to_string(port)) != std::string::npos) ++count;
    }
  }
  return count;
}

}  // namespace

TEST_CASE("nothing is left in shared memory after a clean end") {
  const unsigned domain = 20 + (test_domain() + 80) % 200;  // where no test has killed anybody
  const auto in_domain = "domain=" + std::to_string(domain);
  Process receiver(peer("receive", {"topic=clean", "linger=0.3", in_domain}));
  Process sender(peer("send", {"topic=clean", "linger=0.5", in_domain}));
  REQUIRE(sender.prints("connected"));
  CHECK(shared_files(domain) > 0);
  CHECK(sender.wait() == 0);
  CHECK(receiver.wait() == 0);
  CHECK(shared_files(domain) == 0);
}

TEST_CASE("what a killed process left in shared memory goes when another joins and what living ones use stays", "[long]") {
  const unsigned domain = 20 + (test_domain() + 140) % 200;
  const auto in_domain = "domain=" + std::to_string(domain);
  {
    Process killed(peer("board", {"seconds=20", in_domain}));
    REQUIRE(killed.prints("t0="));
    killed.signal(9);
    killed.wait();
  }
  CHECK(shared_files(domain) > 0);
  Process receiver(peer("receive", {"topic=alive", "count=400", in_domain}));
  Process sender(peer("send", {"topic=alive", "count=400", "pause_us=10000", in_domain}));
  REQUIRE(receiver.prints("first_sequence"));
  shell("sleep 2.5");
  Process joins(peer("board", {"seconds=0.1"}));  // in another domain: leftovers of all are looked at
  CHECK(joins.wait() == 0);
  CHECK(sender.wait() == 0);
  CHECK(receiver.wait() == 0);
  CHECK(receiver.number("wrong") == 0);
  Process last(peer("board", {"seconds=0.1"}));
  shell("sleep 2.5");
  CHECK(last.wait() == 0);
  Process after(peer("board", {"seconds=0.1"}));
  CHECK(after.wait() == 0);
  CHECK(shared_files(domain) == 0);
}

TEST_CASE("memory is flat while gigabytes go through", "[long]") {
  Process receiver(peer("receive", {"topic=flat", "count=300000"}));
  Process sender(peer("send", {"topic=flat", "count=300000"}));
  CHECK(sender.wait() == 0);
  CHECK(receiver.wait() == 0);
  CHECK(receiver.number("wrong") == 0);
  CHECK(receiver.number("messages") == 300000);
  INFO(receiver.output());
  // The queue of 4 MiB may be fuller than it was; nothing may grow by the messages, of which 2 GB came in between.
  CHECK(receiver.number("resident_kb") - receiver.number("resident_begin_kb") < 12000);
}
