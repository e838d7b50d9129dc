#include "mat_variable.hpp"

#include <array>
#include <bit>
#include <cstring>
#include <optional>

#include "printable.hpp"

namespace bodeflow::acquisition {
namespace {

constexpr std::uint32_t kInt8 = 1, kInt32 = 5, kUint32 = 6, kMatrix = 14;
// Classes of arrays, by their codes.
constexpr int kCell = 1, kStruct = 2, kObject = 3, kChar = 4, kSparse = 5, kFirstNumeric = 6, kLastNumeric = 15, kOpaque = 17;
constexpr std::uint32_t kComplexFlag = 0x0800;
// Bounds on what a well-formed file has; beyond them it is damaged.
constexpr std::int64_t kMostDimensions = 64, kLongestName = 4096, kMostFieldBytes = 1 << 20;
constexpr std::size_t kDeepest = 16;

Unexpected<Error> forward(const Error& e) { return {e}; }

std::string text_of(std::vector<char> bytes) {
  const std::string_view all(bytes.data(), bytes.size());
  return std::string(all.substr(0, all.find('\0')));
}

class Parser {
 public:
  Parser(MatStream& stream, bool big) : stream_(stream), big_(big) {}

  Expected<void> variable();
  std::vector<MatArray> take() { return std::move(arrays_); }
  const std::string& name() const { return name_; }

 private:
  /// A tagged piece of data: its bytes begin at the stream's position.
  struct Element {
    std::uint32_t type = 0;
    std::int64_t size = 0;
    std::int64_t begin = 0;
    std::int64_t next = 0;  // where the element after it begins
  };

  Expected<Element> element(std::int64_t end);
  Expected<std::vector<char>> bytes_of(const Element& e, std::int64_t most);
  Expected<void> array(const Element& whole, const std::string& path, std::size_t depth);
  Expected<void> fields(MatArray& array, std::int64_t end, std::size_t depth);
  Expected<void> numbers(MatArray& array, std::int64_t end);
  std::uint32_t word(const char* bytes) const {
    std::uint32_t value = 0;
    for (int i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(bytes[big_ ? i : 3 - i]);
    return value;
  }

  MatStream& stream_;
  bool big_;
  std::string name_;
  std::vector<MatArray> arrays_;
};

/// The element at the stream's position; it ends before `end`.
Expected<Parser::Element> Parser::element(std::int64_t end) {
  std::array<char, 8> tag{};
  if (end - stream_.position() < 8) return unexpected("an element ends too early");
  if (auto done = stream_.read(tag.data(), 4); !done) return forward(done.error());
  Element e;
  const std::uint32_t first = word(tag.data());
  if (first >> 16 != 0) {  // four bytes at most, in the tag itself
    e.type = first & 0xFFFF;
    e.size = first >> 16;
    e.begin = stream_.position();
    e.next = e.begin + 4;
    if (e.size > 4) return unexpected("a short element has " + std::to_string(e.size) + " bytes");
    return e;
  }
  if (auto done = stream_.read(tag.data() + 4, 4); !done) return forward(done.error());
  e.type = first;
  e.size = word(tag.data() + 4);
  e.begin = stream_.position();
  e.next = e.begin + (e.size + 7) / 8 * 8;
  if (e.size > end - e.begin) return unexpected("an element goes beyond its array");
  return e;
}

Expected<std::vector<char>> Parser::bytes_of(const Element& e, std::int64_t most) {
  if (e.size > most) return unexpected("a header element has " + std::to_string(e.size) + " bytes");
  std::vector<char> bytes(static_cast<std::size_t>(e.size));
  if (auto done = stream_.read(bytes.data(), bytes.size()); !done) return forward(done.error());
  return bytes;
}

Expected<void> Parser::numbers(MatArray& a, std::int64_t end) {
  const auto values = element(end);
  if (!values) return forward(values.error());
  a.type = static_cast<MatNumber>(values->type);
  a.position = values->begin;
  const std::size_t size = size_of(a.type);
  if (size == 0) return unexpected("its values have the type " + std::to_string(values->type) + ", no numbers");
  if (static_cast<std::uint64_t>(values->size) != a.count * size)
    return unexpected("its values take " + std::to_string(values->size) + " bytes, " + std::to_string(a.count * size) +
                      " are needed");
  return {};
}

Expected<void> Parser::fields(MatArray& a, std::int64_t end, std::size_t depth) {
  const auto length_element = element(end);
  if (!length_element) return forward(length_element.error());
  const auto length_bytes = bytes_of(*length_element, 4);
  if (!length_bytes) return forward(length_bytes.error());
  const std::int64_t length = length_bytes->size() == 4 ? word(length_bytes->data()) : 0;
  if (auto done = stream_.skip_to(length_element->next); !done) return done;
  const auto names_element = element(end);
  if (!names_element) return forward(names_element.error());
  const auto names = bytes_of(*names_element, kMostFieldBytes);
  if (!names) return forward(names.error());
  if (names->empty()) return {};
  if (length < 1 || names_element->size % length != 0) return unexpected("the names of its fields are damaged");
  std::int64_t next = names_element->next;
  for (auto at = names->begin(); at != names->end(); at += length) {
    const std::string field = text_of({at, at + length});
    if (auto done = stream_.skip_to(next); !done) return done;
    const auto inner = element(end);
    if (!inner) return forward(inner.error());
    if (inner->type != kMatrix) return unexpected("field " + shown(field) + " is no array");
    if (auto done = array(*inner, a.name + "." + field, depth + 1); !done) return done;
    next = inner->next;
  }
  return {};
}

Expected<void> Parser::array(const Element& whole, const std::string& path, std::size_t depth) {
  MatArray a;
  a.name = path;
  const std::int64_t end = whole.begin + whole.size;
  if (whole.size == 0) {  // an empty array in a struct
    a.why = "is empty";
    arrays_.push_back(std::move(a));
    return {};
  }
  const auto flags_element = element(end);
  if (!flags_element) return forward(flags_element.error());
  const auto flags_bytes = bytes_of(*flags_element, 8);
  if (!flags_bytes) return forward(flags_bytes.error());
  if (flags_element->type != kUint32 || flags_bytes->size() != 8) return unexpected("its flags are damaged");
  const std::uint32_t flags = word(flags_bytes->data());
  const int kind = static_cast<int>(flags & 0xFF);

  auto next = element(end);
  if (!next) return forward(next.error());
  if (kind != kOpaque) {
    const auto shape = bytes_of(*next, 4 * kMostDimensions);
    if (!shape) return forward(shape.error());
    if (next->type != kInt32 || shape->size() < 8 || shape->size() % 4 != 0) return unexpected("its dimensions are damaged");
    a.count = 1;
    for (std::size_t i = 0; i < shape->size(); i += 4) {
      a.shape.push_back(word(shape->data() + i));
      if (a.shape.back() > 0x7FFFFFFF) return unexpected("its dimensions are damaged");
      a.count *= a.shape.back();
      if (a.count > std::uint64_t{1} << 32) return unexpected("its dimensions are damaged");
    }
    if (auto done = stream_.skip_to(next->next); !done) return done;
    next = element(end);
    if (!next) return forward(next.error());
  }
  const auto name = bytes_of(*next, kLongestName);
  if (!name) return forward(name.error());
  if (next->type != kInt8) return unexpected("its name is damaged");
  if (depth == 0) name_ = a.name = text_of(*name);
  if (auto done = stream_.skip_to(next->next); !done) return done;

  if (kind == kStruct && a.count == 1 && depth < kDeepest) return fields(a, end, depth);
  if (kind == kCell) a.why = "is a cell array; store its parts as arrays";
  if (kind == kStruct) a.why = "is an array of structs; store its parts as arrays";
  if (kind == kObject || kind == kOpaque) a.why = "is an object; store its parts as arrays";
  if (kind == kChar) a.why = "is text";
  if (kind == kSparse) a.why = "is sparse; store it as a full array";
  if (a.why.empty() && (kind < kFirstNumeric || kind > kLastNumeric)) a.why = "holds no numbers";
  if (a.why.empty() && (flags & kComplexFlag) != 0)
    a.why = "is complex; store its real and imaginary part as columns of their own";
  if (a.why.empty() && a.count == 0) a.why = "is empty";
  if (a.why.empty()) {
    if (auto done = numbers(a, end); !done) return done;
  }
  arrays_.push_back(std::move(a));
  return {};
}

Expected<void> Parser::variable() {
  const auto whole = element(std::int64_t{1} << 40);
  if (!whole) return forward(whole.error());
  if (whole->type != kMatrix) return unexpected("no array, but an element of type " + std::to_string(whole->type));
  return array(*whole, "", 0);
}

template <class Stored, class Number>
void convert_each(bool swapped, std::span<const char> bytes, double* to) {
  for (std::size_t i = 0; i + sizeof(Stored) <= bytes.size(); i += sizeof(Stored)) {
    Stored bits = 0;
    std::memcpy(&bits, bytes.data() + i, sizeof bits);
    if (swapped) {
      Stored other = 0;
      for (std::size_t b = 0; b < sizeof bits; ++b)
        other = static_cast<Stored>(other | (bits >> (8 * b) & 0xFF) << (8 * (sizeof bits - 1 - b)));
      bits = other;
    }
    *to++ = static_cast<double>(std::bit_cast<Number>(bits));
  }
}

}  // namespace

std::size_t size_of(MatNumber type) {
  switch (type) {
    case MatNumber::int8:
    case MatNumber::uint8:
      return 1;
    case MatNumber::int16:
    case MatNumber::uint16:
      return 2;
    case MatNumber::int32:
    case MatNumber::uint32:
    case MatNumber::single:
      return 4;
    case MatNumber::real:
    case MatNumber::int64:
    case MatNumber::uint64:
      return 8;
  }
  return 0;
}

void convert(MatNumber type, bool big_endian, std::span<const char> bytes, double* to) {
  const bool swapped = big_endian != (std::endian::native == std::endian::big);
  switch (type) {
    case MatNumber::int8:
      return convert_each<std::uint8_t, std::int8_t>(swapped, bytes, to);
    case MatNumber::uint8:
      return convert_each<std::uint8_t, std::uint8_t>(swapped, bytes, to);
    case MatNumber::int16:
      return convert_each<std::uint16_t, std::int16_t>(swapped, bytes, to);
    case MatNumber::uint16:
      return convert_each<std::uint16_t, std::uint16_t>(swapped, bytes, to);
    case MatNumber::int32:
      return convert_each<std::uint32_t, std::int32_t>(swapped, bytes, to);
    case MatNumber::uint32:
      return convert_each<std::uint32_t, std::uint32_t>(swapped, bytes, to);
    case MatNumber::single:
      return convert_each<std::uint32_t, float>(swapped, bytes, to);
    case MatNumber::real:
      return convert_each<std::uint64_t, double>(swapped, bytes, to);
    case MatNumber::int64:
      return convert_each<std::uint64_t, std::int64_t>(swapped, bytes, to);
    case MatNumber::uint64:
      return convert_each<std::uint64_t, std::uint64_t>(swapped, bytes, to);
  }
}

Expected<std::vector<MatArray>> read_mat_variable(MatStream& stream, bool big_endian) {
  Parser parser(stream, big_endian);
  if (auto done = parser.variable(); !done) {
    const std::string name = parser.name().empty() ? "a variable" : "variable " + shown(parser.name());
    return unexpected(name + " is damaged: " + done.error().text);
  }
  return parser.take();
}

}  // namespace bodeflow::acquisition
