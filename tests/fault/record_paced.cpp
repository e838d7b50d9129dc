// Records until it is killed, and tells on standard output how much the recording has taken.
//   record_paced FOLDER           a short phase, then one in real time; every 10 ms a line `monotonic_ns samples records`
//   record_paced FOLDER phases    one short phase after the other, as fast as it goes; after each a line `0 phases 0`
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <thread>

#include "../runtime/record/recording_fixture.hpp"

using namespace bodeflow;
using namespace bodeflow::record_tests;

namespace {

bool tell(std::int64_t time_ns, std::uint64_t first, std::uint64_t second) {
  const std::string line = std::to_string(time_ns) + " " + std::to_string(first) + " " + std::to_string(second) + "\n";
  return ::write(STDOUT_FILENO, line.data(), line.size()) > 0;
}

bool record_short_phase(record::RunDirectory& run, const graph::Phase& phase, int repeat) {
  execute::Sink& sink = **run.begin_phase(phase, source_facts(), nlohmann::json::object(), repeat);
  return give_real(sink, 0, 100) && sink.record({0, 0}, numbered_record(5), 0.0) && run.end_phase({});
}

int record_phases(record::RunDirectory& run, const graph::Phase& phase) {
  for (int repeat = 0; record_short_phase(run, phase, repeat); ++repeat)
    if (!tell(0, static_cast<std::uint64_t>(repeat) + 1, 0)) return 1;
  return 1;
}

int record_in_real_time(record::RunDirectory& run, const graph::Phase& phase) {
  execute::Sink& sink = **run.begin_phase(phase, source_facts(), nlohmann::json::object(), 0);
  const auto start = std::chrono::steady_clock::now();
  for (std::uint64_t tick = 0;; ++tick) {
    std::this_thread::sleep_until(start + std::chrono::milliseconds(10) * tick);
    if (!give_real(sink, 10 * tick, 10)) return 1;
    if (!sink.record({0, 0}, numbered_record(static_cast<std::int64_t>(tick)), 0.01 * static_cast<double>(tick))) return 1;
    if (!tell(std::chrono::steady_clock::now().time_since_epoch().count(), 10 * (tick + 1), tick + 1)) return 1;
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return 2;
  const auto first = source_phase("first"), second = source_phase();
  const auto run = make_run(argv[1], source_graph({first, second}));
  if (argc > 2) return record_phases(*run, first);
  return record_short_phase(*run, first, 0) ? record_in_real_time(*run, second) : 1;
}
