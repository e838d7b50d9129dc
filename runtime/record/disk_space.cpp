#include "record/disk_space.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace bodeflow::record {
namespace {

/// Taken at a time while there is room, so that most calls need no work.
constexpr std::uint64_t kStep = std::uint64_t{16} << 20U;

/// 0, or errno. Where the file system can't take space ahead, the free space that it states has to do.
int take(int file, std::uint64_t from, std::uint64_t to) {
  while (::fallocate(file, FALLOC_FL_KEEP_SIZE, static_cast<off_t>(from), static_cast<off_t>(to - from)) != 0) {
    if (errno == EINTR) continue;
    if (errno != EOPNOTSUPP && errno != ENOSYS) return errno;
    struct statvfs disk {};
    struct stat now {};
    if (::fstatvfs(file, &disk) != 0 || ::fstat(file, &now) != 0) return 0;
    const auto size = static_cast<std::uint64_t>(now.st_size);
    return to > size && to - size > disk.f_bavail * disk.f_frsize ? ENOSPC : 0;
  }
  return 0;
}

}  // namespace

tl::expected<void, std::string> DiskSpace::ensure(int file, std::uint64_t end) {
  const std::uint64_t need = end + kMargin;
  rlimit limit{};
  if (::getrlimit(RLIMIT_FSIZE, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY && need > limit.rlim_cur)
    return tl::unexpected(fmt::format("can't write '{}': the limit for the size of a file is reached (ulimit -f, {} bytes)",
                                      path_.string(), limit.rlim_cur));
  if (need <= held_) return {};
  if (take(file, held_, need + kStep) == 0) {
    held_ = need + kStep;
    return {};
  }
  const int error = take(file, held_, need);
  if (error == 0) {
    held_ = need;
    return {};
  }
  return tl::unexpected(fmt::format("can't write '{}': {}", path_.string(), std::strerror(error)));
}

void DiskSpace::release() {
  struct stat now {};
  if (held_ > 0 && ::stat(path_.c_str(), &now) == 0) [[maybe_unused]]
    const int ignored = ::truncate(path_.c_str(), now.st_size);
  held_ = 0;
}

}  // namespace bodeflow::record
