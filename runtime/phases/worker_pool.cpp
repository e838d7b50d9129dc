#include "phases/worker_pool.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <map>
#include <thread>

extern char** environ;

namespace bodeflow::phases {
namespace {

struct Child {
  std::size_t index = 0;
  int errors = -1;  ///< memory file that takes the child's standard error
};

/// Starts a command with its standard error in a memory file. Error: errno.
int start(const std::vector<std::string>& command, Child& child, pid_t& pid) {
  child.errors = memfd_create("stderr", MFD_CLOEXEC);
  if (child.errors < 0) return errno;
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, child.errors, STDERR_FILENO);
  std::vector<char*> arguments;
  for (const auto& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  const int error = posix_spawn(&pid, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) close(child.errors);
  return error;
}

std::string text_of(int file) {
  std::string text(4096, '\0');
  const off_t all = lseek(file, 0, SEEK_END), first = std::max<off_t>(0, all - static_cast<off_t>(text.size()));
  const ssize_t size = pread(file, text.data(), text.size(), first);
  text.resize(size > 0 ? static_cast<std::size_t>(size) : 0);
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text;
}

std::string ending(int status) {
  if (WIFSIGNALED(status)) return fmt::format("ended by signal {} ({})", WTERMSIG(status), strsignal(WTERMSIG(status)));
  return fmt::format("exit code {}", WEXITSTATUS(status));
}

}  // namespace

PoolResult run_processes(const std::vector<std::vector<std::string>>& commands, const std::atomic<bool>* stop,
                         const std::function<void(std::size_t)>& done) {
  PoolResult result;
  std::map<pid_t, Child> running;
  const std::size_t limit = std::max(1U, std::thread::hardware_concurrency());
  std::size_t next = 0, ended = 0;
  const auto fail = [&](std::size_t index, std::string message, int exit_code) {
    if (!result.failed || index < *result.failed) {
      result.failed = index;
      result.message = std::move(message);
      result.exit_code = exit_code;
    }
  };
  bool told = false;
  while (true) {
    const bool stopping = stop != nullptr && stop->load();
    while (!stopping && !result.failed && next < commands.size() && running.size() < limit) {
      Child child{next, -1};
      pid_t pid = 0;
      if (const int error = start(commands[next], child, pid); error != 0)
        fail(next, fmt::format("can't start '{}': {}", commands[next][0], strerror(error)), 1);
      else
        running.emplace(pid, child);
      ++next;
    }
    if (stopping && !told && (!running.empty() || next < commands.size())) {
      for (const auto& [pid, child] : running) kill(pid, SIGTERM);
      told = true;
      result.interrupted = true;
    }
    if (running.empty()) break;

    bool any = false;
    for (auto it = running.begin(); it != running.end();) {
      int status = 0;
      const pid_t reaped = waitpid(it->first, &status, WNOHANG);
      if (reaped < 0 && errno != EINTR) status = 1 << 8;  // somebody ignores SIGCHLD: how it ended can't be known
      if (reaped == 0 || (reaped < 0 && errno == EINTR)) {
        ++it;
        continue;
      }
      if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
        const std::string said = text_of(it->second.errors);
        fail(it->second.index, said.empty() ? ending(status) : said, WIFEXITED(status) ? WEXITSTATUS(status) : 1);
      }
      close(it->second.errors);
      it = running.erase(it);
      any = true;
      ++ended;
      if (done) done(ended);
    }
    if (!any) usleep(2000);
  }
  return result;
}

}  // namespace bodeflow::phases
