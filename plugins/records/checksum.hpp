#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace bodeflow::records {

/// A checksum of samples, for models to tell from which data they came: FNV-1a, 64 bits, over the bytes of the values in the
/// order of the calls of `add`. No protection against forgery.
class Checksum {
 public:
  void add(std::span<const double> values);
  std::string text() const;  ///< 16 hexadecimal digits

 private:
  std::uint64_t state_ = 0xcbf29ce484222325u;
};

}  // namespace bodeflow::records
