#include "transport/wire.hpp"

#include <bodeflow/abi.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

#include "transport/cdr.hpp"

namespace bodeflow::transport {
namespace {

constexpr std::uint32_t kMagic = 0x4C465742;
constexpr std::uint16_t kVersion = 1;
constexpr std::size_t kLongestClock = 255;
constexpr std::uint32_t kMostChannels = 65536;

tl::unexpected<std::string> bad(std::string text) { return tl::unexpected<std::string>(std::move(text)); }

/// Samples fill the payload exactly; what has no samples names none.
std::string wrong_shape(const Header& header, std::uint64_t payload) {
  if (header.kind != Kind::samples) {
    if (header.element != 0 || header.channels != 0 || header.count != 0) return "a message without samples names samples";
    const bool empty = header.kind == Kind::horizon || header.kind == Kind::end;
    return empty && payload > 0 ? "a message of a kind without payload has one" : "";
  }
  if (header.element != BF_F64 && header.element != BF_C64) {
    return "unknown element type " + std::to_string(header.element) + " (allowed: 1, 2)";
  }
  if (header.channels == 0 || header.channels > kMostChannels) return std::to_string(header.channels) + " channels";
  if (header.rate_num <= 0) return "a sample rate that is not positive";
  const std::uint64_t sample = (header.element == BF_C64 ? 16u : 8u) * std::uint64_t{header.channels};
  if (header.count > kMostPayload / sample || header.count * sample != payload) {
    return std::to_string(header.count) + " samples of " + std::to_string(header.channels) + " channels do not fill " +
           std::to_string(payload) + " bytes";
  }
  if (header.position > std::numeric_limits<std::int64_t>::max() - static_cast<std::int64_t>(header.count)) {
    return "a position beyond the last";
  }
  return "";
}

std::string read_header(cdr::Reader& reader, Header& header) {
  std::uint32_t magic = 0;
  std::uint16_t version = 0;
  std::uint8_t kind = 0, element = 0;
  if (!reader.get(magic)) return "shorter than a header";
  if (magic != kMagic) return "not a message of bodeflow";
  if (!reader.get(version)) return "shorter than a header";
  if (version != kVersion) return "version " + std::to_string(version) + " of the format (known: 1)";
  if (!(reader.get(kind) && reader.get(element) && reader.get(header.stream) && reader.get(header.epoch) &&
        reader.get(header.channels) && reader.get(header.sequence) && reader.get(header.position) && reader.get(header.count) &&
        reader.get(header.rate_num) && reader.get(header.rate_den) && reader.get(header.source_ns))) {
    return "shorter than a header";
  }
  if (kind < static_cast<std::uint8_t>(Kind::samples) || kind > static_cast<std::uint8_t>(Kind::text)) {
    return "unknown kind " + std::to_string(kind);
  }
  if (header.rate_num < 0 || header.rate_den <= 0) return "a rate that is not a fraction of positive numbers";
  header.kind = static_cast<Kind>(kind);
  header.element = element;
  return reader.get(header.clock, kLongestClock) ? "" : "a clock's name that is no string of at most 255 bytes";
}

}  // namespace

std::vector<std::byte> encode_head(const Header& header, std::uint64_t payload_bytes) {
  cdr::Writer writer;
  writer.put(kMagic);
  writer.put(kVersion);
  writer.put(static_cast<std::uint8_t>(header.kind));
  writer.put(static_cast<std::uint8_t>(header.element));
  writer.put(header.stream);
  writer.put(header.epoch);
  writer.put(header.channels);
  writer.put(header.sequence);
  writer.put(header.position);
  writer.put(header.count);
  writer.put(header.rate_num);
  writer.put(header.rate_den);
  writer.put(header.source_ns);
  writer.put(std::string_view(header.clock).substr(0, kLongestClock));
  writer.put(static_cast<std::uint32_t>(payload_bytes));
  return std::move(writer).bytes();
}

std::vector<std::byte> encode(const Header& header, std::span<const std::span<const std::byte>> parts) {
  std::uint64_t payload = 0;
  for (const auto part : parts) payload += part.size();
  auto bytes = encode_head(header, payload);
  bytes.reserve(bytes.size() + payload);
  for (const auto part : parts) bytes.insert(bytes.end(), part.begin(), part.end());
  return bytes;
}

std::string refusal(const Header& header, std::uint64_t payload_bytes) {
  if (payload_bytes > kMostPayload) {
    return std::to_string(payload_bytes) + " bytes of payload (allowed: " + std::to_string(kMostPayload) + ")";
  }
  if (header.clock.size() > kLongestClock) return "a clock's name longer than 255 bytes";
  if (header.clock.find('\0') != std::string::npos) return "a clock's name with a zero byte";
  if (header.rate_num < 0 || header.rate_den <= 0) return "a rate that is not a fraction of positive numbers";
  return wrong_shape(header, payload_bytes);
}

tl::expected<Decoded, std::string> decode(std::span<const std::byte> bytes) {
  cdr::Reader reader(bytes);
  if (!reader.plain()) return bad("not plain CDR, little-endian");
  Decoded decoded;
  if (auto wrong = read_header(reader, decoded.header); !wrong.empty()) return bad(std::move(wrong));
  std::uint32_t length = 0;
  if (!reader.get(length)) return bad("no payload");
  if (length > kMostPayload) return bad("a payload of " + std::to_string(length) + " bytes (allowed: 67108864)");
  const auto rest = reader.rest();
  // A middleware may fill up to the next multiple of four.
  if (rest.size() < length || rest.size() - length > 3) {
    return bad("a payload of " + std::to_string(length) + " bytes in " + std::to_string(rest.size()));
  }
  decoded.payload = rest.first(length);
  if (auto wrong = wrong_shape(decoded.header, length); !wrong.empty()) return bad(std::move(wrong));
  return decoded;
}

std::uint64_t stream_id(const std::string& name) {
  std::uint64_t hash = 0xcbf29ce484222325U;  // FNV-1a
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
  return hash == 0 ? 1 : hash;
}

}  // namespace bodeflow::transport
