#include "plugins/file_bytes.hpp"

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

namespace bodeflow {

tl::expected<std::vector<std::byte>, std::string> file_bytes(const std::filesystem::path& path) {
  const auto close = [](std::FILE* file) { std::fclose(file); };
  const std::unique_ptr<std::FILE, decltype(close)> file(std::fopen(path.c_str(), "rb"), close);
  if (!file) return tl::unexpected(std::string("can't be read: ") + std::strerror(errno));
  std::vector<std::byte> bytes;
  std::error_code unknown;
  if (const auto size = std::filesystem::file_size(path, unknown); !unknown) bytes.reserve(static_cast<std::size_t>(size));
  std::array<std::byte, 65536> piece;
  for (;;) {
    const std::size_t size = std::fread(piece.data(), 1, piece.size(), file.get());
    bytes.insert(bytes.end(), piece.begin(), piece.begin() + static_cast<std::ptrdiff_t>(size));
    if (size < piece.size()) break;
  }
  if (std::ferror(file.get())) return tl::unexpected(std::string("can't be read: ") + std::strerror(errno));
  return bytes;
}

}  // namespace bodeflow
