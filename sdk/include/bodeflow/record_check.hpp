#pragma once

#include <algorithm>
#include <bodeflow/record_view.hpp>
#include <bodeflow/utf8.hpp>

namespace bodeflow {
namespace detail {

/// Walks foreign bytes; every read is bounded before it is made. Throws Failure with the reason.
class RecordChecker {
 public:
  explicit RecordChecker(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  void run() {
    if (reinterpret_cast<std::uintptr_t>(bytes_.data()) % kRecordAlignment != 0)
      fail("record: bytes do not begin at a 64-byte boundary");
    if (bytes_.size() < sizeof(RecordHeader))
      fail("record: " + std::to_string(bytes_.size()) + " bytes are too few for a header");
    const auto h = load<RecordHeader>(0);
    if (std::memcmp(h.magic, kRecordMagic, sizeof h.magic) != 0) fail("record: no magic 'BFR1' at its start");
    if (h.version != kRecordVersion) fail("record: version " + std::to_string(h.version) + "; known: 1");
    if (h.size != bytes_.size()) {
      fail("record: states a size of " + std::to_string(h.size) + " bytes, has " + std::to_string(bytes_.size()));
    }
    if (h.size % kRecordAlignment != 0) fail("record: size is not a multiple of 64");
    take(0, sizeof h, 8, "header");
    zero(h.reserved, "header");
    name(h.type, "type");
    take(h.attributes, std::uint64_t{h.attribute_count} * sizeof(RecordAttribute), 8, "attribute table");
    take(h.arrays, std::uint64_t{h.array_count} * sizeof(RecordArray), 8, "array table");
    for (std::uint32_t i = 0; i < h.attribute_count; ++i)
      attribute(load<RecordAttribute>(h.attributes + i * sizeof(RecordAttribute)));
    unique("attribute");
    for (std::uint32_t i = 0; i < h.array_count; ++i) array(load<RecordArray>(h.arrays + i * sizeof(RecordArray)));
    unique("array");
  }

 private:
  template <class T>
  T load(std::uint64_t offset) const {
    T value;
    std::memcpy(&value, bytes_.data() + offset, sizeof value);
    return value;
  }

  /// Checks that `size` bytes at `offset` lie inside and that all parts together are no more than the record: parts that
  /// share bytes could make a small record expand without bound.
  void take(std::uint64_t offset, std::uint64_t size, std::uint64_t alignment, const char* what) {
    if (offset % alignment != 0)
      fail(std::string("record: ") + what + " is not aligned to " + std::to_string(alignment) + " bytes");
    if (offset > bytes_.size() || size > bytes_.size() - offset) fail(std::string("record: ") + what + " leaves the record");
    if (size > bytes_.size() - taken_) fail("record: parts share bytes");
    taken_ += size;
  }

  static void zero(std::uint64_t reserved, const char* what) {
    if (reserved != 0) fail(std::string("record: reserved field of ") + what + " is not zero");
  }

  std::string_view text(const RecordText& place, const char* what) {
    take(place.offset, std::uint64_t{place.length} + 1, 1, what);
    zero(place.reserved, what);
    if (bytes_[place.offset + place.length] != 0) fail(std::string("record: ") + what + " does not end with NUL");
    const std::string_view found{reinterpret_cast<const char*>(bytes_.data() + place.offset), place.length};
    if (!is_text(found)) fail(std::string("record: ") + what + " is not UTF-8 text");
    return found;
  }

  std::string_view name(const RecordText& place, const char* what) {
    if (place.length == 0) fail(std::string("record: ") + what + " is empty");
    if (place.length > kRecordMaxName) fail(std::string("record: ") + what + " is longer than 255 bytes");
    return text(place, what);
  }

  void attribute(const RecordAttribute& entry) {
    names_.push_back(name(entry.name, "attribute name"));
    zero(entry.reserved, "an attribute");
    if (entry.kind < 1 || entry.kind > 4) fail(in("attribute") + "kind " + std::to_string(entry.kind) + " is unknown");
    if (entry.list > 1) fail(in("attribute") + "list flag is neither 0 nor 1");
    if (entry.list == 0 && entry.count != 1)
      fail(in("attribute") + "a single value has a count of " + std::to_string(entry.count));
    const bool is_texts = entry.kind == static_cast<std::uint32_t>(AttributeKind::text);
    const std::uint64_t each = is_texts ? sizeof(RecordText) : 8;
    if (entry.count > bytes_.size() / each) fail(in("attribute") + "values leave the record");
    take(entry.values, entry.count * each, 8, "attribute value");
    for (std::uint64_t i = 0; i < entry.count; ++i) {
      if (is_texts) text(load<RecordText>(entry.values + i * each), "attribute text");
      if (entry.kind == static_cast<std::uint32_t>(AttributeKind::boolean)) {
        const auto value = load<std::uint64_t>(entry.values + i * each);
        if (value > 1) fail(in("attribute") + "bool is neither 0 nor 1");
      }
    }
  }

  void array(const RecordArray& entry) {
    names_.push_back(name(entry.name, "array name"));
    if (entry.unit.length > kRecordMaxName) fail(in("array") + "unit is longer than 255 bytes");
    text(entry.unit, "array unit");
    zero(entry.reserved, "an array");
    std::uint64_t size = element_size(entry.element);
    if (size == 0) fail(in("array") + "element type " + std::to_string(entry.element) + " is unknown");
    if (entry.rank > kRecordMaxRank) fail(in("array") + "rank " + std::to_string(entry.rank) + " is above 8");
    bool empty = false;
    for (std::uint32_t d = 0; d < kRecordMaxRank; ++d) {
      if (d >= entry.rank) {
        zero(entry.shape[d], "an array's shape");
        continue;
      }
      if (entry.shape[d] == 0) empty = true;
      if (entry.shape[d] > 1 && size > static_cast<std::uint64_t>(INT64_MAX) / entry.shape[d])
        fail(in("array") + "shape overflows");
      size *= std::max<std::uint64_t>(entry.shape[d], 1);
    }
    if (empty) size = 0;
    if (size != entry.bytes) {
      fail(in("array") + "shape needs " + std::to_string(size) + " bytes, states " + std::to_string(entry.bytes));
    }
    take(entry.data, entry.bytes, kRecordAlignment, "array data");
  }

  void unique(const char* what) {
    std::sort(names_.begin(), names_.end());
    const auto twice = std::adjacent_find(names_.begin(), names_.end());
    if (twice != names_.end()) fail(std::string("record: ") + what + " '" + std::string(*twice) + "' stands twice");
    names_.clear();
  }

  std::string in(const char* what) const { return std::string("record: ") + what + " '" + std::string(names_.back()) + "': "; }

  std::span<const std::uint8_t> bytes_;
  std::uint64_t taken_ = 0;
  std::vector<std::string_view> names_;
};

}  // namespace detail

inline Expected<RecordView, Error> RecordView::check(std::span<const std::uint8_t> bytes) {
  try {
    detail::RecordChecker(bytes).run();
  } catch (const Failure& failure) {
    return unexpected(failure.what());
  }
  return RecordView(bytes.data());
}

}  // namespace bodeflow
