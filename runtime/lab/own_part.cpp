#include "lab/own_part.hpp"

#include <signal.h>
#include <sys/wait.h>

#include <chrono>
#include <thread>

#include "lab/part_process.hpp"

namespace bodeflow::lab {

tl::expected<void, std::string> OwnPart::start(const std::vector<std::string>& command, const std::vector<std::string>& options) {
  return start_part(command, options).map([this](pid_t pid) { pid_ = pid; });
}

bool OwnPart::runs() {
  int status = 0;
  if (pid_ > 0 && waitpid(pid_, &status, WNOHANG) == pid_) {
    pid_ = 0;
    end_text_ = how_it_ended(status);
  }
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
