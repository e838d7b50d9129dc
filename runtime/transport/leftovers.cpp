#include "transport/leftovers.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <ctime>
#include <string>
#include <string_view>
#include <vector>

namespace bodeflow::transport {
namespace {

constexpr std::time_t kYoung = 2;
constexpr std::string_view kPrefix = "fastrtps_";
constexpr std::string_view kPort = "port";

/// `fastrtps_` and 16 hexadecimal digits, or `fastrtps_port` and up to five digits; then _el or _sl.
bool is_lock(std::string_view name) {
  if (name.size() < kPrefix.size() + 4 || !name.starts_with(kPrefix)) return false;
  if (!name.ends_with("_el") && !name.ends_with("_sl")) return false;
  name.remove_prefix(kPrefix.size());
  name.remove_suffix(3);
  if (name.starts_with(kPort)) {
    name.remove_prefix(kPort.size());
    return !name.empty() && name.size() <= 5 &&
           std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isdigit(c); });
  }
  return name.size() == 16 && std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isxdigit(c); });
}

int remove_unlocked(const std::filesystem::path& folder, const std::string& lock_name) {
  const auto lock_path = folder / lock_name;
  const int file = open(lock_path.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW);
  if (file < 0) return 0;
  int removed = 0;
  struct stat facts {};
  const bool ours = fstat(file, &facts) == 0 && facts.st_uid == geteuid() && std::time(nullptr) - facts.st_mtime >= kYoung;
  if (ours && flock(file, LOCK_EX | LOCK_NB) == 0) {
    const std::string base = lock_name.substr(0, lock_name.size() - 3);
    for (const auto& name : {base, lock_name, "sem." + base + "_mutex"}) {
      std::error_code ignored;
      if (std::filesystem::remove(folder / name, ignored)) ++removed;
    }
  }
  close(file);
  return removed;
}

}  // namespace

int remove_leftovers(const std::filesystem::path& folder) {
  std::vector<std::string> locks;
  std::error_code stop;
  for (std::filesystem::directory_iterator entry(folder, stop), end; !stop && entry != end; entry.increment(stop)) {
    auto name = entry->path().filename().string();
    if (is_lock(name)) locks.push_back(std::move(name));
  }
  int removed = 0;
  for (const auto& name : locks) removed += remove_unlocked(folder, name);
  return removed;
}

}  // namespace bodeflow::transport
