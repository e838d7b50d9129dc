#include "trust/files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>

namespace bodeflow::trust {
namespace {

namespace fs = std::filesystem;

std::string system_failure(const fs::path& path) { return fmt::format("'{}': {}", path.string(), std::strerror(errno)); }

bool write_all(int file, const std::string& text) {
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t size = ::write(file, text.data() + done, text.size() - done);
    if (size < 0 && errno == EINTR) continue;
    if (size < 0) return false;
    done += static_cast<std::size_t>(size);
  }
  return ::fsync(file) == 0;
}

Expected<void> write_to(int file, const fs::path& path, const std::string& text) {
  if (file < 0) return tl::unexpected(system_failure(path));
  if (!write_all(file, text)) {
    const std::string why = system_failure(path);
    ::close(file);
    ::unlink(path.c_str());
    return tl::unexpected(why);
  }
  ::close(file);
  return {};
}

constexpr std::size_t kTarBlock = 512;

/// The header of one entry; numbers are octal texts, the checksum is of the header with blanks in its place.
std::string tar_header(const Archived& file, long modified_s) {
  const bool folder = file.name.back() == '/';
  std::string header(kTarBlock, '\0');
  const auto put = [&header](std::size_t at, const std::string& text) { header.replace(at, text.size(), text); };
  put(0, file.name);
  put(100, fmt::format("{:07o}", file.mode));
  put(108, fmt::format("{:07o}", 0));
  put(116, fmt::format("{:07o}", 0));
  put(124, fmt::format("{:011o}", file.content.size()));
  put(136, fmt::format("{:011o}", modified_s));
  put(148, std::string(8, ' '));
  put(156, folder ? "5" : "0");
  put(257, "ustar");
  put(263, "00");
  unsigned sum = 0;
  for (const char byte : header) sum += static_cast<unsigned char>(byte);
  put(148, fmt::format("{:06o}", sum) + std::string("\0 ", 2));
  return header;
}

}  // namespace

Expected<std::string> read_file(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return tl::unexpected(system_failure(path));
  std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  if (file.bad()) return tl::unexpected(system_failure(path));
  return text;
}

Expected<void> write_new(const fs::path& path, const std::string& text, mode_t mode) {
  return write_to(::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode), path, text);
}

Expected<void> replace(const fs::path& path, const std::string& text, mode_t mode) {
  std::string name = path.string() + ".XXXXXX";
  const int file = ::mkostemp(name.data(), O_CLOEXEC);
  if (auto written = write_to(file, name, text); !written) return written;
  if (::chmod(name.c_str(), mode) != 0 || ::rename(name.c_str(), path.c_str()) != 0) {
    const std::string why = system_failure(path);
    ::unlink(name.c_str());
    return tl::unexpected(why);
  }
  return {};
}

Expected<Staging> Staging::beside(const fs::path& target) {
  std::error_code error;
  fs::create_directories(target.parent_path(), error);
  if (error) return tl::unexpected(fmt::format("'{}': {}", target.parent_path().string(), error.message()));
  std::string name = (target.parent_path() / ".new-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) return tl::unexpected(system_failure(target.parent_path()));
  return Staging(name);
}

Staging::~Staging() {
  std::error_code ignored;
  if (!path_.empty()) fs::remove_all(path_, ignored);
}

Expected<void> Staging::becomes(const fs::path& target) {
  if (::rename(path_.c_str(), target.c_str()) != 0) return tl::unexpected(system_failure(target));
  path_.clear();
  return {};
}

Expected<Lock> Lock::of(const fs::path& folder) {
  const int opened = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (opened < 0) return tl::unexpected(system_failure(folder));
  Lock lock(opened);
  while (::flock(opened, LOCK_EX) != 0)
    if (errno != EINTR) return tl::unexpected(system_failure(folder));
  return lock;
}

Lock::~Lock() {
  if (folder_ >= 0) ::close(folder_);
}

std::string tar(const std::vector<Archived>& files, long modified_s) {
  std::string archive;
  for (const Archived& file : files) {
    archive += tar_header(file, modified_s) + file.content;
    archive.resize((archive.size() + kTarBlock - 1) / kTarBlock * kTarBlock);
  }
  return archive + std::string(2 * kTarBlock, '\0');
}

}  // namespace bodeflow::trust
