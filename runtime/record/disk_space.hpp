#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <tl/expected.hpp>

namespace bodeflow::record {

/// Space on the disk that a growing file holds ahead of its end. HDF5 can't take back a write that failed half-way: so the
/// space is taken before it writes, and a full disk is found while the file is still whole.
class DiskSpace {
 public:
  /// Bytes that stay free for the file's own bookkeeping, and for the run's closing files once the space is given back.
  static constexpr std::uint64_t kMargin = std::uint64_t{1} << 20U;

  explicit DiskSpace(std::filesystem::path path) : path_(std::move(path)) {}

  /// Makes sure that the file (open as `file`) can grow to `end` bytes plus the margin. Error: why not.
  tl::expected<void, std::string> ensure(int file, std::uint64_t end);
  /// Gives back what lies beyond the end of the file, which is closed.
  void release();

 private:
  std::filesystem::path path_;
  std::uint64_t held_ = 0;  ///< bytes from the start of the file
};

}  // namespace bodeflow::record
