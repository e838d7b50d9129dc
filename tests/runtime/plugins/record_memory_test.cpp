#include "plugins/record_memory.hpp"

#include <cstring>
#include <limits>
#include <thread>
#include <vector>

#include "catch.hpp"
#include "plugins/instance.hpp"

using namespace bodeflow;

TEST_CASE("a record is zeroed, aligned to 64 bytes and as large as asked for") {
  for (const std::uint64_t size : {0U, 1U, 63U, 64U, 65U, 100000U}) {
    bf_record* record = record_create(size);
    REQUIRE(record != nullptr);
    CHECK(reinterpret_cast<std::uintptr_t>(record->bytes) % 64 == 0);
    CHECK(record->size == size);
    CHECK(std::all_of(record->bytes, record->bytes + size, [](std::uint8_t b) { return b == 0; }));
    std::memset(record->bytes, 0xAB, size);
    record_release(record);
  }
}

TEST_CASE("a record that no memory can hold is not made") {
  CHECK(record_create(std::numeric_limits<std::uint64_t>::max()) == nullptr);
  CHECK(record_create(std::uint64_t{1} << 46U) == nullptr);
}

TEST_CASE("a shared record keeps its bytes until the last owner goes") {
  SharedRecord kept;
  CHECK_FALSE(kept);
  CHECK(kept.size() == 0);
  {
    const SharedRecord first = SharedRecord::copy("0123456789", 10);
    const SharedRecord second = first;
    SharedRecord moved = second;
    kept = std::move(moved);
    CHECK_FALSE(moved);
    CHECK(kept.c() == first.c());
  }
  REQUIRE(kept.size() == 10);
  CHECK(std::memcmp(kept.bytes(), "0123456789", 10) == 0);
  kept = kept;
  CHECK(std::memcmp(kept.bytes(), "0123456789", 10) == 0);
}

TEST_CASE("a size that a plugin wrote beyond its record is not believed") {
  bf_record* record = record_create(16);
  record->size = 1U << 30U;
  CHECK(SharedRecord::adopt(record).size() == 16);
}

TEST_CASE("records are counted right when many threads share them") {
  const SharedRecord shared = SharedRecord::copy("abc", 3);
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&shared] {
      for (int i = 0; i < 20000; ++i) {
        const SharedRecord a = shared;
        SharedRecord b = a;
        b = SharedRecord::copy("x", 1);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  CHECK(std::memcmp(shared.bytes(), "abc", 3) == 0);
}
