#include "isolate.hpp"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>

#include "sanitized.hpp"

namespace bodeflow::testing {
namespace {

Verdict judge_here(const std::function<void(const Step&)>& work, const Step& step) {
  try {
    work(step);
    return {};
  } catch (const Skip& skip) {
    return {Status::skip, skip.reason, false};
  } catch (const std::exception& e) {
    return {Status::fail, e.what(), false};
  } catch (...) {
    return {Status::fail, "an exception of an unknown type", false};
  }
}

/// One message of the child: a letter ('s' step, 'v' verdict), the length of a text, the text.
void send(int pipe, char kind, const std::string& text) {
  std::string message(1, kind);
  const auto length = static_cast<std::uint32_t>(text.size());
  message.append(reinterpret_cast<const char*>(&length), sizeof length);
  message += text;
  for (std::size_t done = 0; done < message.size();) {
    const ssize_t n = write(pipe, message.data() + done, message.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return;
    done += static_cast<std::size_t>(n);
  }
}

/// A plugin that asks for a senseless amount of memory is to be told so, not to drive the machine into the ground.
void limit_memory() {
#if !defined(BODEFLOW_SANITIZED)
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0) return;
  std::FILE* file = std::fopen("/proc/self/statm", "r");
  if (file == nullptr) return;
  unsigned long pages = 0;
  const int read = std::fscanf(file, "%lu", &pages);
  std::fclose(file);
  if (read != 1) return;
  const rlim_t bytes = pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE)) + (rlim_t{2} << 30);
  if (limit.rlim_max == RLIM_INFINITY || bytes < limit.rlim_max) {
    limit.rlim_cur = bytes;
    setrlimit(RLIMIT_AS, &limit);
  }
#endif
}

[[noreturn]] void child(const std::function<void(const Step&)>& work, int pipe, unsigned timeout_s) {
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  limit_memory();
  for (const int signal : {SIGALRM, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTERM})
    std::signal(signal, SIG_DFL);  // not the caller's
  alarm(timeout_s);
  const Verdict verdict = judge_here(work, [pipe](const std::string& what) { send(pipe, 's', what); });
  send(pipe, 'v', std::string(1, static_cast<char>('0' + static_cast<int>(verdict.status))) + verdict.reason);
  _exit(0);
}

std::string read_all(int pipe) {
  std::string text;
  char buffer[4096];
  while (true) {
    const ssize_t n = read(pipe, buffer, sizeof buffer);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return text;
    text.append(buffer, static_cast<std::size_t>(n));
  }
}

/// The verdict in the child's messages, or what its death was.
Verdict read_verdict(const std::string& messages, int status, unsigned timeout_s) {
  std::string step;
  std::size_t at = 0;
  while (messages.size() - at >= 5) {
    std::uint32_t length = 0;
    std::memcpy(&length, messages.data() + at + 1, sizeof length);
    if (messages.size() - at - 5 < length) break;
    const std::string text = messages.substr(at + 5, length);
    if (messages[at] == 'v' && !text.empty()) return {static_cast<Status>(text[0] - '0'), text.substr(1), false};
    step = text;
    at += 5 + length;
  }
  const std::string where = step.empty() ? "" : " (" + step + ")";
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGALRM)
    return {Status::fail, "takes longer than " + std::to_string(timeout_s) + " s" + where, true};
  if (WIFSIGNALED(status)) return {Status::fail, std::string("crashes: ") + strsignal(WTERMSIG(status)) + where, false};
  return {Status::fail, "ends the process with exit code " + std::to_string(WEXITSTATUS(status)) + where, false};
}

}  // namespace

Verdict judge(const std::function<void(const Step&)>& work, bool isolate, unsigned timeout_s) {
  if (!isolate) return judge_here(work, [](const std::string&) {});
  int ends[2];
  if (pipe(ends) != 0) return {Status::fail, std::string("no pipe: ") + std::strerror(errno), false};
  std::fflush(nullptr);
  const pid_t pid = fork();
  if (pid < 0) {
    close(ends[0]);
    close(ends[1]);
    return {Status::fail, std::string("no child process: ") + std::strerror(errno), false};
  }
  if (pid == 0) {
    close(ends[0]);
    child(work, ends[1], timeout_s);
  }
  close(ends[1]);
  const std::string messages = read_all(ends[0]);
  close(ends[0]);
  int status = 0;
  while (waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  return read_verdict(messages, status, timeout_s);
}

}  // namespace bodeflow::testing
