#include "transport/processes.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <thread>

Process::Process(std::vector<std::string> command, int most_s) {
  command.insert(command.begin(), {"timeout", "-k", "1", std::to_string(most_s)});
  std::string name = "/tmp/bodeflow_peer_XXXXXX";
  const int file = mkstemp(name.data());
  file_ = name;
  std::vector<char*> arguments;
  for (auto& word : command) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_ = fork();
  if (pid_ == 0) {
    dup2(file, 1);
    setpgid(0, 0);
    execvp(arguments[0], arguments.data());
    _exit(127);
  }
  setpgid(pid_, pid_);
  close(file);
}

Process::~Process() {
  if (!ended()) {
    signal(SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  unlink(file_.c_str());
}

bool Process::ended() {
  if (code_ >= 0) return true;
  int status = 0;
  if (waitpid(pid_, &status, WNOHANG) != pid_) return false;
  code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return true;
}

int Process::wait() {
  while (!ended()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  return code_;
}

void Process::signal(int number) const { kill(-pid_, number); }

void Process::interrupt() const {
  const auto id = std::to_string(pid_);
  std::ifstream children("/proc/" + id + "/task/" + id + "/children");
  if (int child = 0; children >> child) kill(child, SIGINT);
}

std::string Process::output() const {
  std::ifstream file(file_);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

bool Process::prints(const std::string& text, double seconds) {
  const auto until = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (std::chrono::steady_clock::now() < until) {
    const bool over = ended();
    if (output().find(text) != std::string::npos) return true;
    if (over) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return false;
}

std::string Process::value(const std::string& name) const {
  std::istringstream lines(output());
  std::string found;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with(name + "=")) found = line.substr(name.size() + 1);
  }
  return found;
}

double Process::number(const std::string& name) const {
  const auto text = value(name);
  return text.empty() ? -1.0 : std::stod(text);
}

int shell(const std::string& command) {
  const int status = std::system((command + " 2>/dev/null").c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

Hosts::Hosts(int count) : prefix_("bf" + std::to_string(getpid()) + "h"), count_(count) {
  if (geteuid() != 0) {
    missing_ = "network namespaces need root";
    return;
  }
  const auto bridge = "ip netns exec " + prefix_ + "s ";
  if (shell("ip netns add " + prefix_ + "s") != 0 || shell(bridge + "ip link add br0 type bridge") != 0) {
    missing_ = "network namespaces or bridges are not permitted here";
    return;
  }
  shell(bridge + "ip link set br0 type bridge mcast_snooping 0");
  shell(bridge + "ip link set br0 up");
  for (int host = 0; host < count; ++host) {
    const auto in = "ip netns exec " + name(host) + " ";
    const auto port = "p" + std::to_string(host);
    const bool made =
        shell("ip netns add " + name(host)) == 0 &&
        shell("ip link add " + port + " netns " + prefix_ + "s type veth peer name eth0 netns " + name(host)) == 0 &&
        shell(bridge + "ip link set " + port + " master br0 up") == 0 &&
        shell(in + "ip address add " + address(host) + "/24 dev eth0") == 0 && shell(in + "ip link set lo up") == 0 &&
        shell(in + "ip link set eth0 up") == 0 && shell(in + "ip route add 224.0.0.0/4 dev eth0") == 0;
    if (!made) missing_ = "virtual network links are not permitted here";
  }
}

Hosts::~Hosts() {
  shell("ip netns del " + prefix_ + "s");
  for (int host = 0; host < count_; ++host) shell("ip netns del " + name(host));
}

std::vector<std::string> Hosts::on(int host, std::vector<std::string> command) const {
  command.insert(command.begin(), {"ip", "netns", "exec", name(host)});
  return command;
}

void Hosts::link(int host, bool up) const {
  shell("ip netns exec " + prefix_ + "s ip link set p" + std::to_string(host) + (up ? " up" : " down"));
}

unsigned test_domain() { return 20 + static_cast<unsigned>(getpid()) % 200; }

std::vector<std::string> peer(const std::string& what, std::vector<std::string> options) {
  std::vector<std::string> command = {TRANSPORT_PEER, what, "domain=" + std::to_string(test_domain())};
  command.insert(command.end(), options.begin(), options.end());
  return command;
}
