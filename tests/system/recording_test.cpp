#include <nlohmann/json.hpp>

#include "catch.hpp"
#include "system/command.hpp"

using bodeflow::test::Folder;
using bodeflow::test::run_bodeflow;
using Catch::Matchers::Contains;

namespace {

constexpr const char* kMake =
    "bodeflow: 1\n"
    "run: {duration: 20 s}\n"
    "blocks:\n"
    "  noise: {block: generators.noise, sample_rate: 10 kHz, channels: 2, unit: V}\n"
    "  tone: {block: generators.sine, sample_rate: 10 kHz, frequency: 250 Hz}\n"
    "record: [noise, tone]\n";

// Two blocks read the same recording, on threads of their own, while their streams are recorded.
constexpr const char* kRead =
    "bodeflow: 1\n"
    "blocks:\n"
    "  first: {block: acquisition.file, file: made/data.h5, columns: ['noise.out[1]', 'noise.out[2]']}\n"
    "  second: {block: acquisition.file, file: made/data.h5, columns: [tone.out]}\n"
    "  a: {block: filters.gain, gain: 1}\n"
    "  b: {block: filters.gain, gain: 1}\n"
    "connections:\n"
    "  - first.out -> a\n"
    "  - second.out -> b\n"
    "record: [a, b]\n";

}  // namespace

TEST_CASE("the recording of a run is read back bit for bit, by two blocks on two threads that are recorded") {
  const Folder folder;
  folder.write("make.yaml", kMake);
  folder.write("read.yaml", kRead);
  const auto made = run_bodeflow({"run", "make.yaml", "--out", "made"}, folder.path());
  INFO(made.err);
  REQUIRE(made.exit_code == 0);
  const auto before = nlohmann::json::parse(folder.read("made/manifest.json"))["hashes"];
  for (const char* threads : {"1", "2"}) {
    const std::string out = std::string("read") + threads;
    const auto read = run_bodeflow({"run", "read.yaml", "--out", out, "--threads", threads}, folder.path());
    INFO(read.err);
    REQUIRE(read.exit_code == 0);
    const auto after = nlohmann::json::parse(folder.read(out + "/manifest.json"))["hashes"];
    CHECK(after["a.out"] == before["noise.out"]);
    CHECK(after["b.out"] == before["tone.out"]);
  }
}

TEST_CASE("check tells what it found in a data file") {
  const Folder folder;
  folder.write("make.yaml", kMake);
  folder.write("read.yaml", kRead);
  REQUIRE(run_bodeflow({"run", "make.yaml", "--out", "made", "--for", "10 ms"}, folder.path()).exit_code == 0);
  const auto checked = run_bodeflow({"check", "read.yaml"}, folder.path());
  CHECK(checked.exit_code == 0);
  CHECK_THAT(checked.err, Contains("data.h5: 100 rows at 10000 Hz (0.01 s), rate as the file states it, gaps can't be seen"));
  CHECK_THAT(checked.err, Contains("not read noise.out[1] [V], noise.out[2] [V]"));
}
