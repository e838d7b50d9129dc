// One process of the benchmark: bench_transport ours|bare ROLE CARRIER DATAGRAM DOMAIN BYTES COUNT; tests/bench/transport/run
// starts two. Roles: source and sink (throughput), ping and pong (latency), sources and sinks (64 streams, 100 blocks a second).
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <thread>
#include <vector>

#include "link.hpp"

namespace {

using Clock = std::chrono::steady_clock;
constexpr int kStreams = 64;
constexpr auto kReceipt = std::chrono::milliseconds(200);  // the sender hears that all has come
constexpr auto kBlock = std::chrono::milliseconds(10);

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

double cpu_s() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
         1e-6 * static_cast<double>(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
}

struct Task {
  bool ours;
  Way way;
  std::size_t bytes;
  int count;
  std::unique_ptr<Sender> sender(const std::string& topic) const {
    return ours ? our_sender(way, topic) : bare_sender(way, topic);
  }
  std::unique_ptr<Receiver> receiver(const std::string& topic) const {
    return ours ? our_receiver(way, topic) : bare_receiver(way, topic);
  }
};

void sink(const Task& task) {
  auto receiver = task.receiver("data");
  receiver->next();
  const auto begin = Clock::now();
  for (int k = 1; k < task.count; ++k) receiver->next();
  std::printf("%.3f\n", static_cast<double>(task.bytes) * (task.count - 1) / seconds_since(begin) / 1e6);  // MB/s
  std::this_thread::sleep_for(kReceipt);
}

void source(const Task& task) {
  auto sender = task.sender("data");
  sender->connect();
  const std::vector<std::byte> bytes(task.bytes);
  for (int k = 0; k < task.count; ++k) sender->send(bytes);
  sender->drain();
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
}

void ping(const Task& task) {
  auto back = task.receiver("back");
  auto out = task.sender("out");
  out->connect();
  const std::vector<std::byte> bytes(task.bytes);
  std::vector<double> times;
  for (int k = 0; k < task.count; ++k) {
    const auto begin = Clock::now();
    out->send(bytes);
    back->next();
    if (k >= task.count / 10) times.push_back(seconds_since(begin) / 2 * 1e6);
    std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
  std::sort(times.begin(), times.end());
  std::printf("%.2f\n", times[times.size() / 2]);  // us, one way
}

void pong(const Task& task) {
  auto in = task.receiver("out");
  auto back = task.sender("back");
  back->connect();
  const std::vector<std::byte> bytes(task.bytes);
  for (int k = 0; k < task.count; ++k) {
    in->next();
    back->send(bytes);
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
}

void sources(const Task& task) {
  std::vector<std::unique_ptr<Sender>> senders;
  for (int s = 0; s < kStreams; ++s) senders.push_back(task.sender("s" + std::to_string(s)));
  for (auto& sender : senders) sender->connect();
  const std::vector<std::byte> bytes(task.bytes);
  const auto begin = Clock::now();
  const double cpu = cpu_s();
  double late = 0.0;
  for (int k = 0; k < task.count; ++k) {
    std::this_thread::sleep_until(begin + k * kBlock);
    for (auto& sender : senders) sender->send(bytes);
    late = std::max(late, seconds_since(begin + k * kBlock));
  }
  std::fprintf(stderr, "64 streams: %d blocks each in %.2f s, %.0f %% of a core to send, at most %.1f ms late\n", task.count,
               seconds_since(begin), 100 * (cpu_s() - cpu) / seconds_since(begin), 1e3 * late);
  for (auto& sender : senders) sender->drain();
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
}

void sinks(const Task& task) {
  std::vector<std::unique_ptr<Receiver>> receivers;
  for (int s = 0; s < kStreams; ++s) receivers.push_back(task.receiver("s" + std::to_string(s)));
  const double cpu = cpu_s();
  const auto begin = Clock::now();
  for (int k = 0; k < task.count; ++k)
    for (auto& receiver : receivers) receiver->next();
  std::printf("%.2f\n", 100 * (cpu_s() - cpu) / seconds_since(begin));  // % of a core to receive
  std::this_thread::sleep_for(kReceipt);
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 8) return 2;
  const std::string role = arguments[2];
  const auto number = [&](int i) { return std::atoi(arguments[i]); };
  const Task task{std::string(arguments[1]) == "ours",
                  {arguments[3], static_cast<unsigned>(number(4)), static_cast<unsigned>(number(5))},
                  static_cast<std::size_t>(number(6)),
                  number(7)};
  if (role == "sink") sink(task);
  if (role == "source") source(task);
  if (role == "ping") ping(task);
  if (role == "pong") pong(task);
  if (role == "sinks") sinks(task);
  if (role == "sources") sources(task);
  std::fflush(nullptr);
  std::_Exit(0);  // the library's own clean-up is not measured
}
