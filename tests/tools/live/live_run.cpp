#include "tools/live/live_run.hpp"

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <stdexcept>
#include <thread>

namespace bodeflow::test {
namespace {

std::vector<std::string> command(const Folder& folder, const std::string& graph, const std::string& out,
                                 const std::vector<std::string>& more) {
  std::string text = "cd '" + folder.path().string() + "' && exec '" BODEFLOW_BUILD_DIR "/bin/bodeflow' run '" + graph +
                     "' --live --out '" + (folder.path() / out).string() + "'";
  for (const auto& word : more) text += " '" + word + "'";
  return {"sh", "-c", text + " 2>&1"};
}

}  // namespace

LiveRun::LiveRun(const Folder& folder, const std::string& graph, const std::string& out, const std::vector<std::string>& more)
    : process_(command(folder, graph, out, more)) {
  const std::string mark = "Live: ";
  if (!process_.prints(mark)) throw std::runtime_error("no page: " + process_.output());
  while (process_.output().find('\n', process_.output().find(mark)) == std::string::npos) pause();
  const std::string said = process_.output();
  const auto begin = said.find(mark) + mark.size();
  address_ = said.substr(begin, said.find('\n', begin) - begin);
  const auto colon = address_.rfind(':'), hash = address_.find('#');
  port_ = std::stoi(address_.substr(colon + 1));
  token_ = address_.substr(hash + 1);
}

void LiveRun::pause() { std::this_thread::sleep_for(std::chrono::milliseconds(50)); }

int LiveRun::hold(const std::string& bytes) const {
  const int one = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(static_cast<std::uint16_t>(port_));
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  (void)connect(one, reinterpret_cast<sockaddr*>(&to), sizeof to);  // where the backlog is full it goes on trying
  pollfd wait{one, POLLOUT, 0};
  if (poll(&wait, 1, 100) > 0) (void)send(one, bytes.data(), bytes.size(), MSG_NOSIGNAL);
  return one;
}

std::string LiveRun::raw(const std::string& bytes) const {
  const int one = hold(bytes);
  shutdown(one, SHUT_WR);
  std::string answer;
  char some[65536];
  pollfd wait{one, POLLIN, 0};
  while (poll(&wait, 1, 10'000) > 0) {
    const ssize_t got = recv(one, some, sizeof some, 0);
    if (got <= 0) break;
    answer.append(some, static_cast<std::size_t>(got));
  }
  close(one);
  return answer;
}

Answer LiveRun::request(const std::string& method, const std::string& path, const std::vector<std::string>& headers,
                        const std::string& body) const {
  std::string text = method + " " + path + " HTTP/1.1\r\n";
  for (const auto& header : headers) text += header + "\r\n";
  if (!body.empty()) text += "Content-Length: " + std::to_string(body.size()) + "\r\n";
  const std::string answer = raw(text + "\r\n" + body);
  const auto space = answer.find(' '), end = answer.find("\r\n\r\n");
  if (space == std::string::npos || end == std::string::npos) return {};
  return {std::stoi(answer.substr(space + 1)), answer.substr(end + 4)};
}

Answer LiveRun::get(const std::string& path) const { return request("GET", path, {"Host: 127.0.0.1:" + std::to_string(port_)}); }

Answer LiveRun::change(const std::string& block, const std::string& parameter, const std::string& value) const {
  const nlohmann::json body{
      {"generation", state().value("generation", 0U)}, {"block", block}, {"parameter", parameter}, {"value", value}};
  return request("POST", "/change",
                 {"Host: 127.0.0.1:" + std::to_string(port_), "Content-Type: application/json", "X-Bodeflow-Token: " + token_},
                 body.dump());
}

}  // namespace bodeflow::test
