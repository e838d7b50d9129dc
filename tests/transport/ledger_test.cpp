// What an outlet knows of its readers, without a network.
#include "transport/ledger.hpp"

#include "catch.hpp"

using namespace bodeflow::transport;

namespace {

middleware::Guid guid(std::uint8_t number) {
  middleware::Guid made{};
  made[15] = number;
  return made;
}

Edge edge_of(std::uint64_t queue = 10000, int readers = 1) {
  Edge edge;
  edge.topic = "t";
  edge.stream = 7;
  edge.epoch = 2;
  edge.queue_bytes = queue;
  edge.readers = readers;
  edge.tolerance_s = 0.05;
  return edge;
}

Credit credit_of(std::uint64_t inlet, std::uint8_t reader, std::uint64_t taken = 0) {
  Credit credit;
  credit.stream = 7;
  credit.epoch = 2;
  credit.inlet = inlet;
  credit.reader = guid(reader);
  credit.taken = taken;
  return credit;
}

bool ready(Ledger& ledger) {
  return ledger.wait_for_readers([] { return false; }).has_value();
}

std::string error_of(Ledger& ledger, std::uint64_t bytes) {
  const auto booked = ledger.book(bytes, {});
  return booked ? "booked" : booked.error().text;
}

}  // namespace

TEST_CASE("an outlet counts inlets of its own stream that have matched and no others") {
  Ledger ledger(edge_of(), false);
  ledger.reader_matched(kFar, guid(1), true);
  CHECK_FALSE(ready(ledger));  // some reader: no inlet as far as is known
  auto foreign = credit_of(1, 1);
  foreign.stream = 8;
  ledger.credit(kFar, foreign, false);
  CHECK_FALSE(ready(ledger));
  ledger.credit(kFar, credit_of(1, 2), false);  // an inlet whose reader has not matched
  CHECK_FALSE(ready(ledger));
  ledger.credit(kFar, credit_of(2, 1), false);
  CHECK(ready(ledger));
}

TEST_CASE("an open edge counts any reader and one without readers is ready at once") {
  auto edge = edge_of();
  edge.open = true;
  Ledger open(edge, false);
  CHECK_FALSE(ready(open));
  open.reader_matched(kFar, guid(1), true);
  CHECK(ready(open));
  Ledger none(edge_of(10000, 0), false);
  CHECK(ready(none));
}

TEST_CASE("shared memory is the way where every expected reader has it") {
  Ledger ledger(edge_of(10000, 2), true);
  for (std::uint8_t inlet = 1; inlet <= 2; ++inlet) {
    auto credit = credit_of(inlet, inlet);
    credit.near = true;
    for (const auto way : {kFar, kNear}) {
      ledger.reader_matched(way, guid(inlet), true);
      ledger.credit(way, credit, true);
    }
  }
  CHECK(ledger.wait_for_readers({}).value() == kNear);
  Ledger mixed(edge_of(10000, 2), true);
  for (std::uint8_t inlet = 1; inlet <= 2; ++inlet) {
    mixed.reader_matched(kFar, guid(inlet), true);
    mixed.credit(kFar, credit_of(inlet, inlet), false);
  }
  mixed.reader_matched(kNear, guid(1), true);
  mixed.credit(kNear, credit_of(1, 1), true);
  CHECK(mixed.wait_for_readers({}).value() == kFar);
}

TEST_CASE("what is under way stays within the queue until it is taken") {
  Ledger ledger(edge_of(3 * (1000 + Ledger::kOverhead)), false);
  ledger.reader_matched(kFar, guid(1), true);
  ledger.credit(kFar, credit_of(1, 1), false);
  for (std::uint64_t k = 0; k < 3; ++k) CHECK(ledger.book(1000, {}).value().sequence == k);
  EdgeState state;
  ledger.tell(state);
  CHECK(state.queued_bytes == 3000);
  CHECK(error_of(ledger, 1000) == "topic 't': no reader took anything for 0.05 s; of 3 messages 3 are not taken");
  ledger.credit(kFar, credit_of(1, 1, 2), false);
  CHECK(error_of(ledger, 1000) == "booked");
  CHECK(error_of(ledger, 1000) == "booked");
  CHECK(error_of(ledger, 1000) == "topic 't': no reader took anything for 0.05 s; of 5 messages 3 are not taken");
  ledger.credit(kFar, credit_of(1, 1, 1), false);  // an old one changes nothing
  CHECK(error_of(ledger, 1000) != "booked");
  ledger.credit(kFar, credit_of(1, 1, 5), false);
  CHECK(error_of(ledger, 100000) == "booked");  // larger than the queue: alone
  CHECK(error_of(ledger, 1) != "booked");
}

TEST_CASE("the slowest of several readers holds the outlet") {
  Ledger ledger(edge_of(2 * Ledger::kOverhead, 2), false);
  for (std::uint8_t inlet = 1; inlet <= 2; ++inlet) {
    ledger.reader_matched(kFar, guid(inlet), true);
    ledger.credit(kFar, credit_of(inlet, inlet), false);
  }
  CHECK(error_of(ledger, 0) == "booked");
  CHECK(error_of(ledger, 0) == "booked");
  ledger.credit(kFar, credit_of(1, 1, 2), false);
  CHECK(error_of(ledger, 0) != "booked");
  ledger.credit(kFar, credit_of(2, 2, 1), false);
  CHECK(error_of(ledger, 0) == "booked");
}

TEST_CASE("a reader that goes leaves the count of what it had not taken and another takes its place") {
  Ledger ledger(edge_of(), false);
  ledger.reader_matched(kFar, guid(1), true);
  ledger.credit(kFar, credit_of(1, 1), false);
  for (int k = 0; k < 5; ++k) CHECK(error_of(ledger, 0) == "booked");
  ledger.credit(kFar, credit_of(1, 1, 2), false);
  ledger.reader_matched(kFar, guid(1), false);
  CHECK(error_of(ledger, 0) ==
        "topic 't': only 0 of 1 readers are left, for 0.05 s; of 5 messages 3 were not confirmed as taken");
  ledger.reader_matched(kFar, guid(2), true);
  ledger.credit(kFar, credit_of(9, 2), false);
  CHECK(error_of(ledger, 0) == "booked");
  EdgeState state;
  ledger.tell(state);
  CHECK(state.reconnects == 1);
}
