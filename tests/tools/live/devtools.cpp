#include "tools/live/devtools.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <stdexcept>
#include <thread>

namespace bodeflow::test {
namespace {

using nlohmann::json;

constexpr int kPatience_ms = 30'000;

std::string decoded_base64(const std::string& text) {
  static const std::string kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  unsigned bits = 0;
  int count = 0;
  for (const char c : text) {
    const auto place = kLetters.find(c);
    if (place == std::string::npos) continue;
    bits = bits << 6U | static_cast<unsigned>(place);
    count += 6;
    if (count >= 8) out += static_cast<char>(bits >> static_cast<unsigned>(count -= 8) & 0xFFU);
  }
  return out;
}

}  // namespace

Browser::Browser(const std::string& program, int width, int height, bool dark) {
  int down[2], up[2];
  if (pipe2(down, O_CLOEXEC) != 0 || pipe2(up, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
  std::vector<std::string> words{program,
                                 "--headless=new",
                                 "--no-sandbox",
                                 "--disable-gpu",
                                 "--disable-quic",
                                 "--no-first-run",
                                 "--disable-background-networking",
                                 "--disable-component-update",
                                 "--disable-sync",
                                 "--disable-dev-shm-usage",
                                 "--hide-scrollbars",
                                 "--remote-debugging-pipe",
                                 "--window-size=" + std::to_string(width) + "," + std::to_string(height),
                                 std::string("--blink-settings=preferredColorScheme=") + (dark ? "0" : "1"),
                                 "--user-data-dir=" + profile_.path().string(),
                                 "about:blank"};
  std::vector<char*> arguments;
  for (auto& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  process_ = fork();
  if (process_ == 0) {
    setpgid(0, 0);
    const int silent = ::open("/dev/null", O_RDWR);
    dup2(silent, 1);
    dup2(silent, 2);
    const int in = fcntl(down[0], F_DUPFD, 10), out = fcntl(up[1], F_DUPFD, 10);  // 3 and 4 may be among the pipes
    dup2(in, 3);
    dup2(out, 4);
    close(in);
    close(out);
    execvp(arguments[0], arguments.data());
    _exit(127);
  }
  close(down[0]);
  close(up[1]);
  to_ = down[1];
  from_ = up[0];
  const json made = call("Target.createTarget", {{"url", "about:blank"}});
  session_ = call("Target.attachToTarget", {{"targetId", made.at("targetId")}, {"flatten", true}}).at("sessionId");
  call("Runtime.enable");
  call("Log.enable");
  call("Page.enable");
  call("Emulation.setDeviceMetricsOverride", {{"width", width}, {"height", height}, {"deviceScaleFactor", 1}, {"mobile", false}});
}

Browser::~Browser() {
  close(to_);
  close(from_);
  kill(-process_, SIGKILL);
  waitpid(process_, nullptr, 0);
}

json Browser::next() {
  while (true) {
    if (const auto end = buffer_.find('\0'); end != std::string::npos) {
      json message = json::parse(buffer_.substr(0, end));
      buffer_.erase(0, end + 1);
      return message;
    }
    pollfd one{from_, POLLIN, 0};
    char bytes[65536];
    if (poll(&one, 1, kPatience_ms) <= 0) throw std::runtime_error("the browser does not answer");
    const ssize_t got = read(from_, bytes, sizeof bytes);
    if (got <= 0) throw std::runtime_error("the browser is gone");
    buffer_.append(bytes, static_cast<std::size_t>(got));
  }
}

json Browser::call(const std::string& method, json parameters) {
  json request{{"id", ++number_}, {"method", method}, {"params", std::move(parameters)}};
  if (!session_.empty()) request["sessionId"] = session_;
  const std::string text = request.dump() + '\0';
  for (std::size_t sent = 0; sent < text.size();) {
    const ssize_t some = write(to_, text.data() + sent, text.size() - sent);
    if (some <= 0) throw std::runtime_error("the browser is gone");
    sent += static_cast<std::size_t>(some);
  }
  while (true) {
    const json message = next();
    if (message.value("id", 0) == number_) {
      if (message.contains("error")) throw std::runtime_error(method + ": " + message["error"].dump());
      return message.value("result", json::object());
    }
    const std::string event = message.value("method", "");
    if (event == "Runtime.exceptionThrown" || event == "Runtime.consoleAPICalled" || event == "Log.entryAdded")
      complaints_.push_back(message["params"].dump());
  }
}

void Browser::open(const std::string& address) { call("Page.navigate", {{"url", address}}); }

json Browser::value(const std::string& expression) {
  const json answer = call("Runtime.evaluate", {{"expression", expression}, {"returnByValue", true}, {"awaitPromise", true}});
  if (answer.contains("exceptionDetails")) return nullptr;
  return answer["result"].value("value", json());
}

bool Browser::becomes(const std::string& expression, double seconds) {
  const auto until = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (value(expression) != true) {
    if (std::chrono::steady_clock::now() > until) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return true;
}

std::string Browser::screenshot() {
  return decoded_base64(call("Page.captureScreenshot", {{"format", "png"}, {"captureBeyondViewport", true}}).at("data"));
}

}  // namespace bodeflow::test
