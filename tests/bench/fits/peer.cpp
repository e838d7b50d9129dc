#include "peer.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>

namespace bench {

Peer::Peer(const std::vector<std::string>& command) {
  std::signal(SIGPIPE, SIG_IGN);
  int to[2], from[2];
  if (pipe(to) != 0 || pipe(from) != 0) std::exit(1);
  child_ = fork();
  if (child_ == 0) {
    dup2(to[0], 0);
    dup2(from[1], 1);
    for (const int end : {to[0], to[1], from[0], from[1]}) close(end);
    std::vector<char*> arguments;
    for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    execvp(arguments[0], arguments.data());
    std::_Exit(127);
  }
  close(to[0]);
  close(from[1]);
  commands_ = fdopen(to[1], "w");
  answers_ = fdopen(from[0], "r");
  banner_ = line();
}

Peer::~Peer() {
  std::fclose(commands_);
  std::fclose(answers_);
  waitpid(child_, nullptr, 0);
}

std::string Peer::line() {
  char text[400];
  if (std::fgets(text, sizeof text, answers_) == nullptr) return {};
  std::string read = text;
  while (!read.empty() && read.back() == '\n') read.pop_back();
  return read;
}

std::optional<Call> Peer::call(const std::string& command) {
  if (std::fprintf(commands_, "%s\n", command.c_str()) < 0 || std::fflush(commands_) != 0) return {};
  Call answer;
  const std::string text = line();
  if (std::sscanf(text.c_str(), "%lf %lf %d %d", &answer.cpu_s, &answer.rms, &answer.unstable, &answer.tunings) != 4) return {};
  return answer;
}

}  // namespace bench
