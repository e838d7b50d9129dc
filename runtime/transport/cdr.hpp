#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// Plain CDR (XCDR1), little-endian, with its encapsulation of four bytes: numbers are aligned to their size after it.
namespace bodeflow::transport::cdr {

inline constexpr std::size_t kEncapsulation = 4;

class Writer {
 public:
  Writer() : bytes_{std::byte{0}, std::byte{1}, std::byte{0}, std::byte{0}} { bytes_.reserve(160); }

  template <std::integral T>
  void put(T value) {
    const std::size_t over = (bytes_.size() - kEncapsulation) % sizeof(T);
    if (over != 0) bytes_.resize(bytes_.size() + sizeof(T) - over);
    const auto at = bytes_.size();
    bytes_.resize(at + sizeof(T));
    std::memcpy(bytes_.data() + at, &value, sizeof(T));
  }
  /// A string with its zero at the end.
  void put(std::string_view text) {
    put(static_cast<std::uint32_t>(text.size() + 1));
    for (const char letter : text) bytes_.push_back(static_cast<std::byte>(letter));
    bytes_.push_back(std::byte{0});
  }

  std::vector<std::byte> bytes() && { return std::move(bytes_); }

 private:
  std::vector<std::byte> bytes_;
};

/// Reads inside its bytes only; after the first false nothing more is read.
class Reader {
 public:
  explicit Reader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  /// The encapsulation says plain CDR, little-endian.
  bool plain() const { return bytes_.size() >= kEncapsulation && bytes_[0] == std::byte{0} && bytes_[1] == std::byte{1}; }

  template <std::integral T>
  bool get(T& value) {
    const std::size_t over = (at_ - kEncapsulation) % sizeof(T);
    const std::size_t start = over == 0 ? at_ : at_ + sizeof(T) - over;
    if (start > bytes_.size() || bytes_.size() - start < sizeof(T)) return false;
    std::memcpy(&value, bytes_.data() + start, sizeof(T));
    at_ = start + sizeof(T);
    return true;
  }
  /// A string of at most `longest` bytes, its zero only at the end.
  bool get(std::string& text, std::size_t longest) {
    std::uint32_t length = 0;
    if (!get(length) || length == 0 || length - 1 > longest || bytes_.size() - at_ < length) return false;
    const auto* letters = reinterpret_cast<const char*>(bytes_.data() + at_);
    if (std::memchr(letters, 0, length) != letters + length - 1) return false;
    text.assign(letters, length - 1);
    at_ += length;
    return true;
  }
  std::span<const std::byte> rest() const { return bytes_.subspan(at_); }

 private:
  std::span<const std::byte> bytes_;
  std::size_t at_ = kEncapsulation;
};

}  // namespace bodeflow::transport::cdr
