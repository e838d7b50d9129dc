#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <tl/expected.hpp>

namespace bodeflow {

/// SHA-256 (FIPS 180-4) of bytes that come in pieces; the result does not depend on how they were cut.
class Sha256 {
 public:
  Sha256();
  ~Sha256();
  Sha256(Sha256&&) noexcept;
  Sha256& operator=(Sha256&&) noexcept;

  void update(const void* bytes, std::size_t size);
  /// The hash of everything so far in 64 lower-case hexadecimal digits; further updates go on from here.
  std::string hex() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The hash of the bytes.
std::string sha256_hex(std::span<const std::byte> bytes);

/// The hash of a file's bytes. Error: why it can't be read, with its path.
tl::expected<std::string, std::string> sha256_of_file(const std::filesystem::path& path);

}  // namespace bodeflow
