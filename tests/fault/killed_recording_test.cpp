#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <sstream>

#include "../runtime/record/python.hpp"
#include "../runtime/record/recording_fixture.hpp"
#include "catch.hpp"
#include "record/data_file.hpp"

using namespace bodeflow;
using namespace bodeflow::record_tests;

namespace {

struct Taken {
  std::int64_t time_ns = 0;
  std::uint64_t samples = 0;
  std::uint64_t records = 0;
};

struct Killed {
  std::int64_t time_ns = 0;
  std::vector<Taken> taken;  ///< what the process told, in order
};

/// Starts record_paced in `folder` with an argument; it is killed after it has told of its work `lines_before` times, or kills
/// itself before.
Killed kill_while_recording(const fs::path& folder, const char* argument, std::size_t lines_before) {
  int ends[2];
  REQUIRE(::pipe(ends) == 0);
  const pid_t child = ::fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    ::dup2(ends[1], STDOUT_FILENO);
    ::close(ends[0]);
    ::execl(BODEFLOW_BUILD_DIR "/bin/record_paced", "record_paced", folder.c_str(), argument, nullptr);
    ::_exit(127);
  }
  ::close(ends[1]);
  FILE* lines = ::fdopen(ends[0], "r");
  Killed killed;
  char line[256];
  while (std::fgets(line, sizeof line, lines) != nullptr) {
    Taken taken;
    std::istringstream(line) >> taken.time_ns >> taken.samples >> taken.records;
    killed.taken.push_back(taken);
    if (killed.taken.size() == lines_before) {
      killed.time_ns = std::chrono::steady_clock::now().time_since_epoch().count();
      ::kill(child, SIGKILL);
    }
  }
  std::fclose(lines);
  int status = 0;
  ::waitpid(child, &status, 0);
  REQUIRE(WIFSIGNALED(status));
  REQUIRE(WTERMSIG(status) == SIGKILL);
  return killed;
}

}  // namespace

TEST_CASE("a recording that is killed keeps all but its last second, streams and records, and every earlier phase") {
  const TemporaryFolder folder;
  const Killed killed = kill_while_recording(folder.path(), nullptr, 280);
  Taken second_before;
  for (const auto& taken : killed.taken)
    if (taken.time_ns <= killed.time_ns - 1'000'000'000) second_before = taken;
  REQUIRE(second_before.samples > 1000);
  const std::uint64_t least = second_before.samples, most = killed.taken.back().samples + 10;

  const fs::path path = folder.path() / "run" / "data.h5";
  const auto file = record::DataFile::open(path);
  INFO((file ? std::string() : file.error()));
  REQUIRE(file);
  const auto* real = (*file)->stream("source.real");
  REQUIRE(real != nullptr);
  CHECK(real->length >= least);
  CHECK(real->length <= most);
  const auto values = (*file)->read(*real, 0, real->length);
  REQUIRE(values);
  std::uint64_t wrong = 0;
  for (std::uint64_t n = 0; n < real->length; ++n)
    if ((*values)[2 * n] != real_value(n, 0) || (*values)[2 * n + 1] != real_value(n, 1)) ++wrong;
  CHECK(wrong == 0);

  const auto* model = (*file)->records_of("source.model");
  REQUIRE(model != nullptr);
  CHECK(model->count >= second_before.records);
  const auto records = (*file)->read(*model, 0, model->count);
  REQUIRE(records);
  for (std::size_t k = 0; k < records->size(); ++k) CHECK(number_of((*records)[k].record) == static_cast<std::int64_t>(k));

  REQUIRE((*file)->stream("first.source.real") != nullptr);
  CHECK((*file)->stream("first.source.real")->length == 100);
  CHECK(number_of((*file)->read(*(*file)->records_of("first.source.model"), 0, 1).value().front().record) == 5);

  const auto manifest = read_json(folder.path() / "run" / "manifest.json");
  CHECK(manifest["status"] == "running");
  CHECK(manifest["hashes"].contains("first.source.real"));
  CHECK(read_json(folder.path() / "run" / "result.json")["results"]["first.source"]["attributes"]["number"] == 5);

  if (!h5py_present())
    WARN("skipped: no Python with h5py was found");
  else
    CHECK(check_data(path, std::to_string(least) + " " + std::to_string(second_before.records) + " swmr") == "ok\n");
}

TEST_CASE("a run that is killed before any call that changes a file keeps every phase that ended") {
  // From the end of the eighth phase on: with the ninth the groups of the file leave their first form
  std::uint64_t most = 0;
  for (int call = 1; most < 10; ++call) {
    const TemporaryFolder folder;
    const Killed killed = kill_while_recording(folder.path(), std::to_string(call).c_str(), 1000);
    const std::uint64_t ended = killed.taken.size();
    REQUIRE(ended >= 8);
    most = std::max(most, ended);
    const auto file = record::DataFile::open(folder.path() / "run" / "data.h5");
    INFO((file ? std::string() : file.error()) << ", killed before call " << call);
    REQUIRE(file);
    for (std::uint64_t k = 1; k <= ended; ++k) {
      const std::string phase = k == 1 ? "first" : "first@" + std::to_string(k);
      const auto* real = (*file)->stream(phase + ".source.real");
      REQUIRE(real != nullptr);
      CHECK((*file)->read(*real, 0, 100).value().at(198) == real_value(99, 0));
      const auto* model = (*file)->records_of(phase + ".source.model");
      REQUIRE(model != nullptr);
      CHECK(number_of((*file)->read(*model, 0, 1).value().front().record) == 5);
    }
    CHECK_FALSE(fs::exists(folder.path() / "run" / "data.h5.pending"));
  }
}
