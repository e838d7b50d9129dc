// Records a short phase, then one that goes on in real time until the process is killed. After every 10 ms it tells on
// standard output how much the recording has taken: a line `monotonic_ns samples records`.
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <thread>

#include "../runtime/record/recording_fixture.hpp"

using namespace bodeflow;
using namespace bodeflow::record_tests;

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const auto first = source_phase("first"), second = source_phase();
  const auto run = make_run(argv[1], source_graph({first, second}));
  execute::Sink& before = **run->begin_phase(first, source_facts(), nlohmann::json::object(), 0);
  if (!give_real(before, 0, 100) || !before.record({0, 0}, numbered_record(5), 0.0) || !run->end_phase({})) return 1;

  execute::Sink& sink = **run->begin_phase(second, source_facts(), nlohmann::json::object(), 0);
  const auto start = std::chrono::steady_clock::now();
  for (std::uint64_t tick = 0;; ++tick) {
    std::this_thread::sleep_until(start + std::chrono::milliseconds(10) * tick);
    if (!give_real(sink, 10 * tick, 10)) return 1;
    if (!sink.record({0, 0}, numbered_record(static_cast<std::int64_t>(tick)), 0.01 * static_cast<double>(tick))) return 1;
    const std::string line = std::to_string(std::chrono::steady_clock::now().time_since_epoch().count()) + " " +
                             std::to_string(10 * (tick + 1)) + " " + std::to_string(tick + 1) + "\n";
    if (::write(STDOUT_FILENO, line.data(), line.size()) < 0) return 1;
  }
}
