#pragma once

#include <bodeflow/error.hpp>
#include <bodeflow/record_layout.hpp>
#include <complex>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace bodeflow {

/// One attribute of a record; borrows from the record's bytes.
class AttributeView {
 public:
  /// Entry `index` of a record's attribute table.
  static AttributeView of(const std::uint8_t* bytes, std::uint32_t index) {
    RecordHeader h;
    std::memcpy(&h, bytes, sizeof h);
    AttributeView view;
    view.bytes_ = bytes;
    std::memcpy(&view.entry_, bytes + h.attributes + index * sizeof view.entry_, sizeof view.entry_);
    return view;
  }

  std::string_view name() const { return {at(entry_.name.offset), entry_.name.length}; }
  AttributeKind kind() const { return static_cast<AttributeKind>(entry_.kind); }
  bool is_list() const { return entry_.list != 0; }
  /// How many values: 1 unless it is a list.
  std::size_t size() const { return static_cast<std::size_t>(entry_.count); }

  /// Value i < size(), of the kind that `kind()` tells.
  bool boolean(std::size_t i = 0) const { return load<std::int64_t>(i) != 0; }
  std::int64_t integer(std::size_t i = 0) const { return load<std::int64_t>(i); }
  /// Kind number, or an integer converted.
  double number(std::size_t i = 0) const {
    return kind() == AttributeKind::integer ? static_cast<double>(integer(i)) : load<double>(i);
  }
  std::string_view text(std::size_t i = 0) const {
    const auto place = load<RecordText>(i);
    return {at(place.offset), place.length};
  }

 private:
  const char* at(std::uint64_t offset) const { return reinterpret_cast<const char*>(bytes_ + offset); }
  template <class T>
  T load(std::size_t i) const {
    T value;
    std::memcpy(&value, bytes_ + entry_.values + i * sizeof(T), sizeof(T));
    return value;
  }

  const std::uint8_t* bytes_ = nullptr;
  RecordAttribute entry_{};
};

/// One array of a record; borrows from the record's bytes.
struct ArrayView {
  std::string_view name;
  std::string_view unit;
  std::uint32_t element = BF_F64;
  std::span<const std::uint64_t> shape;  ///< row-major, the last index runs fastest
  const void* data = nullptr;            ///< 64-byte aligned
  std::size_t size = 0;                  ///< elements in all

  /// Entry `index` of a record's array table.
  static ArrayView of(const std::uint8_t* bytes, std::uint32_t index) {
    RecordHeader h;
    std::memcpy(&h, bytes, sizeof h);
    RecordArray entry;
    const std::uint8_t* place = bytes + h.arrays + index * sizeof entry;
    std::memcpy(&entry, place, sizeof entry);
    ArrayView view;
    view.name = {reinterpret_cast<const char*>(bytes + entry.name.offset), entry.name.length};
    view.unit = {reinterpret_cast<const char*>(bytes + entry.unit.offset), entry.unit.length};
    view.element = entry.element;
    view.shape = {reinterpret_cast<const std::uint64_t*>(place + offsetof(RecordArray, shape)), entry.rank};
    view.data = bytes + entry.data;
    view.size = static_cast<std::size_t>(entry.bytes / element_size(entry.element));
    return view;
  }

  /// The values as double, std::complex<double>, std::int64_t or std::uint8_t. Throws Failure if the array holds another type.
  template <class T>
  std::span<const T> as() const {
    static_assert(kElementOf<T> != BF_ANY, "arrays hold double, std::complex<double>, std::int64_t or std::uint8_t");
    if (element != kElementOf<T>) {
      fail("array '" + std::string(name) + "' holds " + element_name(element) + ", not " + element_name(kElementOf<T>));
    }
    return {static_cast<const T*>(data), size};
  }
};

/// A table of a record as a range: `for (auto a : record.attributes())`.
template <class View>
class RecordRange {
 public:
  class Iterator {
   public:
    Iterator(const std::uint8_t* bytes, std::uint32_t index) : bytes_(bytes), index_(index) {}
    View operator*() const { return View::of(bytes_, index_); }
    Iterator& operator++() { return ++index_, *this; }
    bool operator!=(const Iterator& other) const { return index_ != other.index_; }
    bool operator==(const Iterator& other) const { return index_ == other.index_; }

   private:
    const std::uint8_t* bytes_;
    std::uint32_t index_;
  };

  RecordRange(const std::uint8_t* bytes, std::uint32_t count) : bytes_(bytes), count_(count) {}
  Iterator begin() const { return {bytes_, 0}; }
  Iterator end() const { return {bytes_, count_}; }
  std::size_t size() const { return count_; }
  View operator[](std::uint32_t index) const { return *Iterator{bytes_, index}; }

 private:
  const std::uint8_t* bytes_;
  std::uint32_t count_;
};

/// A record to read; borrows its bytes, costs nothing to copy. What it hands out lives as long as the record.
class RecordView {
 public:
  /// Of bytes that this program's builder or host made. Foreign bytes go through `check`.
  explicit RecordView(const std::uint8_t* bytes) : bytes_(bytes) {}
  explicit RecordView(const bf_record& record) : bytes_(record.bytes) {}

  /// The record in `bytes`, or what is wrong with them: everything that the layout promises is checked, so that no use of
  /// the view can leave the bytes, whatever they hold. `bytes` begin at a 64-byte boundary and have the record's size.
  static Expected<RecordView, Error> check(std::span<const std::uint8_t> bytes);

  std::string_view type() const { return text_at(header().type); }
  std::span<const std::uint8_t> bytes() const { return {bytes_, static_cast<std::size_t>(header().size)}; }

  RecordRange<AttributeView> attributes() const { return {bytes_, header().attribute_count}; }
  RecordRange<ArrayView> arrays() const { return {bytes_, header().array_count}; }

  std::optional<AttributeView> attribute(std::string_view name) const {
    for (const AttributeView& a : attributes()) {
      if (a.name() == name) return a;
    }
    return std::nullopt;
  }
  std::optional<ArrayView> array(std::string_view name) const {
    for (const ArrayView& a : arrays()) {
      if (a.name == name) return a;
    }
    return std::nullopt;
  }

  /// The attribute of that name if it is of that kind (integers count as numbers too), else nothing.
  std::optional<bool> boolean(std::string_view name) const {
    if (const auto a = scalar(name, AttributeKind::boolean)) return a->boolean();
    return std::nullopt;
  }
  std::optional<std::int64_t> integer(std::string_view name) const {
    if (const auto a = scalar(name, AttributeKind::integer)) return a->integer();
    return std::nullopt;
  }
  std::optional<double> number(std::string_view name) const {
    if (const auto a = scalar(name, AttributeKind::number)) return a->number();
    if (const auto a = scalar(name, AttributeKind::integer)) return a->number();
    return std::nullopt;
  }
  std::optional<std::string_view> text(std::string_view name) const {
    if (const auto a = scalar(name, AttributeKind::text)) return a->text();
    return std::nullopt;
  }
  std::optional<std::vector<bool>> booleans(std::string_view name) const {
    return list<bool>(name, AttributeKind::boolean, [](const AttributeView& a, std::size_t i) { return a.boolean(i); });
  }
  std::optional<std::vector<std::int64_t>> integers(std::string_view name) const {
    return list<std::int64_t>(name, AttributeKind::integer, [](const AttributeView& a, std::size_t i) { return a.integer(i); });
  }
  std::optional<std::vector<double>> numbers(std::string_view name) const {
    const auto get = [](const AttributeView& a, std::size_t i) { return a.number(i); };
    auto values = list<double>(name, AttributeKind::number, get);
    return values ? values : list<double>(name, AttributeKind::integer, get);
  }
  std::optional<std::vector<std::string_view>> texts(std::string_view name) const {
    return list<std::string_view>(name, AttributeKind::text, [](const AttributeView& a, std::size_t i) { return a.text(i); });
  }

 private:
  RecordHeader header() const {
    RecordHeader h;
    std::memcpy(&h, bytes_, sizeof h);
    return h;
  }
  std::string_view text_at(const RecordText& place) const {
    return {reinterpret_cast<const char*>(bytes_ + place.offset), place.length};
  }
  std::optional<AttributeView> scalar(std::string_view name, AttributeKind kind) const {
    const auto a = attribute(name);
    return a && a->kind() == kind && !a->is_list() ? a : std::nullopt;
  }
  template <class T, class Get>
  std::optional<std::vector<T>> list(std::string_view name, AttributeKind kind, Get get) const {
    const auto a = attribute(name);
    if (!a || a->kind() != kind || !a->is_list()) return std::nullopt;
    std::vector<T> values;
    values.reserve(a->size());
    for (std::size_t i = 0; i < a->size(); ++i) values.push_back(get(*a, i));
    return values;
  }

  const std::uint8_t* bytes_;
};

}  // namespace bodeflow
