// Compute threads of a realtime run that is recorded take no memory from the heap, no lock, and call the system only to wait:
// blocks that say they are real-time safe, and the engine around them. A thread is a compute thread from the first samples on
// that it hands to the sink.
#include <dlfcn.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <pthread.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <ucontext.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <map>
#include <thread>

#include "catch.hpp"
#include "execute/execute.hpp"
#include "graph/load.hpp"
#include "observe/watch.hpp"
#include "phases/prepare.hpp"
#include "record/run_directory.hpp"
#include "runtime/record/temporary_folder.hpp"

#if defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

namespace {

constexpr std::size_t kCalls = 512;
std::atomic<bool> counting{false};
std::atomic<long> allocations{0}, locks{0}, calls[kCalls];
thread_local bool is_compute = false;

void count_in(std::atomic<long>& what) {
  if (counting.load(std::memory_order_relaxed) && is_compute) what.fetch_add(1, std::memory_order_relaxed);
}

void count() { count_in(allocations); }

// The only place whose system calls are let through: the filter tells it by its address.
__asm__(
    ".text\n"
    "let_through:\n"
    "  mov %rdi, %rax\n  mov %rsi, %rdi\n  mov %rdx, %rsi\n  mov %rcx, %rdx\n"
    "  mov %r8, %r10\n  mov %r9, %r8\n  mov 8(%rsp), %r9\n"
    "  syscall\n"
    "after_let_through:\n"
    "  ret\n");
extern "C" long let_through(long number, long a, long b, long c, long d, long e, long f);
extern "C" const char after_let_through;

void on_system_call(int, siginfo_t* info, void* context) {
  const auto number = static_cast<std::size_t>(info->si_syscall);
  if (number < kCalls) count_in(calls[number]);
  greg_t* r = static_cast<ucontext_t*>(context)->uc_mcontext.gregs;
  r[REG_RAX] = let_through(info->si_syscall, r[REG_RDI], r[REG_RSI], r[REG_RDX], r[REG_R10], r[REG_R8], r[REG_R9]);
}

/// From now on each system call of this thread is counted. False: the system does not permit it.
bool watch_system_calls() {
  struct sigaction action {};
  action.sa_sigaction = on_system_call;
  action.sa_flags = SA_SIGINFO | SA_NODEFER;
  if (sigaction(SIGSYS, &action, nullptr) != 0) return false;
  const auto address = reinterpret_cast<std::uintptr_t>(&after_let_through);
  const auto field = [](std::size_t offset) {
    return sock_filter(BPF_STMT(BPF_LD | BPF_W | BPF_ABS, static_cast<std::uint32_t>(offset)));
  };
  sock_filter code[] = {field(offsetof(seccomp_data, nr)),
                        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_rt_sigreturn, 4, 0),
                        field(offsetof(seccomp_data, instruction_pointer)),
                        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, static_cast<std::uint32_t>(address), 0, 3),
                        field(offsetof(seccomp_data, instruction_pointer) + 4),
                        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, static_cast<std::uint32_t>(address >> 32U), 0, 1),
                        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
                        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_TRAP)};
  const sock_fprog program{static_cast<unsigned short>(std::size(code)), code};
  return prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 && prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
}

}  // namespace

extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

void* malloc(std::size_t size) {
  count();
  return __libc_malloc(size);
}
void* calloc(std::size_t number, std::size_t size) {
  count();
  return __libc_calloc(number, size);
}
void* realloc(void* memory, std::size_t size) {
  count();
  return __libc_realloc(memory, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  count();
  return __libc_memalign(alignment, size);
}
int pthread_mutex_lock(pthread_mutex_t* mutex) {
  static std::atomic<int (*)(pthread_mutex_t*)> real{nullptr};
  if (real == nullptr) real = reinterpret_cast<int (*)(pthread_mutex_t*)>(dlsym(RTLD_NEXT, "pthread_mutex_lock"));
  count_in(locks);
  return real.load()(mutex);
}
}

namespace bodeflow::test {
namespace {

/// Marks the threads that give samples, and hands all on to the recording.
class Watch final : public execute::Sink {
 public:
  Watch(execute::Sink& recording, std::function<void()> mischief) : recording_(recording), mischief_(std::move(mischief)) {}

  tl::expected<void, std::string> samples(int recorded, const void* const* channels, std::uint64_t count) override {
    if (!is_compute && !watch_system_calls()) return tl::unexpected(std::string("this system lets no thread be watched"));
    is_compute = true;
    if (recorded == 0 && (taken_ += count) > 295) counting = false;  // what comes is the end of the run
    if (mischief_) mischief_();
    return recording_.samples(recorded, channels, count);
  }
  tl::expected<void, std::string> record(graph::End from, const SharedRecord& record, double time_s) override {
    return recording_.record(from, record, time_s);
  }
  void changed(int block, int parameter, const ParameterValue& value, std::uint64_t position, execute::Cause cause) override {
    recording_.changed(block, parameter, value, position, cause);
  }

 private:
  execute::Sink& recording_;
  std::function<void()> mischief_;
  std::uint64_t taken_ = 0;
};

constexpr const char* kGraph =
    "bodeflow: 1\n"
    "run: {clock: realtime, duration: 300 ms, chunk: 1, on_overrun: skip, priority: 10}\n"
    "blocks:\n"
    "  reference: {block: generators.sine, sample_rate: 1 kHz, frequency: 7 Hz}\n"
    "  noise: {block: generators.noise, sample_rate: 1 kHz, std: 0.1}\n"
    "  sum: {block: filters.sum, weights: [1, 1, -1]}\n"
    "  smooth: {block: filters.fir, taps: 31, edges: 100 Hz}\n"
    "  plant: {block: plants.linear, numerator: [1], denominator: [1, 0.05]}\n"
    "  back: {block: filters.delay, samples: 1}\n"
    "  gain: {block: filters.gain, gain: 2}\n"
    "connections:\n"
    "  - reference -> sum.a\n"
    "  - noise -> sum.b\n"
    "  - sum -> plant -> back -> sum.c\n"
    "  - plant -> smooth -> gain\n"
    "limits:\n"
    "  - {signal: gain.in, max: 0.01, rate: 10}\n"
    "  - {signal: plant.out, min: -1000, max: 1000}\n"
    "record: all\n";

struct Counted {
  execute::Outcome outcome;
  long allocations = 0, locks = 0;
  std::map<long, long> calls;  ///< by the number of the system call
};

Counted run(int threads, std::function<void()> mischief = {}, observe::Watch* watch = nullptr) {
  Registry registry{{{BODEFLOW_PLUGINS}, {}, BODEFLOW_PROBE_HELPER}};
  const auto graph = graph::load_text(kGraph, "graph.yaml", {}, registry);
  if (!graph) FAIL(to_string(graph.error()));
  const graph::Phase& phase = graph->phases[0];
  for (const auto& block : phase.blocks) {
    INFO(block.type->id);
    REQUIRE(block.type->realtime_safe);
  }
  phases::PlanSettings settings;
  settings.threads = threads;
  const auto prepared = phases::prepare(phase, registry, std::make_shared<HostServices>(), settings);
  if (!prepared) FAIL(to_string(prepared.error()));
  const record_tests::TemporaryFolder folder;
  const auto directory = record::RunDirectory::create({folder.path() / "run", "graph", {}}, *graph).value();
  execute::Sink& recording = *directory->begin_phase(phase, prepared->facts, {}, 0).value();
  Watch sink(watch == nullptr ? recording : watch->begin_phase(phase, 0, prepared->facts, prepared->plan, recording),
             std::move(mischief));
  execute::Options options;
  options.observer = watch;
  options.clock = phase.run.clock;
  Counted counted;
  allocations = locks = 0;
  for (auto& call : calls) call = 0;
  std::thread([&] {  // a thread that was watched stays so
    counting = true;
    counted.outcome = execute::execute(phase, prepared->facts, prepared->plan, prepared->instances, {}, sink, options);
    counting = false;
  })
      .join();
  counted.allocations = allocations;
  counted.locks = locks;
  for (std::size_t i = 0; i < kCalls; ++i)
    if (calls[i] > 0) counted.calls[static_cast<long>(i)] = calls[i];
  INFO(counted.outcome.reason);
  REQUIRE(counted.outcome.status == execute::Outcome::Status::complete);
  CHECK(counted.outcome.lateness.chunks >= 299);
  CHECK(counted.outcome.limits.at(0).violations > 0);
  return counted;
}

/// As the tests want it of `threads` compute threads.
void check_undisturbed(Counted counted, int threads) {
  CHECK(counted.allocations == 0);
  CHECK(counted.locks == 0);
  CHECK(counted.calls[SYS_clock_nanosleep] >= 100);
  counted.calls.erase(SYS_clock_nanosleep);
  if (threads > 1) counted.calls.erase(SYS_futex);  // one compute thread waits for the other
  for (const auto& [number, times] : counted.calls) UNSCOPED_INFO("system call " << number << " " << times << " times");
  CHECK(counted.calls.empty());
}

TEST_CASE("compute threads of a recorded realtime run allocate nothing, take no lock and call the system only to wait") {
  const int threads = GENERATE(1, 2);
  check_undisturbed(run(threads), threads);
}

TEST_CASE("compute threads do so too while somebody looks on all the time") {
  const int threads = GENERATE(1, 2);
  observe::Watch watch;
  std::atomic<bool> over{false};
  std::atomic<std::int64_t> seen{0};
  std::thread onlooker([&] {
    while (!over) {
      if (const observe::Look look = watch.look(); !look.state.firings.empty()) seen = look.state.firings[0];
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  });
  Counted counted = run(threads, {}, &watch);
  over = true;
  onlooker.join();
  CHECK(seen > 0);
  check_undisturbed(std::move(counted), threads);
}

TEST_CASE("the watch of compute threads sees one that allocates, locks and calls the system") {
  int taken = 0;
  std::mutex mutex;
  const Counted counted = run(1, [&] {
    std::free(std::malloc(static_cast<std::size_t>(++taken)));
    const std::lock_guard lock(mutex);
    (void)getppid();
  });
  CHECK(counted.allocations >= 290);
  CHECK(counted.locks >= 290);
  CHECK(counted.calls.at(SYS_getppid) >= 290);
}

}  // namespace
}  // namespace bodeflow::test

#endif
