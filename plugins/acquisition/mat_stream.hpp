#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "byte_source.hpp"

namespace bodeflow::acquisition {

/// Where the bytes of a variable of a MATLAB file stand.
struct MatExtent {
  std::int64_t offset = 0;  ///< in the file
  std::int64_t size = 0;    ///< in the file
  bool compressed = false;  ///< as a zlib stream

  bool operator==(const MatExtent& other) const = default;
};

/// The bytes of one variable, as they are before compression, read forward in constant memory.
class MatStream {
 public:
  virtual ~MatStream() = default;
  /// The bytes read or passed so far.
  virtual std::int64_t position() const = 0;
  /// Exactly `size` bytes. Error: the bytes end before, or are damaged.
  virtual Expected<void> read(char* to, std::size_t size) = 0;
  /// Passes over the bytes before `position`, which is not before this one.
  virtual Expected<void> skip_to(std::int64_t position) = 0;
  /// Reads to the end, where the checksum of compressed bytes stands.
  virtual Expected<void> verify() = 0;
};

/// `source` outlives the stream and is its alone meanwhile.
Expected<std::unique_ptr<MatStream>> open_mat_stream(ByteSource& source, const MatExtent& extent);

}  // namespace bodeflow::acquisition
