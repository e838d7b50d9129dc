#include "riff.hpp"

#include <array>
#include <string_view>

#include "printable.hpp"

namespace bodeflow::acquisition {
namespace {

constexpr std::uint64_t kUnset = 0xFFFFFFFF;  // RF64: the size stands in the chunk ds64

std::uint64_t little(const char* bytes, int count) {
  std::uint64_t value = 0;
  for (int i = count - 1; i >= 0; --i) value = value << 8 | static_cast<unsigned char>(bytes[i]);
  return value;
}

Expected<bool> read_exactly(ByteSource& source, char* to, std::size_t size) {
  for (std::size_t done = 0; done < size;) {
    const auto got = source.read(to + done, size - done);
    if (!got) return {Unexpected<Error>{got.error()}};
    if (*got == 0) return false;
    done += *got;
  }
  return true;
}

/// What is wrong with the chunk of samples, or nothing.
Expected<void> check_data(std::uint64_t stated, std::uint64_t held, bool in_rf64) {
  if (!in_rf64 && stated == kUnset) return unexpected("the header was never completed: the recording was broken off");
  if (stated == 0 && held > 0) {
    return unexpected("the header states no samples, but " + std::to_string(held) +
                      " bytes follow: the recording was broken off before its header was completed");
  }
  if (stated > held) {
    return unexpected("cut off: the header states " + std::to_string(stated) + " bytes of samples, the file holds " +
                      std::to_string(held));
  }
  return {};
}

}  // namespace

Expected<void> check_riff(ByteSource& source, std::int64_t size) {
  std::array<char, 24> head{};
  const auto total = static_cast<std::uint64_t>(size);
  const auto begun = read_exactly(source, head.data(), 12);
  if (!begun) return {Unexpected<Error>{begun.error()}};
  const std::string kind(head.data(), 4);
  if (!*begun || (kind != "RIFF" && kind != "RF64") || std::string_view(head.data() + 8, 4) != "WAVE") return {};
  std::uint64_t long_size = kUnset;
  for (std::uint64_t at = 12; at + 8 <= total;) {
    if (auto done = source.seek(static_cast<std::int64_t>(at)); !done) return done;
    const auto there = read_exactly(source, head.data(), 8);
    if (!there) return {Unexpected<Error>{there.error()}};
    if (!*there) break;
    const std::string id(head.data(), 4);
    std::uint64_t length = little(head.data() + 4, 4);
    if (id == "ds64") {
      const auto more = read_exactly(source, head.data(), 16);
      if (!more) return {Unexpected<Error>{more.error()}};
      if (*more) long_size = little(head.data() + 8, 8);
    }
    if (id == "fmt ") {
      const auto more = read_exactly(source, head.data(), 8);
      if (!more) return {Unexpected<Error>{more.error()}};
      if (*more && little(head.data() + 2, 2) == 0) return unexpected("the header states 0 channels");
      if (*more && little(head.data() + 4, 4) == 0) return unexpected("the header states 0 samples per second");
    }
    if (id == "data") {
      if (kind == "RF64" && length == kUnset) length = long_size;
      return check_data(length, total - at - 8, kind == "RF64");
    }
    if (length > total - at - 8) return unexpected("cut off: chunk " + shown(id) + " goes beyond the end of the file");
    at += 8 + length + length % 2;
  }
  return unexpected("no chunk of samples in it");
}

}  // namespace bodeflow::acquisition
