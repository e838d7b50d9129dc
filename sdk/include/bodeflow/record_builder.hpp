#pragma once

#include <bodeflow/error.hpp>
#include <bodeflow/record_layout.hpp>
#include <bodeflow/utf8.hpp>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace bodeflow {

/// Collects the parts of a record and writes its bytes. Equal content set in equal order gives equal bytes.
class RecordBuilder {
 public:
  explicit RecordBuilder(std::string_view type) : type_(checked_name(type, "type")) {}

  /// Sets an attribute: bool, an integer, a floating-point number, text, or a vector, span or list of one of these.
  /// An attribute that exists is replaced. Throws Failure for a bad name or text, or an integer beyond int64.
  template <class T>
  RecordBuilder& set(std::string_view name, const T& value) {
    Attribute a;
    a.name = checked_name(name, "attribute name");
    if constexpr (is_single<T>) {
      a.kind = kind_of<T>();
      append(a, value);
    } else {
      using V = std::decay_t<decltype(*std::begin(value))>;
      a.list = true;
      a.kind = kind_of<V>();
      for (const auto& v : value) append(a, static_cast<const V&>(v));
    }
    return put(std::move(a));
  }
  template <class T>
  RecordBuilder& set(std::string_view name, std::initializer_list<T> values) {
    return set(name, std::span<const T>(values.begin(), values.size()));
  }
  RecordBuilder& set(std::string_view name, const std::vector<bool>& values) {
    Attribute a;
    a.name = checked_name(name, "attribute name");
    a.list = true;
    a.kind = AttributeKind::boolean;
    for (const bool v : values) append(a, v);
    return put(std::move(a));
  }

  /// Adds an array of zeros; the span to fill is valid until the next `array`. T: double, std::complex<double>,
  /// std::int64_t, std::uint8_t. Throws Failure for a name that exists, a bad unit, a rank above 8 or a shape beyond memory.
  template <class T>
  std::span<T> array(std::string_view name, std::string_view unit, std::span<const std::uint64_t> shape) {
    static_assert(kElementOf<T> != BF_ANY, "arrays hold double, std::complex<double>, std::int64_t or std::uint8_t");
    Array& a = add_array(name, unit, kElementOf<T>, shape);
    return {reinterpret_cast<T*>(a.data.data()), static_cast<std::size_t>(a.bytes / sizeof(T))};
  }
  template <class T>
  std::span<T> array(std::string_view name, std::string_view unit, std::initializer_list<std::uint64_t> shape) {
    return array<T>(name, unit, std::span<const std::uint64_t>(shape.begin(), shape.size()));
  }

  /// Bytes of the finished record: a multiple of 64.
  std::uint64_t size() const { return layout().size; }

  /// Writes `size()` bytes to `destination`, which begins at a 64-byte boundary.
  void write(void* destination) const {
    auto* out = static_cast<std::uint8_t*>(destination);
    const Layout places = layout();
    std::memset(out, 0, static_cast<std::size_t>(places.size));
    RecordHeader h{};
    std::memcpy(h.magic, kRecordMagic, sizeof h.magic);
    h.version = kRecordVersion;
    h.size = places.size;
    h.attribute_count = static_cast<std::uint32_t>(attributes_.size());
    h.array_count = static_cast<std::uint32_t>(arrays_.size());
    h.attributes = places.attributes;
    h.arrays = places.arrays;
    std::uint64_t values = places.values, texts = places.texts, data = places.data;
    h.type = put_text(out, texts, type_);
    std::memcpy(out, &h, sizeof h);
    for (std::size_t i = 0; i < attributes_.size(); ++i) {
      const RecordAttribute entry = put_attribute(out, values, texts, attributes_[i]);
      std::memcpy(out + places.attributes + i * sizeof entry, &entry, sizeof entry);
    }
    for (std::size_t i = 0; i < arrays_.size(); ++i) {
      const RecordArray entry = put_array(out, texts, data, arrays_[i]);
      std::memcpy(out + places.arrays + i * sizeof entry, &entry, sizeof entry);
    }
  }

  /// The finished record in a vector, whose own alignment is whatever the allocator gave: to be copied to a 64-byte boundary.
  std::vector<std::uint8_t> bytes() const {
    std::vector<std::uint8_t> out(static_cast<std::size_t>(size()));
    write(out.data());
    return out;
  }

  const std::string& type() const { return type_; }

 private:
  struct Attribute {
    std::string name;
    AttributeKind kind = AttributeKind::boolean;
    bool list = false;
    std::vector<std::uint64_t> words;  ///< values of 8 bytes
    std::vector<std::string> texts;
  };
  struct Array {
    std::string name, unit;
    std::uint32_t element = BF_F64;
    std::vector<std::uint64_t> shape;
    std::uint64_t bytes = 0;
    std::vector<std::uint64_t> data;  ///< words, so that every element type is aligned
  };
  struct Layout {
    std::uint64_t attributes, arrays, values, texts, data, size;
  };

  template <class T>
  static constexpr bool is_single = std::is_arithmetic_v<T> || std::is_convertible_v<const T&, std::string_view>;

  template <class T>
  static constexpr AttributeKind kind_of() {
    static_assert(is_single<T>, "attributes are bool, integers, numbers or texts, or lists of these");
    if constexpr (std::is_same_v<T, bool>) {
      return AttributeKind::boolean;
    } else if constexpr (std::is_integral_v<T>) {
      return AttributeKind::integer;
    } else if constexpr (std::is_floating_point_v<T>) {
      return AttributeKind::number;
    } else {
      return AttributeKind::text;
    }
  }

  template <class T>
  static void append(Attribute& a, const T& value) {
    if constexpr (std::is_integral_v<T>) {
      if constexpr (std::is_unsigned_v<T> && sizeof(T) >= 8) {
        if (value > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max())) {
          fail("record: attribute '" + a.name + "': " + std::to_string(value) + " is beyond int64");
        }
      }
      a.words.push_back(static_cast<std::uint64_t>(static_cast<std::int64_t>(value)));
    } else if constexpr (std::is_floating_point_v<T>) {
      const auto number = static_cast<double>(value);
      std::uint64_t word;
      std::memcpy(&word, &number, sizeof word);
      a.words.push_back(word);
    } else {
      const std::string_view text(value);
      if (!is_text(text)) fail("record: attribute '" + a.name + "' is not UTF-8 text");
      if (text.size() > std::numeric_limits<std::uint32_t>::max()) fail("record: attribute '" + a.name + "' is too long");
      a.texts.emplace_back(text);
    }
  }

  static std::string checked_name(std::string_view name, const char* what) {
    if (name.empty()) fail(std::string("record: ") + what + " is empty");
    if (name.size() > kRecordMaxName) fail(std::string("record: ") + what + " is longer than 255 bytes");
    if (!is_text(name)) fail(std::string("record: ") + what + " is not UTF-8 text");
    return std::string(name);
  }

  RecordBuilder& put(Attribute a) {
    for (Attribute& known : attributes_) {
      if (known.name == a.name) return known = std::move(a), *this;
    }
    attributes_.push_back(std::move(a));
    return *this;
  }

  Array& add_array(std::string_view name, std::string_view unit, std::uint32_t element, std::span<const std::uint64_t> shape) {
    Array a;
    a.name = checked_name(name, "array name");
    for (const Array& known : arrays_) {
      if (known.name == a.name) fail("record: array '" + a.name + "' stands twice");
    }
    if (!unit.empty()) a.unit = checked_name(unit, "array unit");
    if (shape.size() > kRecordMaxRank)
      fail("record: array '" + a.name + "': rank " + std::to_string(shape.size()) + " is above 8");
    a.element = element;
    std::uint64_t bytes = element_size(element);
    bool empty = false;
    for (const std::uint64_t n : shape) {
      if (n > 1 && bytes > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()) / n) {
        fail("record: array '" + a.name + "': shape overflows");
      }
      if (n == 0) empty = true;
      if (n > 1) bytes *= n;
    }
    a.shape.assign(shape.begin(), shape.end());
    a.bytes = empty ? 0 : bytes;
    a.data.assign(static_cast<std::size_t>(align_up(a.bytes, 8) / 8), 0);
    arrays_.push_back(std::move(a));
    return arrays_.back();
  }

  Layout layout() const {
    std::uint64_t values = 0, texts = type_.size() + 1, data = 0;
    for (const Attribute& a : attributes_) {
      values += a.words.size() * 8 + a.texts.size() * sizeof(RecordText);
      texts += a.name.size() + 1;
      for (const std::string& t : a.texts) texts += t.size() + 1;
    }
    for (const Array& a : arrays_) {
      texts += a.name.size() + 1 + a.unit.size() + 1;
      data += align_up(a.bytes, kRecordAlignment);
    }
    Layout places{};
    places.attributes = sizeof(RecordHeader);
    places.arrays = places.attributes + attributes_.size() * sizeof(RecordAttribute);
    places.values = places.arrays + arrays_.size() * sizeof(RecordArray);
    places.texts = places.values + values;
    places.data = align_up(places.texts + texts, kRecordAlignment);
    places.size = places.data + data;
    return places;
  }

  static RecordText put_text(std::uint8_t* out, std::uint64_t& at, const std::string& text) {
    const RecordText place{at, static_cast<std::uint32_t>(text.size()), 0};
    std::memcpy(out + at, text.c_str(), text.size() + 1);
    at += text.size() + 1;
    return place;
  }

  static RecordAttribute put_attribute(std::uint8_t* out, std::uint64_t& values, std::uint64_t& texts, const Attribute& a) {
    RecordAttribute entry{};
    entry.name = put_text(out, texts, a.name);
    entry.kind = static_cast<std::uint32_t>(a.kind);
    entry.list = a.list ? 1 : 0;
    entry.count = a.kind == AttributeKind::text ? a.texts.size() : a.words.size();
    entry.values = values;
    for (const std::uint64_t word : a.words) {
      std::memcpy(out + values, &word, sizeof word);
      values += sizeof word;
    }
    for (const std::string& t : a.texts) {
      const RecordText place = put_text(out, texts, t);
      std::memcpy(out + values, &place, sizeof place);
      values += sizeof place;
    }
    return entry;
  }

  static RecordArray put_array(std::uint8_t* out, std::uint64_t& texts, std::uint64_t& data, const Array& a) {
    RecordArray entry{};
    entry.name = put_text(out, texts, a.name);
    entry.unit = put_text(out, texts, a.unit);
    entry.element = a.element;
    entry.rank = static_cast<std::uint32_t>(a.shape.size());
    for (std::size_t d = 0; d < a.shape.size(); ++d) entry.shape[d] = a.shape[d];
    entry.data = data;
    entry.bytes = a.bytes;
    if (a.bytes != 0) std::memcpy(out + data, a.data.data(), static_cast<std::size_t>(a.bytes));
    data += align_up(a.bytes, kRecordAlignment);
    return entry;
  }

  std::string type_;
  std::vector<Attribute> attributes_;
  std::vector<Array> arrays_;
};

}  // namespace bodeflow
