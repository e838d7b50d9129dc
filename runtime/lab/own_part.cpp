#include "lab/own_part.hpp"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstring>
#include <thread>

extern char** environ;

namespace bodeflow::lab {

tl::expected<void, std::string> OwnPart::start(std::vector<std::string> command, const std::vector<std::string>& options) {
  command.insert(command.end(), options.begin(), options.end());
  std::vector<char*> arguments;
  for (std::string& word : command) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const int failed = posix_spawn(&pid_, arguments[0], nullptr, nullptr, arguments.data(), environ);
  if (failed == 0) return {};
  pid_ = 0;
  return tl::unexpected(std::string("can't start ") + arguments[0] + ": " + std::strerror(failed));
}

bool OwnPart::runs() {
  if (pid_ > 0 && waitpid(pid_, nullptr, WNOHANG) == pid_) pid_ = 0;
  return pid_ > 0;
}

void OwnPart::end() {
  for (int i = 0; i < 40 && runs(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(50));
  if (pid_ <= 0) return;
  kill(pid_, SIGKILL);
  waitpid(pid_, nullptr, 0);
  pid_ = 0;
}

}  // namespace bodeflow::lab
