#include "iiod_emulator.hpp"

#include <netinet/in.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace bodeflow::test {
namespace {

constexpr std::uint32_t kVoltage0 = 1, kVoltage1 = 2, kTemp0 = 4, kTimestamp = 8;

double now_s() {
  timespec t{};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

void sleep_a_little() {
  const timespec pause{0, 200'000};
  nanosleep(&pause, nullptr);
}

std::vector<std::string> words_of(const std::string& line) {
  std::istringstream stream(line);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

std::string code(int value) { return std::to_string(value) + "\n"; }
std::string with_length(const std::string& text) { return std::to_string(text.size()) + "\n" + text + "\n"; }

}  // namespace

/// The bytes of one client.
class IiodEmulator::Connection {
 public:
  explicit Connection(int socket) : socket_(socket) {}

  bool line(std::string& text) {
    text.clear();
    for (char c = 0; take(&c, 1);) {
      if (c == '\n') return true;
      if (c != '\r') text += c;
    }
    return false;
  }
  bool take(char* to, std::size_t size) {
    for (std::size_t done = 0; done < size;) {
      const auto got = recv(socket_, to + done, size - done, 0);
      if (got <= 0) return false;
      done += static_cast<std::size_t>(got);
    }
    return true;
  }
  bool give(const std::string& bytes) {
    for (std::size_t done = 0; done < bytes.size();) {
      const auto put = send(socket_, bytes.data() + done, bytes.size() - done, MSG_NOSIGNAL);
      if (put <= 0) return false;
      done += static_cast<std::size_t>(put);
    }
    return true;
  }

 private:
  int socket_;
};

IiodEmulator::IiodEmulator(Settings settings) : settings_(std::move(settings)) {
  attributes_ = {
      {"device/sampling_frequency", "1000"}, {"device/range", "10"},         {"voltage0/scale", "0.5"}, {"voltage1/scale", "2"},
      {"voltage1/offset", "-2048"},          {"voltage0/hardwaregain", "1"}, {"temp0/scale", "0.5"}};
  listener_ = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  if (bind(listener_, reinterpret_cast<sockaddr*>(&address), size) != 0 || listen(listener_, 8) != 0 ||
      getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size) != 0)
    throw std::runtime_error("no port for the emulator");
  port_ = ntohs(address.sin_port);
  threads_.emplace_back([this] { accept_all(); });
}

IiodEmulator::~IiodEmulator() {
  stopping_ = true;
  shutdown(listener_, SHUT_RDWR);
  threads_.front().join();
  {
    const std::lock_guard lock(mutex_);
    for (const int s : sockets_) shutdown(s, SHUT_RDWR);
  }
  for (std::size_t i = 1; i < threads_.size(); ++i) threads_[i].join();
  for (const int s : sockets_) close(s);
  close(listener_);
}

std::string IiodEmulator::uri() const { return "ip:127.0.0.1:" + std::to_string(port_); }

std::string IiodEmulator::attribute(const std::string& name) const {
  const std::lock_guard lock(mutex_);
  const auto found = attributes_.find(name);
  return found == attributes_.end() ? "" : found->second;
}

void IiodEmulator::accept_all() {
  while (!stopping_) {
    const int client = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
    if (client < 0) continue;
    const std::lock_guard lock(mutex_);
    sockets_.push_back(client);
    threads_.emplace_back([this, client] { serve(client); });
  }
}

void IiodEmulator::serve(int socket) {
  Connection connection(socket);
  std::string line;
  while (connection.line(line)) {
    const auto words = words_of(line);
    if (words.empty()) continue;
    if (words[0] == "EXIT") break;
    const std::string bytes = answer(words, connection);
    if (pulled_) {
      const std::lock_guard lock(mutex_);
      for (const int s : sockets_) shutdown(s, SHUT_RDWR);
      return;
    }
    if (!connection.give(bytes)) return;
  }
  shutdown(socket, SHUT_RDWR);
}

std::string IiodEmulator::answer(const std::vector<std::string>& words, Connection& connection) {
  const std::string& command = words[0];
  if (command == "VERSION") return "0.24.emulate\n";
  if (command == "PRINT") return with_length(xml());
  if (command == "TIMEOUT" || command == "CLOSE" || command == "GETTRIG") return code(0);
  if (command == "READ") return read_attribute(words);
  if (command == "READBUF") return read_buffer(std::stoul(words.at(2)));
  if (command == "WRITE") {  // WRITE device [INPUT channel] name bytes
    std::string value(std::stoul(words.back()), '\0');
    connection.take(value.data(), value.size());
    while (!value.empty() && value.back() == '\0') value.pop_back();
    const std::string& name = words[words.size() - 2];
    const std::string owner = words.at(2) == "INPUT" ? words.at(3) : "device";
    const std::lock_guard lock(mutex_);
    if (name == "range" && value != "5" && value != "10") return code(-22);
    if (name == "range") attributes_["voltage0/scale"] = value == "5" ? "0.25" : "0.5";
    attributes_[owner + "/" + name] =
        name == "sampling_frequency" && settings_.slow_rate > 0 ? std::to_string(settings_.slow_rate) : value;
    return code(static_cast<int>(std::stoul(words.back())));
  }
  const std::lock_guard lock(mutex_);
  if (command == "SETTRIG") {
    attributes_["device/trigger"] = words.size() > 2 ? words[2] : "";
    return code(0);
  }
  if (command == "SET") {  // SET device BUFFERS_COUNT n
    kernel_buffers_ = std::stoul(words.at(3));
    return code(0);
  }
  if (command == "OPEN") {  // OPEN device samples mask
    buffer_samples_ = std::stoul(words.at(2));
    mask_ = static_cast<std::uint32_t>(std::stoul(words.at(3), nullptr, 16));
    rate_hz_ = std::stod(attributes_["device/sampling_frequency"]);
    started_s_ = now_s();
    next_ = 0;
    next_loss_ = 0;
    return code(0);
  }
  return code(-22);
}

std::string IiodEmulator::read_attribute(const std::vector<std::string>& words) const {
  const std::string value = attribute((words.at(2) == "INPUT" ? words.at(3) : "device") + "/" + words.back());
  return value.empty() ? code(-2) : with_length(value);
}

std::size_t IiodEmulator::sample_bytes() const {
  return (mask_ & kTimestamp) != 0 ? 16 : (mask_ & kTemp0) != 0 ? 8 : mask_ == 3 ? 4 : 2;
}

std::string IiodEmulator::read_buffer(std::size_t bytes) {
  const auto count = static_cast<std::int64_t>(bytes / sample_bytes());
  const auto due = [&] { return static_cast<std::int64_t>((now_s() - started_s_) * rate_hz_); };
  const auto room = static_cast<std::int64_t>(kernel_buffers_ * buffer_samples_);
  if (settings_.hold_at >= 0 && next_ >= settings_.hold_at && !held_) {
    held_ = true;
    for (const double until = now_s() + settings_.hold_s; !stopping_ && now_s() < until;) sleep_a_little();
  }
  if (const std::int64_t lost = due() - room - next_; lost > 0) {
    dropped_ += lost;
    next_ += lost;
  }
  std::string samples;
  for (std::int64_t n = 0; n < count; ++n, ++next_) {
    if (next_loss_ < settings_.losses.size() && next_ >= settings_.losses[next_loss_].index)
      next_ += settings_.losses[next_loss_++].samples;
    if (settings_.pull_at >= 0 && next_ >= settings_.pull_at) {
      pulled_ = true;
      return {};
    }
    put_sample(next_, samples);
  }
  while (!stopping_ && (due() < next_ || (settings_.stall_at >= 0 && next_ >= settings_.stall_at))) sleep_a_little();
  char mask[10];
  std::snprintf(mask, sizeof mask, "%08x\n", mask_);
  return std::to_string(samples.size()) + "\n" + mask + samples;
}

void IiodEmulator::put_sample(std::int64_t index, std::string& to) const {
  const auto bits = static_cast<std::uint64_t>(index);
  const auto put = [&](std::uint64_t word, int bytes) {
    while (to.size() % static_cast<std::size_t>(bytes) != 0) to += '\0';
    for (int b = 0; b < bytes; ++b) to += static_cast<char>(word >> (8 * b));
  };
  if ((mask_ & kVoltage0) != 0) put(bits, 2);
  if ((mask_ & kVoltage1) != 0) {  // big-endian, in the upper 12 bits, with rubbish below
    const std::uint64_t word = ((bits >> 16) & 0xFFF) << 4 | 0x9;
    to += static_cast<char>(word >> 8);
    to += static_cast<char>(word);
  }
  if ((mask_ & kTemp0) != 0) put((51'000ULL << 8) | 0x77, 4);  // 51000 half thousandths of a degree
  if ((mask_ & kTimestamp) != 0) put(static_cast<std::uint64_t>(std::llround(1e9 * static_cast<double>(index) / rate_hz_)), 8);
  while (to.size() % sample_bytes() != 0) to += '\0';
}

std::string IiodEmulator::xml() const {
  std::string text =
      "<?xml version=\"1.0\" encoding=\"utf-8\"?><!DOCTYPE context [<!ELEMENT context (device | context-attribute)*>"
      "<!ELEMENT context-attribute EMPTY><!ELEMENT device (channel | attribute)*><!ELEMENT channel (scan-element?, attribute*)>"
      "<!ELEMENT attribute EMPTY><!ELEMENT scan-element EMPTY>"
      "<!ATTLIST context name CDATA #REQUIRED version-major CDATA #REQUIRED version-minor CDATA #REQUIRED version-git CDATA "
      "#REQUIRED description CDATA #IMPLIED><!ATTLIST device id CDATA #REQUIRED name CDATA #IMPLIED>"
      "<!ATTLIST channel id CDATA #REQUIRED type (input|output) #REQUIRED name CDATA #IMPLIED>"
      "<!ATTLIST scan-element index CDATA #REQUIRED format CDATA #REQUIRED>"
      "<!ATTLIST attribute name CDATA #REQUIRED filename CDATA #IMPLIED>]>"
      "<context name=\"local\" version-major=\"0\" version-minor=\"24\" version-git=\"emulate\" description=\"emulator\">"
      "<device id=\"iio:device0\" name=\"counter\">";
  const auto channel = [&](const char* id, const char* name, int index, const char* format, std::vector<const char*> attributes) {
    text += "<channel id=\"" + std::string(id) + "\" type=\"input\"" + (*name != 0 ? " name=\"" + std::string(name) + "\"" : "") +
            "><scan-element index=\"" + std::to_string(index) + "\" format=\"" + format + "\" />";
    for (const char* a : attributes) text += "<attribute name=\"" + std::string(a) + "\" filename=\"in_" + id + "_" + a + "\" />";
    text += "</channel>";
  };
  channel("voltage0", "vin", 0, "le:s16/16&gt;&gt;0", {"scale", "hardwaregain"});
  channel("voltage1", "", 1, "be:u12/16&gt;&gt;4", {"scale", "offset"});
  channel("temp0", "", 2, "le:s24/32&gt;&gt;8", {"scale"});
  channel("timestamp", "", 3, "le:s64/64&gt;&gt;0", {});
  if (settings_.tells_rate) text += "<attribute name=\"sampling_frequency\" />";
  return text + "<attribute name=\"range\" /></device><device id=\"trigger0\" name=\"timer\"></device></context>";
}

}  // namespace bodeflow::test
