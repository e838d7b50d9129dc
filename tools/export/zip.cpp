#include "export/zip.hpp"

#include <zlib.h>

#include <cstdint>

// Layout: APPNOTE.TXT, PKWARE, version 6.3: local headers with their files, the central directory, its end.
namespace bodeflow::tools::exports {
namespace {

constexpr std::uint32_t kLocal = 0x04034b50, kCentral = 0x02014b50, kEnd = 0x06054b50;
constexpr std::uint16_t kVersion = 20, kFirstOf1980 = 0x21, kUtf8Names = 0x0800, kMadeOnUnix = 3 << 8;
constexpr std::uint32_t kReadable = 0100644u << 16;

template <class T>
void put(std::string& out, T value) {
  for (std::size_t i = 0; i < sizeof(T); ++i) out += static_cast<char>((value >> (8 * i)) & 0xff);
}

/// The fields that local header and directory share.
void put_common(std::string& out, const std::string& name, const std::string& content) {
  put(out, kVersion);
  put(out, kUtf8Names);
  put(out, std::uint16_t{0});  // stored
  put(out, std::uint16_t{0});  // midnight
  put(out, kFirstOf1980);
  put(out,
      static_cast<std::uint32_t>(crc32(0, reinterpret_cast<const Bytef*>(content.data()), static_cast<uInt>(content.size()))));
  put(out, static_cast<std::uint32_t>(content.size()));
  put(out, static_cast<std::uint32_t>(content.size()));
  put(out, static_cast<std::uint16_t>(name.size()));
  put(out, std::uint16_t{0});  // extra field
}

}  // namespace

std::string zip_of(const std::vector<std::pair<std::string, std::string>>& files) {
  std::string out, directory;
  for (const auto& [name, content] : files) {
    const auto offset = static_cast<std::uint32_t>(out.size());
    put(out, kLocal);
    put_common(out, name, content);
    out += name + content;
    put(directory, kCentral);
    put(directory, static_cast<std::uint16_t>(kMadeOnUnix | kVersion));
    put_common(directory, name, content);
    put(directory, std::uint16_t{0});  // comment
    put(directory, std::uint16_t{0});  // disk
    put(directory, std::uint16_t{0});  // internal attributes
    put(directory, kReadable);
    put(directory, offset);
    directory += name;
  }
  const auto start = static_cast<std::uint32_t>(out.size());
  out += directory;
  put(out, kEnd);
  put(out, std::uint32_t{0});  // disks
  put(out, static_cast<std::uint16_t>(files.size()));
  put(out, static_cast<std::uint16_t>(files.size()));
  put(out, static_cast<std::uint32_t>(directory.size()));
  put(out, start);
  put(out, std::uint16_t{0});
  return out;
}

}  // namespace bodeflow::tools::exports
