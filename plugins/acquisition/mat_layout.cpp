#include "mat_layout.hpp"

#include <array>
#include <string_view>

namespace bodeflow::acquisition {
namespace {

constexpr std::size_t kHeader = 128;
constexpr std::uint32_t kMatrix = 14, kCompressed = 15;

std::uint32_t number(const char* bytes, bool big) {
  std::uint32_t value = 0;
  for (int i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(bytes[big ? i : 3 - i]);
  return value;
}

Expected<std::size_t> read_up_to(ByteSource& source, char* to, std::size_t size) {
  std::size_t done = 0;
  while (done < size) {
    const auto got = source.read(to + done, size - done);
    if (!got) return got;
    if (*got == 0) break;
    done += *got;
  }
  return done;
}

/// v4 begins with a type below 5000, of which M = 0 or 1 says little or big endian, O = 0, P and T are below 6 and 3.
bool looks_like_v4(const char* bytes) {
  for (const bool big : {false, true}) {
    const std::uint32_t type = number(bytes, big);
    if (type < 5000 && type / 1000 == (big ? 1 : 0) && type / 100 % 10 == 0 && type / 10 % 10 < 6 && type % 10 < 3) return true;
  }
  return false;
}

/// How many bytes there are from `offset` on, at most `size`; without reading them all.
Expected<std::int64_t> bytes_from(ByteSource& source, std::int64_t offset, std::int64_t size) {
  const auto there = [&](std::int64_t count) -> Expected<bool> {  // are there so many?
    if (count == 0) return true;
    char last = 0;
    if (auto done = source.seek(offset + count - 1); !done) return {Unexpected<Error>{done.error()}};
    const auto got = source.read(&last, 1);
    if (!got) return {Unexpected<Error>{got.error()}};
    return *got == 1;
  };
  std::int64_t least = 0, greatest = size;
  while (least < greatest) {
    const std::int64_t count = least == 0 && greatest == size ? size : least + (greatest - least + 1) / 2;
    const auto held = there(count);
    if (!held) return {Unexpected<Error>{held.error()}};
    if (*held) {
      least = count;
    } else {
      greatest = count - 1;
    }
  }
  return least;
}

Expected<void> list_variables(ByteSource& source, MatLayout& layout) {
  std::array<char, 8> tag{};
  for (std::int64_t at = kHeader;;) {
    if (auto done = source.seek(at); !done) return done;
    const auto got = read_up_to(source, tag.data(), tag.size());
    if (!got) return {Unexpected<Error>{got.error()}};
    if (*got == 0) return {};
    const std::string place = "variable " + std::to_string(layout.variables.size() + 1);
    if (*got < tag.size()) return unexpected("cut off in the header of " + place);
    const std::uint32_t type = number(tag.data(), layout.big_endian);
    const auto length = static_cast<std::int64_t>(number(tag.data() + 4, layout.big_endian));
    if (type != kMatrix && type != kCompressed)
      return unexpected("damaged: " + place + " begins with an element of type " + std::to_string(type) + ", no array");
    const auto held = bytes_from(source, at + 8, length);
    if (!held) return {Unexpected<Error>{held.error()}};
    if (*held < length)
      return unexpected("cut off: " + place + " needs " + std::to_string(length) + " bytes, " + std::to_string(*held) +
                        " follow");
    if (type == kCompressed) {
      layout.variables.push_back({at + 8, length, true});
    } else {
      layout.variables.push_back({at, length + 8, false});
    }
    at += 8 + length;
  }
}

}  // namespace

Expected<MatLayout> read_mat_layout(ByteSource& source) {
  std::array<char, kHeader> head{};
  if (auto done = source.seek(0); !done) return {Unexpected<Error>{done.error()}};
  const auto got = read_up_to(source, head.data(), head.size());
  if (!got) return {Unexpected<Error>{got.error()}};
  if (*got == 0) return unexpected("empty file");
  const std::string_view mark(head.data() + 124, 4);
  MatLayout layout;
  layout.big_endian = mark.substr(2) == "MI";
  const std::string version(layout.big_endian ? mark.substr(0, 2) : std::string{mark[1], mark[0]});
  if (*got == kHeader && (layout.big_endian || mark.substr(2) == "IM")) {
    if (version == std::string("\2\0", 2)) {
      layout.kind = MatKind::v73;
      return layout;
    }
    if (version == std::string("\1\0", 2)) {
      if (auto done = list_variables(source, layout); !done) return {Unexpected<Error>{done.error()}};
      return layout;
    }
  }
  if (*got < kHeader && std::string_view(head.data(), 6) == "MATLAB") return unexpected("cut off in its header");
  if (*got >= 20 && looks_like_v4(head.data())) return unexpected("is a MATLAB v4 file; save it with -v7 or -v7.3");
  return unexpected("is not a MATLAB file");
}

}  // namespace bodeflow::acquisition
