// Where an inlet's messages wait, without a network.
#include "transport/shelf.hpp"

#include "catch.hpp"
#include "transport/ledger.hpp"
#include "transport/text_message.hpp"

using namespace bodeflow::transport;

namespace {

Edge edge_of(std::uint64_t stream = 7) {
  Edge edge;
  edge.topic = "t";
  edge.stream = stream;
  return edge;
}

void put(Shelf& shelf, std::uint64_t sequence, std::uint32_t epoch = 1, std::uint64_t stream = 7, std::size_t bytes = 8) {
  Header header;
  header.kind = Kind::text;
  header.stream = stream;
  header.epoch = epoch;
  header.sequence = sequence;
  const std::vector<std::byte> payload(bytes);
  const std::span<const std::byte> parts[] = {payload};
  shelf.put(kFar, encode(header, parts));
}

/// Sequence of the next item, -1: none.
std::int64_t next(Shelf& shelf, std::uint64_t gap = 0) {
  const auto item = shelf.take(0.0);
  if (!item) return -1;
  CHECK(item->gap == gap);
  return static_cast<std::int64_t>(item->message.header.sequence);
}

EdgeState state_of(const Shelf& shelf) {
  EdgeState state;
  shelf.tell(state);
  return state;
}

}  // namespace

TEST_CASE("messages come in order and each once") {
  Shelf shelf(edge_of());
  for (const std::uint64_t k : {0, 1, 1, 0, 2}) put(shelf, k);
  for (std::int64_t k = 0; k < 3; ++k) CHECK(next(shelf) == k);
  CHECK(next(shelf) == -1);
  CHECK(state_of(shelf).messages == 3);
  CHECK(state_of(shelf).gaps == 0);
}

TEST_CASE("a gap stands before the message that shows it and is counted") {
  Shelf shelf(edge_of());
  put(shelf, 2);  // a reader in a new place: two were sent before
  put(shelf, 3);
  put(shelf, 7);
  CHECK(next(shelf, 2) == 2);
  CHECK(next(shelf) == 3);
  const auto item = shelf.take(0.0);
  REQUIRE(item);
  CHECK(shelf.missing(*item).text == "topic 't': 3 messages of stream 7 are missing before message 7 of epoch 1");
  CHECK(state_of(shelf).gaps == 5);
}

TEST_CASE("a higher epoch begins at its first message and a lower one is over") {
  Shelf shelf(edge_of());
  put(shelf, 0, 1);
  put(shelf, 0, 2);
  put(shelf, 1, 1);
  put(shelf, 1, 2);
  put(shelf, 1, 3);
  CHECK(next(shelf) == 0);
  CHECK(next(shelf) == 0);
  CHECK(next(shelf) == 1);
  CHECK(next(shelf, 1) == 1);  // of epoch 3, whose first is missing
  CHECK(next(shelf) == -1);
  CHECK(state_of(shelf).reconnects == 2);
}

TEST_CASE("an open edge begins with what comes first and keeps to its stream") {
  auto edge = edge_of(0);
  edge.open = true;
  Shelf shelf(edge);
  put(shelf, 40, 1, 9);
  put(shelf, 0, 1, 8);
  put(shelf, 41, 1, 9);
  CHECK(next(shelf) == 40);
  CHECK(next(shelf) == 41);
  CHECK(state_of(shelf).refused == 1);
}

TEST_CASE("an edge of the latest keeps one message") {
  auto edge = edge_of();
  edge.lossless = false;
  Shelf shelf(edge);
  for (const std::uint64_t k : {3, 4, 9, 8}) put(shelf, k);
  CHECK(next(shelf) == 9);
  CHECK(next(shelf) == -1);
  CHECK(state_of(shelf).gaps == 4);
  CHECK(state_of(shelf).queued_bytes == 0);
}

TEST_CASE("a full shelf leaves the rest with the library and says when there is room again") {
  auto edge = edge_of();
  edge.queue_bytes = 3 * (100 + Ledger::kOverhead);
  Shelf shelf(edge);
  std::uint64_t count = 0;
  while (shelf.room(kFar)) put(shelf, count++, 1, 7, 100);
  CHECK(count == 4);
  CHECK_FALSE(shelf.claim_left()[kFar]);
  CHECK(next(shelf) == 0);
  CHECK(shelf.claim_left()[kFar]);
  CHECK_FALSE(shelf.claim_left()[kFar]);
}
