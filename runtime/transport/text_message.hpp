#pragma once

#include <optional>

#include "transport/wire.hpp"

namespace bodeflow::transport {

inline std::vector<std::byte> text_message(const std::string& text) {
  Header header;
  header.kind = Kind::text;
  const std::span<const std::byte> parts[] = {std::as_bytes(std::span(text))};
  return encode(header, parts);
}

/// Nothing: malformed, no text or longer than `longest`.
inline std::optional<std::string> text_of(std::span<const std::byte> bytes, std::size_t longest) {
  const auto decoded = decode(bytes);
  if (!decoded || decoded->header.kind != Kind::text || decoded->payload.size() > longest) return std::nullopt;
  return std::string(reinterpret_cast<const char*>(decoded->payload.data()), decoded->payload.size());
}

}  // namespace bodeflow::transport
