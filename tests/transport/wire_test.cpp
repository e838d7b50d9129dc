// Messages as bytes: valid XCDR1, and a decoder that believes nothing.
#include "transport/wire.hpp"

#include <bodeflow/abi.h>

#include <cstring>

#include "catch.hpp"
#include "transport/credit.hpp"

using namespace bodeflow::transport;

namespace {

Header header_of_samples() {
  Header header;
  header.kind = Kind::samples;
  header.stream = 0x1122334455667788;
  header.epoch = 7;
  header.sequence = 41;
  header.position = 4096;
  header.count = 2;
  header.rate_num = 10000;
  header.rate_den = 3;
  header.channels = 2;
  header.element = BF_F64;
  header.source_ns = 1234567890123456789;
  header.clock = "inverter";
  return header;
}

std::vector<std::byte> some_bytes(std::size_t size) {
  std::vector<std::byte> bytes(size);
  for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<std::byte>(i * 37 + 5);
  return bytes;
}

std::vector<std::byte> whole(const Header& header, std::size_t payload) {
  const auto bytes = some_bytes(payload);
  const std::span<const std::byte> parts[] = {std::span(bytes).first(payload / 2), std::span(bytes).subspan(payload / 2)};
  return encode(header, parts);
}

template <typename T>
std::vector<std::byte> with(std::vector<std::byte> bytes, std::size_t at, T value) {
  std::memcpy(bytes.data() + at, &value, sizeof value);
  return bytes;
}

std::string error_of(const std::vector<std::byte>& bytes) {
  const auto decoded = decode(bytes);
  return decoded ? "accepted" : decoded.error();
}

}  // namespace

TEST_CASE("a message comes back from its bytes as it was") {
  const auto sent = header_of_samples();
  const auto bytes = whole(sent, 32);
  const auto got = decode(bytes);
  REQUIRE(got);
  CHECK(got->header.kind == sent.kind);
  CHECK(got->header.stream == sent.stream);
  CHECK(got->header.epoch == sent.epoch);
  CHECK(got->header.sequence == sent.sequence);
  CHECK(got->header.position == sent.position);
  CHECK(got->header.count == sent.count);
  CHECK(got->header.rate_num == sent.rate_num);
  CHECK(got->header.rate_den == sent.rate_den);
  CHECK(got->header.channels == sent.channels);
  CHECK(got->header.element == sent.element);
  CHECK(got->header.source_ns == sent.source_ns);
  CHECK(got->header.clock == sent.clock);
  const auto payload = some_bytes(32);
  CHECK(std::equal(payload.begin(), payload.end(), got->payload.begin(), got->payload.end()));
}

TEST_CASE("the bytes of a message lie where CDR puts the members of the published struct") {
  const auto bytes = whole(header_of_samples(), 32);
  CHECK(std::memcmp(bytes.data(), "\0\1\0\0BWFL\1\0\1\1", 12) == 0);
  std::uint64_t stream = 0;
  std::memcpy(&stream, bytes.data() + 12, 8);  // 8 bytes after the encapsulation: aligned
  CHECK(stream == 0x1122334455667788);
  std::uint32_t clock = 0, payload = 0;
  std::memcpy(&clock, bytes.data() + 4 + 72, 4);
  CHECK(clock == 9);                                     // with its zero
  std::memcpy(&payload, bytes.data() + 4 + 76 + 12, 4);  // 9 bytes of text, 3 to the next multiple of four
  CHECK(payload == 32);
  CHECK(bytes.size() == 4 + 76 + 12 + 4 + 32);
}

TEST_CASE("a message that is cut short anywhere is refused") {
  const auto bytes = whole(header_of_samples(), 32);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const std::vector<std::byte> cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    INFO(size);
    CHECK(error_of(cut) != "accepted");
  }
}

TEST_CASE("what contradicts itself in a message is refused by name") {
  const auto good = whole(header_of_samples(), 32);
  CHECK(error_of(with(good, 1, std::uint8_t{0})) == "not plain CDR, little-endian");
  CHECK(error_of(with(good, 4, std::uint32_t{1})) == "not a message of bodeflow");
  CHECK(error_of(with(good, 8, std::uint16_t{2})) == "version 2 of the format (known: 1)");
  CHECK(error_of(with(good, 10, std::uint8_t{9})) == "unknown kind 9");
  CHECK(error_of(with(good, 11, std::uint8_t{3})) == "unknown element type 3 (allowed: 1, 2)");
  CHECK(error_of(with(good, 24, std::uint32_t{0})) == "0 channels");
  CHECK(error_of(with(good, 24, std::uint32_t{0xFFFFFFFF})) == "4294967295 channels");
  CHECK(error_of(with(good, 36, std::int64_t{0x7FFFFFFFFFFFFFFF})) == "a position beyond the last");
  CHECK(error_of(with(good, 44, std::uint64_t{3})) == "3 samples of 2 channels do not fill 32 bytes");
  CHECK(error_of(with(good, 44, std::uint64_t{0x2000000000000002})) ==
        "2305843009213693954 samples of 2 channels do not fill 32 bytes");  // 2^61 + 2: times 16 is 32 in 64 bits
  CHECK(error_of(with(good, 52, std::int64_t{0})) == "a sample rate that is not positive");
  CHECK(error_of(with(good, 60, std::int64_t{0})) == "a rate that is not a fraction of positive numbers");
  CHECK(error_of(with(good, 76, std::uint32_t{0xFFFFFFFF})) == "a clock's name that is no string of at most 255 bytes");
  CHECK(error_of(with(good, 82, std::uint8_t{0})) == "a clock's name that is no string of at most 255 bytes");
  CHECK(error_of(with(good, 92, std::uint32_t{0xFFFFFFFF})) == "a payload of 4294967295 bytes (allowed: 67108864)");
  CHECK(error_of(with(good, 92, std::uint32_t{16})) == "a payload of 16 bytes in 32");
  CHECK(error_of(good) == "accepted");
}

TEST_CASE("kinds without samples and kinds without payload are held to it") {
  Header header;
  header.kind = Kind::record;
  CHECK(error_of(whole(header, 64)) == "accepted");
  header.channels = 1;
  CHECK(error_of(whole(header, 64)) == "a message without samples names samples");
  header.channels = 0;
  header.kind = Kind::end;
  CHECK(error_of(whole(header, 0)) == "accepted");
  CHECK(error_of(whole(header, 8)) == "a message of a kind without payload has one");
}

TEST_CASE("a credit comes back from its bytes and is refused when it is cut short") {
  Credit sent;
  sent.stream = 5;
  sent.inlet = 6;
  sent.epoch = 7;
  for (std::size_t i = 0; i < 16; ++i) sent.reader[i] = static_cast<std::uint8_t>(i);
  sent.taken = 99;
  const auto bytes = encode(sent);
  const auto got = decode_credit(bytes);
  REQUIRE(got);
  CHECK(got->stream == 5);
  CHECK(got->inlet == 6);
  CHECK(got->epoch == 7);
  CHECK(got->reader == sent.reader);
  CHECK(got->taken == 99);
  for (std::size_t size = 0; size < bytes.size(); ++size) CHECK_FALSE(decode_credit(std::span(bytes).first(size)));
}
