#include <unistd.h>

#include <atomic>

#include "bench.hpp"
#include "catch.hpp"

namespace bodeflow::test {
namespace {

using execute::Outcome;

/// A run in which one block hangs until it is let go.
class Hang {
 public:
  explicit Hang(bool in_finish) {
    REQUIRE(pipe(release_) == 0);
    REQUIRE(pipe(left_) == 0);
    bench.add("count", "streams.counter");
    bench.add("adc", "faults.stuck",
              {{"at", std::int64_t{150}},
               {"in_finish", in_finish},
               {"release", std::int64_t{release_[0]}},
               {"left", std::int64_t{left_[1]}}});
    bench.add("dft", "streams.decimate", {{"factor", std::int64_t{100}}});
    bench.add("gain", "streams.gain");
    bench.connect("count", "adc");
    bench.connect("adc", "dft");
    bench.connect("dft", "gain");
    bench.duration(in_finish ? 0.3 : 100.0);
    bench.options.watchdog_s = 0.2;
  }
  Hang(const Hang&) = delete;
  Hang& operator=(const Hang&) = delete;
  /// Lets the block go and waits until it is out: from then on its thread only leaves. The instance that hung stays, as the
  /// contract says; the others may go.
  ~Hang() {
    char byte = 'x';
    if (write(release_[1], &byte, 1) == 1 && read(left_[0], &byte, 1) == 1) left_behind().push_back(std::move(instances_[1]));
    for (const int end : {release_[0], release_[1], left_[0], left_[1]}) close(end);
  }

  Result run(int threads) { return bench.run({100, threads, 0, 0}, instances_); }

  Bench bench;

 private:
  /// Never destroyed, and still within reach.
  static std::vector<std::unique_ptr<Instance>>& left_behind() {
    static auto* const instances = new std::vector<std::unique_ptr<Instance>>;
    return *instances;
  }

  int release_[2] = {-1, -1}, left_[2] = {-1, -1};
  std::vector<std::unique_ptr<Instance>> instances_;
};

TEST_CASE("watchdog: a stalled run ends and names who waits for whom, edge by edge") {
  for (const int threads : {1, 2, 4}) {
    Hang hang(false);
    const Result result = hang.run(threads);
    const Outcome& outcome = result.outcome;
    INFO(outcome.reason);
    CHECK(outcome.status == Outcome::Status::partial);
    CHECK(outcome.hung);
    CHECK_FALSE(outcome.interrupted);
    const std::string expected =
        "dft waits for 100 samples of adc.out, 0 are there; gain waits for 1 sample of dft.out, 0 are there; thread ";
    CHECK(outcome.reason.find(expected) != std::string::npos);
    CHECK(outcome.reason.find(" in process of block 'adc' for 0.2") != std::string::npos);
    CHECK(result.said("adc").empty());  // not deactivated
    CHECK(result.stream("adc.out").size() == 100);
  }
}

TEST_CASE("watchdog: a finish may compute 60 times as long as another call; one that hangs is named") {
  Hang hang(true);
  hang.bench.options.watchdog_s = 0.01;
  const Result result = hang.run(2);
  INFO(result.outcome.reason);
  CHECK(result.outcome.status == Outcome::Status::partial);
  CHECK(result.outcome.hung);
  CHECK(result.outcome.reason.find("the last thread in finish of block 'adc' for 0.6") == 0);
}

TEST_CASE("watchdog: a run that was stopped while a block hangs returns as interrupted") {
  Hang hang(false);
  std::atomic<bool> stop{true};
  hang.bench.options.stop = &stop;
  hang.bench.on_samples = [&](const std::string&) -> tl::expected<void, std::string> { return {}; };
  stop = false;
  bool first = true;
  hang.bench.options.progress = [&](const execute::Progress&) {
    if (first) stop = true;
    first = false;
  };
  hang.bench.options.watchdog_s = 2.0;
  const Result result = hang.run(1);
  INFO(result.outcome.reason);
  CHECK(result.outcome.status == Outcome::Status::partial);
  CHECK(result.outcome.interrupted);
  CHECK(result.outcome.hung);
  CHECK(result.outcome.reason.find("interrupted; then ") == 0);
}

}  // namespace
}  // namespace bodeflow::test
