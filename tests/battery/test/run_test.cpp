#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "catch.hpp"
#include "system/command.hpp"

/// The script that plays a battery, with a stand-in for the tracer that finds everything strange.

namespace fs = std::filesystem;
using bodeflow::test::Folder;
using bodeflow::test::run_program;

namespace {

struct Bench {
  Folder folder;
  explicit Bench(const std::string& tracer) {
    fs::create_directories(folder.path() / "build/bin");
    fs::create_symlink(BATTERY_GENERATE, folder.path() / "build/bin/battery_generate");
    fs::create_symlink(BATTERY_SCORE, folder.path() / "build/bin/battery_score");
    const fs::path program = folder.write("build/bin/bodeflow", "#!/bin/sh\n" + tracer);
    fs::permissions(program, fs::perms::owner_all);
  }
  bodeflow::test::Ended play(std::vector<std::string> options) const {
    const std::vector<std::string> first{BODEFLOW_SOURCE_DIR "/tests/battery/run",
                                         "--build",
                                         "build",
                                         "--seed",
                                         "run",
                                         "--only",
                                         "offset,gain_wobble",
                                         "--out",
                                         "out"};
    options.insert(options.begin(), first.begin(), first.end());
    return run_program(options, folder.path());
  }
};

// Writes what it was asked into the folder after --out, which is the last of all options but --without.
const char* const kStranger = R"(echo "$*" >> "$0.asked"
while [ "$1" != --out ]; do shift; done
mkdir -p "$2"
echo '{"results": {"trace": {"attributes": {"verdict": "unexplained", "effects": []}, "arrays": {}}}}' > "$2/result.json"
)";

}  // namespace

TEST_CASE("battery: the script asks the tracer for every case, commits the answers and scores them") {
  const Bench bench(kStranger);
  const auto ended =
      bench.play({"--clean", "1", "--single", "1", "--outside", "1", "--", "--outside", "0", "--false-alarms", "0"});
  INFO(ended.err);
  CHECK(ended.exit_code == 1);
  CHECK(ended.err.find("battery_score: false alarms in clean cases: 1 of 1") != std::string::npos);
  CHECK(ended.err.find("outside cases") == std::string::npos);
  CHECK(ended.out.find("| outside: gain_wobble | 1 |  | 1 |") != std::string::npos);
  CHECK(bench.folder.read("out/report.md") + "\n" == ended.out);
  const std::string asked = bench.folder.read("build/bin/bodeflow.asked");
  CHECK(std::count(asked.begin(), asked.end(), '\n') == 3);
  CHECK(asked.find("sealed") == std::string::npos);
  CHECK(asked.find("--input u --output y") != std::string::npos);
}

TEST_CASE("battery: the script leaves one effect after the other out of the catalogue") {
  const Bench bench(kStranger);
  const auto ended =
      bench.play({"--clean", "0", "--single", "2", "--outside", "0", "--leave-one-out", "--", "--wrong-names", "0"});
  INFO(ended.err);
  CHECK(ended.exit_code == 0);
  CHECK(bench.folder.read("build/bin/bodeflow.asked").find("--without offset") != std::string::npos);
}

TEST_CASE("battery: a tracer that fails is a case without an answer") {
  const Bench bench("echo 'no such option' >&2; exit 2\n");
  const auto ended =
      bench.play({"--clean", "1", "--single", "0", "--outside", "0", "--plants", "mechanical", "--", "--failed", "0"});
  CHECK(ended.exit_code == 1);
  CHECK(ended.out.find("failed no such option") != std::string::npos);
}
