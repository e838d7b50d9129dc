#include "transport/leftovers.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <ctime>
#include <set>
#include <string>
#include <string_view>

namespace bodeflow::transport {
namespace {

constexpr std::time_t kYoung = 2;
constexpr std::string_view kPrefix = "fastrtps_";
constexpr std::string_view kPort = "port";

bool all_of(std::string_view text, int (*kind)(int)) {
  return std::all_of(text.begin(), text.end(), [&](unsigned char c) { return kind(c) != 0; });
}

/// `fastrtps_` and 16 hexadecimal digits: a segment; or `fastrtps_port` and up to five digits: a port.
bool is_shared(std::string_view name) {
  if (!name.starts_with(kPrefix)) return false;
  name.remove_prefix(kPrefix.size());
  if (!name.starts_with(kPort)) return name.size() == 16 && all_of(name, std::isxdigit);
  name.remove_prefix(kPort.size());
  return !name.empty() && name.size() <= 5 && all_of(name, std::isdigit);
}

/// An open file of this user's that is not young; closed at the end.
class OldFile {
 public:
  explicit OldFile(const std::filesystem::path& path) : file_(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW)) {
    struct stat facts {};
    exists_ = file_ >= 0;
    ours_ = exists_ && fstat(file_, &facts) == 0 && facts.st_uid == geteuid() && std::time(nullptr) - facts.st_mtime >= kYoung;
  }
  OldFile(const OldFile&) = delete;
  OldFile& operator=(const OldFile&) = delete;
  ~OldFile() {
    if (file_ >= 0) close(file_);
  }
  bool exists() const { return exists_; }
  bool ours() const { return ours_; }
  /// Nobody holds it; from now on this does.
  bool lock() const { return flock(file_, LOCK_EX | LOCK_NB) == 0; }

 private:
  int file_;
  bool exists_ = false, ours_ = false;
};

/// A port that processes have only written to has no lock file, nor has one whose listener was killed with others still open.
int remove_if_dead(const std::filesystem::path& folder, const std::string& base) {
  const OldFile shared(folder / base), exclusive_lock(folder / (base + "_el")), shared_lock(folder / (base + "_sl"));
  if (shared.exists() && !shared.ours()) return 0;
  for (const auto* lock : {&exclusive_lock, &shared_lock}) {
    if (lock->exists() && !(lock->ours() && lock->lock())) return 0;
  }
  int removed = 0;
  for (const auto& name : {base, base + "_el", base + "_sl", "sem." + base + "_mutex"}) {
    std::error_code ignored;
    if (std::filesystem::remove(folder / name, ignored)) ++removed;
  }
  return removed;
}

}  // namespace

int remove_leftovers(const std::filesystem::path& folder) {
  std::set<std::string> bases;
  std::error_code stop;
  for (std::filesystem::directory_iterator entry(folder, stop), end; !stop && entry != end; entry.increment(stop)) {
    auto name = entry->path().filename().string();
    if (name.ends_with("_el") || name.ends_with("_sl")) name.resize(name.size() - 3);
    if (is_shared(name)) bases.insert(std::move(name));
  }
  int removed = 0;
  for (const auto& base : bases) removed += remove_if_dead(folder, base);
  return removed;
}

}  // namespace bodeflow::transport
