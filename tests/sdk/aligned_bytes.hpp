#pragma once

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <span>
#include <vector>

/// Bytes at a 64-byte boundary, as records need them. The allocation is exactly as long as the bytes, so that a sanitizer
/// sees a read beyond them.
class AlignedBytes {
 public:
  explicit AlignedBytes(const std::vector<std::uint8_t>& bytes) : AlignedBytes(bytes.data(), bytes.size()) {}
  AlignedBytes(const std::uint8_t* bytes, std::size_t size) : size_(size) {
    void* memory = nullptr;
    if (posix_memalign(&memory, 64, size == 0 ? 1 : size) != 0) std::abort();
    data_.reset(static_cast<std::uint8_t*>(memory));
    if (size != 0) std::memcpy(memory, bytes, size);
  }
  std::uint8_t* data() { return data_.get(); }
  std::span<const std::uint8_t> span() const { return {data_.get(), size_}; }

 private:
  struct Free {
    void operator()(std::uint8_t* p) const { std::free(p); }
  };
  std::unique_ptr<std::uint8_t, Free> data_;
  std::size_t size_;
};
