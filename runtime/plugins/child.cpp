#include "plugins/child.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <utility>

namespace bodeflow {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kMostOutput = std::size_t{64} << 20U;
constexpr std::size_t kMostMessages = 8192;

/// A file descriptor that closes itself.
class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int fd) : fd_(fd) {}
  Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  ~Descriptor() { close(); }
  void close() {
    if (fd_ >= 0) ::close(std::exchange(fd_, -1));
  }
  int get() const { return fd_; }

 private:
  int fd_ = -1;
};

struct Pipe {
  Descriptor read, write;
  bool open() {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) return false;
    read = Descriptor(ends[0]);
    write = Descriptor(ends[1]);
    return true;
  }
};

/// 0 and the child's id, or an error number.
int spawn(const std::vector<std::string>& arguments, const Pipe& output, const Pipe& messages, pid_t& child) {
  std::vector<char*> argv;
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, output.write.get(), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, messages.write.get(), STDERR_FILENO);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t none, fatal;
  sigemptyset(&none);
  sigemptyset(&fatal);
  for (const int number : {SIGPIPE, SIGINT, SIGTERM, SIGSEGV, SIGABRT}) sigaddset(&fatal, number);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setsigdefault(&attributes, &fatal);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  const int error = posix_spawn(&child, argv[0], &actions, &attributes, argv.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  return error;
}

/// Appends what is there to read; closes the descriptor at its end.
void take(Descriptor& from, std::string& to) {
  std::array<char, 65536> piece;
  const ssize_t size = ::read(from.get(), piece.data(), piece.size());
  if (size > 0) {
    to.append(piece.data(), static_cast<std::size_t>(size));
  } else if (size == 0 || (errno != EINTR && errno != EAGAIN)) {
    from.close();
  }
}

/// Reads both pipes to their ends; false when the time is over or the output too large.
bool collect(Descriptor& output, Descriptor& messages, ChildResult& result, Clock::time_point deadline) {
  while (output.get() >= 0 || messages.get() >= 0) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
    if (left <= 0 || result.output.size() > kMostOutput) return false;
    // poll ignores negative descriptors
    std::array<pollfd, 2> wait{pollfd{output.get(), POLLIN, 0}, pollfd{messages.get(), POLLIN, 0}};
    if (::poll(wait.data(), wait.size(), static_cast<int>(std::min<long long>(left, 1000))) <= 0) continue;
    if (wait[0].revents != 0) take(output, result.output);
    if (wait[1].revents != 0) {
      take(messages, result.messages);
      if (result.messages.size() > kMostMessages) result.messages.erase(0, result.messages.size() - kMostMessages);
    }
  }
  return true;
}

/// Waits for the child's end; kills it at the deadline (it may have closed its output and go on).
int wait_for(pid_t child, Clock::time_point deadline, bool& timed_out) {
  int status = 0;
  for (;;) {
    const pid_t ended = ::waitpid(child, &status, timed_out ? 0 : WNOHANG);
    if (ended == child || (ended < 0 && errno != EINTR)) return status;
    if (ended == 0 && Clock::now() >= deadline) {
      ::kill(child, SIGKILL);
      timed_out = true;
    } else if (ended == 0) {
      ::poll(nullptr, 0, 1);
    }
  }
}

}  // namespace

tl::expected<ChildResult, std::string> run_child(const std::vector<std::string>& arguments, double timeout_s) {
  const auto deadline = Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(timeout_s));
  Pipe output, messages;
  if (!output.open() || !messages.open()) return tl::unexpected(std::string("no pipe: ") + std::strerror(errno));
  pid_t child = -1;
  if (const int error = spawn(arguments, output, messages, child); error != 0) {
    return tl::unexpected(arguments[0] + " can't be started: " + std::strerror(error));
  }
  output.write.close();
  messages.write.close();
  ChildResult result;
  if (!collect(output.read, messages.read, result, deadline)) {
    result.timed_out = true;
    ::kill(child, SIGKILL);
  }
  const int status = wait_for(child, deadline, result.timed_out);
  if (!result.timed_out && WIFEXITED(status)) result.exit_code = WEXITSTATUS(status);
  if (!result.timed_out && WIFSIGNALED(status)) result.signal = WTERMSIG(status);
  return result;
}

}  // namespace bodeflow
