#include "mat_layout.hpp"

#include <array>
#include <string_view>

namespace bodeflow::acquisition {
namespace {

// MATLAB, "MAT-File Format" (R2023b), chapter 1: a header of 128 bytes, then elements, each with a type and its length.
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

Expected<MatKind> walk(ByteSource& source, std::uint64_t size, bool big) {
  std::array<char, 8> tag{};
  int variable = 1;
  for (std::uint64_t at = kHeader; at < size; ++variable) {
    if (auto done = source.seek(static_cast<std::int64_t>(at)); !done) return {Unexpected<Error>{done.error()}};
    const auto got = read_up_to(source, tag.data(), tag.size());
    if (!got) return {Unexpected<Error>{got.error()}};
    const std::string place = "variable " + std::to_string(variable);
    if (*got < tag.size()) return unexpected("cut off in the header of " + place);
    const std::uint32_t type = number(tag.data(), big), length = number(tag.data() + 4, big);
    if (type != kMatrix && type != kCompressed)
      return unexpected("damaged: " + place + " begins with an element of type " + std::to_string(type) + ", no array");
    if (length > size - at - 8) {
      return unexpected("cut off: " + place + " needs " + std::to_string(length) + " bytes, " + std::to_string(size - at - 8) +
                        " follow");
    }
    at += 8 + length;
  }
  return MatKind::v5;
}

}  // namespace

Expected<MatKind> check_mat(ByteSource& source, std::int64_t size) {
  std::array<char, kHeader> head{};
  if (auto done = source.seek(0); !done) return {Unexpected<Error>{done.error()}};
  const auto got = read_up_to(source, head.data(), head.size());
  if (!got) return {Unexpected<Error>{got.error()}};
  if (*got == 0) return unexpected("empty file");
  const std::string_view mark(head.data() + 124, 4);
  if (*got == kHeader && (mark == std::string_view("\0\2IM", 4) || mark == std::string_view("\2\0MI", 4))) return MatKind::v73;
  if (*got == kHeader && mark == std::string_view("\0\1IM", 4)) return walk(source, static_cast<std::uint64_t>(size), false);
  if (*got == kHeader && mark == std::string_view("\1\0MI", 4)) return walk(source, static_cast<std::uint64_t>(size), true);
  if (*got >= 20 && looks_like_v4(head.data())) return unexpected("is a MATLAB v4 file; save it with -v7 or -v7.3");
  if (*got < kHeader && std::string_view(head.data(), 6) == "MATLAB") return unexpected("cut off in its header");
  return unexpected("is not a MATLAB file");
}

}  // namespace bodeflow::acquisition
