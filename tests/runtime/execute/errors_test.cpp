#include <cstdlib>

#include "bench.hpp"
#include "catch.hpp"

namespace bodeflow::test {
namespace {

using execute::Outcome;

struct Faulty {
  Bench bench;
  int fault = 0;

  explicit Faulty(const std::string& way) {
    bench.add("before", "faults.fault");
    fault = bench.add("fault", "faults.fault", {{"way", way}});
    bench.add("after", "faults.fault");
    bench.add("count", "streams.counter");
    bench.connect("count", "before");
    bench.connect("before", "fault");
    bench.connect("fault", "after");
    bench.duration(10.0);
  }
};

int count(const Result& result, const std::string& block, const std::string& text) {
  const auto said = result.said(block);
  return static_cast<int>(std::count(said.begin(), said.end(), text));
}

TEST_CASE("errors: whatever a block does wrong in process ends the run with its name and the reason") {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"process", "the plant left its range"},
      {"silent", "an exception that is not derived from std::exception"},
      {"port", "sent a record on message output 7: it has 1"},
      {"type", "sent a record of type 'text' on 'sent', described as 'number'"},
      {"more", "says that it made 65 firings where 64 were asked for"},
      {"less", "made 0 of 64 firings: only a block without stream inputs may end its streams"},
      {"offset", "sent a record on 'sent' at offset 65 of a call with 64 firings"},
      {"null", "sent no record on 'sent': the pointer is null"},
      {"broken", "sent a broken record on 'sent': record: no magic 'BFR1' at its start"},
  };
  for (const auto& [way, reason] : cases) {
    for (const int threads : {1, 2, 4}) {
      Faulty faulty(way);
      const Result result = faulty.bench.run({64, threads, 0, 0});
      INFO(way << " " << threads);
      CHECK(result.outcome.status == Outcome::Status::partial);
      CHECK_FALSE(result.outcome.interrupted);
      CHECK(result.outcome.reason == reason);
      CHECK(result.outcome.failed_block == faulty.fault);
      CHECK_FALSE(result.outcome.hung);
      for (const char* block : {"before", "fault", "after"}) {
        CHECK(count(result, block, "finish") == 0);
        CHECK(count(result, block, "deactivate") == 1);
      }
      CHECK(result.stream("fault.out").size() == 64);  // what was whole before is kept
    }
  }
}

TEST_CASE("errors: a block that can't be activated leaves those before it deactivated and the rest untouched") {
  Faulty faulty("activate");
  const Result result = faulty.bench.run();
  CHECK(result.outcome.status == Outcome::Status::partial);
  CHECK(result.outcome.reason == "no such device");
  CHECK(result.outcome.failed_block == faulty.fault);
  CHECK(result.said("before") == std::vector<std::string>{"activate", "deactivate"});
  CHECK(result.said("fault") == std::vector<std::string>{"activate"});
  CHECK(result.said("after").empty());
  CHECK(result.stream("count.out").empty());
}

TEST_CASE("errors: a change that a block refuses ends the run") {
  Faulty faulty("change");
  faulty.bench.schedule(0.5, "fault", "level", 1.0);
  const Result result = faulty.bench.run({100, 1, 0, 0});
  CHECK(result.outcome.status == Outcome::Status::partial);
  CHECK(result.outcome.reason == "can't be changed to that");
  CHECK(result.outcome.failed_block == faulty.fault);
  CHECK(result.changes.empty());
  CHECK(result.stream("fault.out").size() == 500);
}

TEST_CASE("errors: a finish that fails ends the run as partial, later blocks do not finish") {
  Faulty faulty("finish");
  faulty.bench.duration(0.1);
  const Result result = faulty.bench.run({64, 2, 0, 0});
  CHECK(result.outcome.status == Outcome::Status::partial);
  CHECK(result.outcome.reason == "the file could not be closed");
  CHECK(result.outcome.failed_block == faulty.fault);
  CHECK(count(result, "before", "finish") == 1);
  CHECK(count(result, "after", "finish") == 0);
  CHECK(count(result, "after", "deactivate") == 1);
}

TEST_CASE("errors: a sink that can't keep what comes ends the run") {
  Faulty faulty("none");
  int pieces = 0;
  faulty.bench.on_samples = [&](const std::string&) -> tl::expected<void, std::string> {
    if (++pieces == 20) return tl::unexpected(std::string("data.h5: no space left on device"));
    return {};
  };
  const Result result = faulty.bench.run({64, 2, 0, 0});
  CHECK(result.outcome.status == Outcome::Status::partial);
  CHECK(result.outcome.reason == "data.h5: no space left on device");
  CHECK(result.outcome.failed_block == -1);
}

TEST_CASE("errors: a plan for another phase is refused") {
  Bench bench;
  bench.add("count", "streams.counter");
  bench.duration(1.0);
  std::vector<std::unique_ptr<Instance>> instances;
  bench.run({}, instances);
  class Nothing final : public execute::Sink {
    tl::expected<void, std::string> samples(int, const void* const*, std::uint64_t) override { return {}; }
    tl::expected<void, std::string> record(graph::End, const SharedRecord&, double) override { return {}; }
    void changed(int, int, const ParameterValue&, std::uint64_t, execute::Cause) override {}
  } sink;
  const auto facts = plan::establish_facts(bench.phase, instances);
  REQUIRE(facts);
  const Outcome outcome = execute::execute(bench.phase, *facts, plan::Plan{}, instances, {}, sink, {});
  CHECK(outcome.status == Outcome::Status::partial);
  CHECK(outcome.reason == "plan: made for another phase: it has 0 blocks, the phase 1, the instances 1");
}

}  // namespace
}  // namespace bodeflow::test
