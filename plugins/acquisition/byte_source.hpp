#pragma once

#include <bodeflow/error.hpp>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

namespace bodeflow::acquisition {

/// Bytes that can be read again from any place.
class ByteSource {
 public:
  virtual ~ByteSource() = default;
  /// Up to `size` bytes into `to`; how many, 0 at the end. Error: the system's reason.
  virtual Expected<std::size_t> read(char* to, std::size_t size) = 0;
  /// The next `read` begins at this byte. Error: the system's reason.
  virtual Expected<void> seek(std::int64_t offset) = 0;
};

/// Opens the same bytes once more, with a place of their own.
using OpenSource = std::function<Expected<std::unique_ptr<ByteSource>>()>;

/// The bytes of a file. Error: why it can't be opened; a folder is refused.
Expected<std::unique_ptr<ByteSource>> open_file(const std::string& path);

/// The bytes of `text`, which outlives the source.
std::unique_ptr<ByteSource> open_memory(std::string_view text);

}  // namespace bodeflow::acquisition
