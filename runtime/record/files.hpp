#pragma once

#include <filesystem>
#include <mutex>
#include <string>
#include <tl/expected.hpp>

namespace bodeflow::record {

/// Nothing, once `path` holds `text` whole; a reader sees the old content or the new one, never a part. `durable` waits
/// until the disk has it. Error: why not, with the path; the old content stays.
tl::expected<void, std::string> write_atomically(const std::filesystem::path& path, const std::string& text,
                                                 bool durable = false);

/// The whole content of a file. Error: why not, with the path.
tl::expected<std::string, std::string> read_text(const std::filesystem::path& path);

/// Now in UTC with milliseconds, as in "2025-03-01T12:34:56.789Z".
std::string utc_now();

/// Now in local time for a folder name, as in "20250301-123456".
std::string folder_time_now();

/// A file that only grows, a line at a time; what was appended survives the end of the process. Any thread.
class LineFile {
 public:
  LineFile() = default;
  ~LineFile();
  LineFile(const LineFile&) = delete;
  LineFile& operator=(const LineFile&) = delete;

  tl::expected<void, std::string> open(const std::filesystem::path& path);
  /// Appends the line and its end in one write. The first failure is kept for `error`.
  void append(std::string line);
  /// Why a line was lost, or "".
  std::string error() const;

 private:
  mutable std::mutex mutex_;
  std::filesystem::path path_;
  std::string error_;
  int file_ = -1;
};

}  // namespace bodeflow::record
