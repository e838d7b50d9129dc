#include <bodeflow/record.hpp>
#include <limits>
#include <random>

#include "aligned_bytes.hpp"
#include "catch.hpp"
#include "read_all.hpp"

using namespace bodeflow;

namespace {

RecordBuilder full_record() {
  RecordBuilder r("frequency_response");
  r.set("form", "known_input")
      .set("periods", 7)
      .set("offset", -0.0)
      .set("accepted", true)
      .set("note", "Größe \u03A9")
      .set("empty", "");
  r.set("numbers", std::vector<double>{1.5, -2.5, std::numeric_limits<double>::quiet_NaN()});
  r.set("integers", {std::int64_t{-1}, std::numeric_limits<std::int64_t>::min()});
  r.set("names", std::vector<std::string>{"a", "", "bc"});
  r.set("flags", std::vector<bool>{true, false, true});
  r.set("nothing", std::vector<double>{});
  auto response = r.array<std::complex<double>>("response", "rad/A", {5, 2, 1});
  for (std::size_t i = 0; i < response.size(); ++i) response[i] = {static_cast<double>(i), -1.0};
  r.array<double>("scalar", "Hz", std::initializer_list<std::uint64_t>{})[0] = 42.0;
  auto bytes = r.array<std::uint8_t>("bytes", "", {3});
  bytes[2] = 255;
  r.array<std::int64_t>("counts", "1", {2})[1] = -7;
  r.array<double>("none", "V", {0, 4});
  return r;
}

}  // namespace

TEST_CASE("a record reads back as it was written") {
  const AlignedBytes bytes(full_record().bytes());
  const auto record = RecordView::check(bytes.span());
  REQUIRE(record);
  CHECK(record->type() == "frequency_response");
  CHECK(record->text("form") == "known_input");
  CHECK(record->text("note") == "Größe \u03A9");
  CHECK(record->text("empty") == "");
  CHECK(record->integer("periods") == 7);
  CHECK(record->number("periods") == 7.0);
  CHECK(std::signbit(record->number("offset").value()));
  CHECK(record->boolean("accepted") == true);
  CHECK(std::isnan(record->numbers("numbers")->at(2)));
  CHECK(record->integers("integers") == std::vector<std::int64_t>{-1, std::numeric_limits<std::int64_t>::min()});
  CHECK(record->numbers("integers")->at(0) == -1.0);
  CHECK(record->texts("names") == std::vector<std::string_view>{"a", "", "bc"});
  CHECK(record->booleans("flags") == std::vector<bool>{true, false, true});
  CHECK(record->numbers("nothing")->empty());
  CHECK(record->attributes().size() == 11);
  CHECK(record->arrays().size() == 5);
}

TEST_CASE("arrays of a record keep shape, unit, type and alignment") {
  const AlignedBytes bytes(full_record().bytes());
  const RecordView record = *RecordView::check(bytes.span());
  const auto response = record.array("response").value();
  CHECK(response.unit == "rad/A");
  CHECK(response.element == BF_C64);
  CHECK(std::vector<std::uint64_t>(response.shape.begin(), response.shape.end()) == std::vector<std::uint64_t>{5, 2, 1});
  CHECK(response.as<std::complex<double>>()[9] == std::complex<double>(9.0, -1.0));
  CHECK(record.array("scalar")->as<double>().size() == 1);
  CHECK(record.array("scalar")->shape.empty());
  CHECK(record.array("none")->as<double>().empty());
  CHECK(record.array("counts")->as<std::int64_t>()[1] == -7);
  CHECK(record.array("bytes")->as<std::uint8_t>()[2] == 255);
  for (const ArrayView& a : record.arrays()) CHECK(reinterpret_cast<std::uintptr_t>(a.data) % 64 == 0);
  CHECK_THROWS_WITH(response.as<double>(), "array 'response' holds c64, not f64");
}

TEST_CASE("what a record lacks, or holds as another type, is nothing") {
  const AlignedBytes bytes(full_record().bytes());
  const RecordView record = *RecordView::check(bytes.span());
  CHECK_FALSE(record.text("missing"));
  CHECK_FALSE(record.integer("offset"));
  CHECK_FALSE(record.boolean("periods"));
  CHECK_FALSE(record.number("numbers"));
  CHECK_FALSE(record.numbers("offset"));
  CHECK_FALSE(record.array("form"));
}

TEST_CASE("equal content gives equal bytes, with zeros in every gap") {
  const auto first = full_record().bytes();
  CHECK(first == full_record().bytes());
  CHECK(first.size() % 64 == 0);
  std::vector<std::uint8_t> dirty(first.size() + 64, 0xEE);
  void* place = dirty.data();
  std::size_t room = dirty.size();
  REQUIRE(std::align(64, first.size(), place, room) != nullptr);
  full_record().write(place);
  CHECK(std::memcmp(place, first.data(), first.size()) == 0);
}

TEST_CASE("a builder refuses what a record can't hold") {
  RecordBuilder r("x");
  CHECK_THROWS_WITH(RecordBuilder(""), "record: type is empty");
  CHECK_THROWS_WITH(r.set("", 1), "record: attribute name is empty");
  CHECK_THROWS_WITH(r.set(std::string(256, 'a'), 1), "record: attribute name is longer than 255 bytes");
  CHECK_THROWS_WITH(r.set("bad", "\xC0\x80"), "record: attribute 'bad' is not UTF-8 text");
  CHECK_THROWS_WITH(r.set("big", std::numeric_limits<std::uint64_t>::max()),
                    "record: attribute 'big': 18446744073709551615 is beyond int64");
  CHECK_THROWS_WITH(r.array<double>("a", "", {1, 1, 1, 1, 1, 1, 1, 1, 1}), "record: array 'a': rank 9 is above 8");
  CHECK_THROWS_WITH(r.array<double>("a", "", {std::uint64_t{1} << 62, 0, 8}), "record: array 'a': shape overflows");
  r.array<double>("a", "", {1});
  CHECK_THROWS_WITH(r.array<double>("a", "", {1}), "record: array 'a' stands twice");
  r.set("n", 1).set("n", "two");
  CHECK(RecordView::check(AlignedBytes(r.bytes()).span()));
}

TEST_CASE("foreign bytes are refused with what is wrong with them") {
  const auto good = full_record().bytes();
  RecordHeader header;
  std::memcpy(&header, good.data(), sizeof header);
  const auto refusal = [&](auto change) {
    AlignedBytes bytes(good);
    change(bytes.data());
    const auto checked = RecordView::check(bytes.span());
    return checked ? std::string("accepted") : checked.error().text;
  };
  const auto put = [](std::uint8_t* at, auto value) { std::memcpy(at, &value, sizeof value); };
  const std::size_t attribute = header.attributes, array = header.arrays;
  using A = RecordAttribute;
  using R = RecordArray;
  CHECK(refusal([](std::uint8_t*) {}) == "accepted");
  CHECK(refusal([&](std::uint8_t* b) { b[0] = 'X'; }) == "record: no magic 'BFR1' at its start");
  CHECK(refusal([&](std::uint8_t* b) { put(b + 4, std::uint32_t{2}); }) == "record: version 2; known: 1");
  CHECK(refusal([&](std::uint8_t* b) { put(b + 8, std::uint64_t{64}); }) ==
        "record: states a size of 64 bytes, has " + std::to_string(good.size()));
  CHECK(refusal([&](std::uint8_t* b) { put(b + 16, std::uint32_t{0xFFFFFFFF}); }) == "record: attribute table leaves the record");
  CHECK(refusal([&](std::uint8_t* b) { put(b + 24, ~std::uint64_t{7}); }) == "record: attribute table leaves the record");
  CHECK(refusal([&](std::uint8_t* b) { put(b + 32, header.arrays + 4); }) == "record: array table is not aligned to 8 bytes");
  CHECK(refusal([&](std::uint8_t* b) { put(b + attribute + offsetof(A, kind), std::uint32_t{9}); }) ==
        "record: attribute 'form': kind 9 is unknown");
  CHECK(refusal([&](std::uint8_t* b) { put(b + attribute + offsetof(A, count), ~std::uint64_t{0}); }) ==
        "record: attribute 'form': a single value has a count of 18446744073709551615");
  CHECK(refusal([&](std::uint8_t* b) { put(b + attribute + 6 * sizeof(A) + offsetof(A, count), ~std::uint64_t{0}); }) ==
        "record: attribute 'numbers': values leave the record");
  CHECK(refusal([&](std::uint8_t* b) { std::memcpy(b + attribute + sizeof(A), b + attribute, sizeof(RecordText)); }) ==
        "record: attribute 'form' stands twice");
  CHECK(refusal([&](std::uint8_t* b) { put(b + array + offsetof(R, rank), std::uint32_t{9}); }) ==
        "record: array 'response': rank 9 is above 8");
  CHECK(refusal([&](std::uint8_t* b) { put(b + array + offsetof(R, element), std::uint32_t{0}); }) ==
        "record: array 'response': element type 0 is unknown");
  CHECK(refusal([&](std::uint8_t* b) { put(b + array + offsetof(R, shape), std::uint64_t{1} << 60); }) ==
        "record: array 'response': shape overflows");
  CHECK(refusal([&](std::uint8_t* b) { put(b + array + offsetof(R, shape), std::uint64_t{6}); }) ==
        "record: array 'response': shape needs 192 bytes, states 160");
  CHECK(refusal([&](std::uint8_t* b) { put(b + array + offsetof(R, data), std::uint64_t{good.size()} - 64); }) ==
        "record: array data leaves the record");
  CHECK(refusal([&](std::uint8_t* b) { b[header.type.offset + header.type.length] = 'x'; }) ==
        "record: type does not end with NUL");
  CHECK(refusal([&](std::uint8_t* b) { b[header.type.offset] = 0xFF; }) == "record: type is not UTF-8 text");
}

TEST_CASE("parts that share bytes are refused: a small record can't expand without bound") {
  RecordBuilder r("x");
  r.set("a", std::string(1000, 'a')).set("b", "b").set("c", "c");
  AlignedBytes bytes(r.bytes());
  RecordHeader header;
  std::memcpy(&header, bytes.data(), sizeof header);
  for (std::size_t i = 1; i < 3; ++i) {  // all three share the value of the first
    std::memcpy(bytes.data() + header.attributes + i * sizeof(RecordAttribute) + offsetof(RecordAttribute, values),
                bytes.data() + header.attributes + offsetof(RecordAttribute, values), 8);
  }
  const auto checked = RecordView::check(bytes.span());
  REQUIRE_FALSE(checked);
  CHECK(checked.error().text == "record: parts share bytes");
}

TEST_CASE("bytes that begin elsewhere than at a 64-byte boundary are refused") {
  std::vector<std::uint8_t> padded(8, 0);
  const auto good = full_record().bytes();
  padded.insert(padded.end(), good.begin(), good.end());
  const AlignedBytes bytes(padded);
  const auto checked = RecordView::check(bytes.span().subspan(8));
  REQUIRE_FALSE(checked);
  CHECK(checked.error().text == "record: bytes do not begin at a 64-byte boundary");
}

TEST_CASE("no truncation of a record is accepted or read beyond") {
  const auto good = full_record().bytes();
  for (std::size_t size = 0; size < good.size(); ++size) {
    const AlignedBytes bytes(good.data(), size);
    CHECK_FALSE(RecordView::check(bytes.span()));
  }
}

TEST_CASE("a record with any byte changed is refused, or can be read whole within its bytes") {
  const auto good = full_record().bytes();
  std::size_t refused = 0;
  for (std::size_t at = 0; at < good.size(); ++at) {
    for (const int flip : {0x01, 0x80, 0xFF}) {
      AlignedBytes bytes(good);
      bytes.data()[at] = static_cast<std::uint8_t>(bytes.data()[at] ^ flip);
      const auto checked = RecordView::check(bytes.span());
      if (!checked) {
        ++refused;
      } else {
        read_all(*checked);
      }
    }
  }
  CHECK(refused > 500);
}

TEST_CASE("a record with many bytes changed never leads a reader astray") {
  std::mt19937_64 random(1);
  const auto good = full_record().bytes();
  for (int trial = 0; trial < 20000; ++trial) {
    AlignedBytes bytes(good);
    const std::size_t tables = 1500;  // the part with offsets, counts and lengths
    for (int k = 0; k < 1 + trial % 8; ++k) bytes.data()[random() % tables] = static_cast<std::uint8_t>(random());
    if (const auto checked = RecordView::check(bytes.span())) read_all(*checked);
  }
}

TEST_CASE("UTF-8 is told from what is none") {
  for (const char* good : {"", "a", "\xC2\x80", "\xE0\xA0\x80", "\xED\x9F\xBF", "\xF0\x90\x80\x80", "\xF4\x8F\xBF\xBF"})
    CHECK(is_text(good));
  for (const char* bad : {"\x80", "\xC0\x80", "\xC1\xBF", "\xC2", "\xE0\x9F\xBF", "\xED\xA0\x80", "\xF0\x8F\xBF\xBF",
                          "\xF4\x90\x80\x80", "\xF5\x80\x80\x80", "\xE2\x82"}) {
    CHECK_FALSE(is_text(bad));
  }
  CHECK_FALSE(is_text(std::string_view("a\0b", 3)));
}
