#include "processes_of.hpp"

#include <linux/filter.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>

namespace bodeflow::test {
namespace {

namespace fs = std::filesystem;

std::string folder_of(int process) { return "/proc/" + std::to_string(process); }

/// Whether it is a UDP socket that has been made to lose.
bool lose_at(int socket, const sock_fprog& program) {
  int type = 0, family = 0;
  socklen_t size = sizeof type;
  if (getsockopt(socket, SOL_SOCKET, SO_TYPE, &type, &size) != 0 || type != SOCK_DGRAM) return false;
  size = sizeof family;
  if (getsockopt(socket, SOL_SOCKET, SO_DOMAIN, &family, &size) != 0 || family != AF_INET) return false;
  return setsockopt(socket, SOL_SOCKET, SO_ATTACH_FILTER, &program, sizeof program) == 0;
}

}  // namespace

std::vector<int> processes_with(const std::vector<std::string>& words) {
  std::vector<int> found;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator("/proc", error)) {
    const std::string id = entry.path().filename().string();
    if (id.find_first_not_of("0123456789") != std::string::npos) continue;
    if (!fs::equivalent(entry.path() / "exe", BODEFLOW_COMMAND, error) || error) continue;
    std::ifstream file(entry.path() / "cmdline");
    const std::string line(std::istreambuf_iterator<char>(file), {});
    if (std::all_of(words.begin(), words.end(), [&](const auto& word) { return line.find(word) != std::string::npos; }))
      found.push_back(std::stoi(id));
  }
  return found;
}

double resident_mb(int process) {
  std::ifstream file(folder_of(process) + "/statm");
  double all = 0.0, resident = 0.0;
  return file >> all >> resident ? resident * static_cast<double>(sysconf(_SC_PAGESIZE)) * 1e-6 : 0.0;
}

std::vector<std::string> shared_memory_of(int process) {
  std::set<std::string> names;
  std::ifstream maps(folder_of(process) + "/maps");
  for (std::string line; std::getline(maps, line);)
    if (const auto at = line.find("/dev/shm/"); at != std::string::npos) names.insert(line.substr(at));
  return {names.begin(), names.end()};
}

int lose(int process, double share) {
  const auto limit = static_cast<std::uint32_t>(share * 4294967295.0);
  sock_filter code[] = {BPF_STMT(BPF_LD | BPF_W | BPF_ABS, static_cast<std::uint32_t>(SKF_AD_OFF + SKF_AD_RANDOM)),
                        BPF_JUMP(BPF_JMP | BPF_JGE | BPF_K, limit, 1, 0), BPF_STMT(BPF_RET | BPF_K, 0),
                        BPF_STMT(BPF_RET | BPF_K, 0xFFFFFFFF)};
  const sock_fprog program{4, code};
  const auto handle = static_cast<int>(syscall(SYS_pidfd_open, process, 0));
  if (handle < 0) return 0;
  int count = 0;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder_of(process) + "/fd", error)) {
    if (fs::read_symlink(entry.path(), error).string().rfind("socket:", 0) != 0) continue;
    const auto socket = static_cast<int>(syscall(SYS_pidfd_getfd, handle, std::stoi(entry.path().filename().string()), 0));
    if (socket < 0) continue;
    if (lose_at(socket, program)) ++count;
    close(socket);
  }
  close(handle);
  return count;
}

}  // namespace bodeflow::test
