#include "record/files.hpp"

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>

namespace bodeflow::record {
namespace {

tl::unexpected<std::string> cannot(const char* what, const std::filesystem::path& path, int error) {
  return tl::unexpected(fmt::format("can't {} '{}': {}", what, path.string(), std::strerror(error)));
}

/// 0, or errno.
int write_all(int file, const char* data, std::size_t size) {
  while (size > 0) {
    const ssize_t done = ::write(file, data, size);
    if (done < 0) {
      if (errno == EINTR) continue;
      return errno;
    }
    data += done;
    size -= static_cast<std::size_t>(done);
  }
  return 0;
}

}  // namespace

tl::expected<void, std::string> write_atomically(const std::filesystem::path& path, const std::string& text, bool durable) {
  std::filesystem::path temporary = path;
  temporary += ".new";
  const int file = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (file < 0) return cannot("write", path, errno);
  int error = write_all(file, text.data(), text.size());
  if (error == 0 && durable && ::fsync(file) != 0) error = errno;
  if (::close(file) != 0 && error == 0) error = errno;
  if (error == 0 && std::rename(temporary.c_str(), path.c_str()) != 0) error = errno;
  if (error == 0) return {};
  ::unlink(temporary.c_str());
  return cannot("write", path, error);
}

tl::expected<std::string, std::string> read_text(const std::filesystem::path& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return cannot("read", path, errno);
  std::string text;
  char buffer[65536];
  while (true) {
    const ssize_t got = ::read(file, buffer, sizeof buffer);
    if (got < 0 && errno == EINTR) continue;
    const int error = errno;
    if (got <= 0) ::close(file);
    if (got < 0) return cannot("read", path, error);
    if (got == 0) return text;
    text.append(buffer, static_cast<std::size_t>(got));
  }
}

std::string utc_now() {
  const auto now = std::chrono::system_clock::now();
  const auto ms = std::chrono::duration_cast<std::chrono::milliseconds>(now.time_since_epoch()).count();
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03}Z", fmt::gmtime(static_cast<std::time_t>(ms / 1000)), ms % 1000);
}

std::string folder_time_now() {
  return fmt::format("{:%Y%m%d-%H%M%S}", fmt::localtime(std::chrono::system_clock::to_time_t(std::chrono::system_clock::now())));
}

LineFile::~LineFile() {
  if (file_ >= 0) ::close(file_);
}

tl::expected<void, std::string> LineFile::open(const std::filesystem::path& path) {
  path_ = path;
  file_ = ::open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (file_ < 0) return cannot("write", path, errno);
  return {};
}

void LineFile::append(std::string line) {
  line += '\n';
  const std::lock_guard lock(mutex_);
  if (file_ < 0) return;
  const int error = write_all(file_, line.data(), line.size());
  if (error != 0 && error_.empty()) error_ = cannot("write", path_, error).value();
}

std::string LineFile::error() const {
  const std::lock_guard lock(mutex_);
  return error_;
}

}  // namespace bodeflow::record
