// Records until it is killed, and tells on standard output how much the recording has taken.
//   record_paced FOLDER           a short phase, then one in real time; every 10 ms a line `monotonic_ns samples records`
//   record_paced FOLDER CALL      one short phase after the other; after each a line `0 phases 0`; kills itself before the
//                                 call number CALL, from 1, of those that change files after the eighth phase
#include <signal.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include "../runtime/record/recording_fixture.hpp"

using namespace bodeflow;
using namespace bodeflow::record_tests;

namespace {

std::atomic<long> calls_left = 0;  ///< before the process kills itself; 0: it never does

void count_call() {
  if (calls_left > 0 && --calls_left == 0) ::raise(SIGKILL);
}

}  // namespace

// The calls by which HDF5 and the recording change files, in place of the C library's.
extern "C" {
ssize_t pwrite64(int file, const void* bytes, size_t size, off64_t at) {
  count_call();
  return ::syscall(SYS_pwrite64, file, bytes, size, at);
}
ssize_t pwrite(int file, const void* bytes, size_t size, off_t at) { return pwrite64(file, bytes, size, at); }
int ftruncate64(int file, off64_t size) noexcept {
  count_call();
  return static_cast<int>(::syscall(SYS_ftruncate, file, size));
}
int ftruncate(int file, off_t size) noexcept { return ftruncate64(file, size); }
int rename(const char* from, const char* to) noexcept {
  count_call();
  return static_cast<int>(::syscall(SYS_rename, from, to));
}
int unlink(const char* path) noexcept {
  count_call();
  return static_cast<int>(::syscall(SYS_unlink, path));
}
}

namespace {

bool tell(std::int64_t time_ns, std::uint64_t first, std::uint64_t second) {
  const std::string line = std::to_string(time_ns) + " " + std::to_string(first) + " " + std::to_string(second) + "\n";
  return ::write(STDOUT_FILENO, line.data(), line.size()) > 0;
}

bool record_short_phase(record::RunDirectory& run, const graph::Phase& phase, int repeat) {
  execute::Sink& sink = **run.begin_phase(phase, source_facts(), nlohmann::json::object(), repeat);
  return give_real(sink, 0, 100) && sink.record({0, 0}, numbered_record(5), 0.0) && run.end_phase({});
}

int record_phases(record::RunDirectory& run, const graph::Phase& phase, long calls) {
  for (int repeat = 0; record_short_phase(run, phase, repeat); ++repeat) {
    if (!tell(0, static_cast<std::uint64_t>(repeat) + 1, 0)) return 1;
    if (repeat == 7) calls_left = calls;
  }
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
  if (argc > 2) return record_phases(*run, first, std::atol(argv[2]));
  return record_short_phase(*run, first, 0) ? record_in_real_time(*run, second) : 1;
}
