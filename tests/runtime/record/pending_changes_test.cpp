#include "record/pending_changes.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <thread>

#include "catch.hpp"
#include "record/files.hpp"
#include "temporary_folder.hpp"

using namespace bodeflow;
using record_tests::TemporaryFolder;

namespace {

namespace fs = std::filesystem;

std::vector<unsigned char> bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

void put(const fs::path& path, const std::string& text) { std::ofstream(path, std::ios::binary) << text; }

/// Leaves what a writer does that was killed when it wanted to change "0123456789" into "ab234cde89"; the file of changes.
std::string left_by_killed(const TemporaryFolder& folder) {
  const fs::path path = folder.path() / "data";
  put(path, "0123456789");
  const int read_only = ::open(path.c_str(), O_RDONLY);  // nothing can be written: the changes stay pending
  CHECK_FALSE(record::write_changes(path, read_only, {{0, bytes_of("ab")}, {5, bytes_of("cde")}}));
  ::close(read_only);
  CHECK(record::read_text(path).value() == "0123456789");
  return record::read_text(folder.path() / "data.pending").value();
}

}  // namespace

TEST_CASE("changes are written and leave no second file") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "data";
  put(path, "0123456789");
  const int file = ::open(path.c_str(), O_RDWR);
  CHECK(record::write_changes(path, file, {{0, bytes_of("ab")}, {1, bytes_of("xyz")}, {8, bytes_of("!?")}}));
  ::close(file);
  CHECK(record::read_text(path).value() == "axyz4567!?");
  CHECK(std::distance(fs::directory_iterator(folder.path()), {}) == 1);
  record::finish_changes(path);
  CHECK(record::read_text(path).value() == "axyz4567!?");
}

TEST_CASE("changes that a killed writer left are finished, also where a part of them was written") {
  for (const char* there : {"0123456789", "ab23456789", "ab234cde89"}) {
    const TemporaryFolder folder;
    left_by_killed(folder);
    const fs::path path = folder.path() / "data";
    put(path, there);
    record::finish_changes(path);
    CHECK(record::read_text(path).value() == "ab234cde89");
    CHECK_FALSE(fs::exists(folder.path() / "data.pending"));
  }
}

TEST_CASE("a damaged file of changes is refused with the reason and changes nothing") {
  const TemporaryFolder folder;
  const std::string whole = left_by_killed(folder);
  const fs::path path = folder.path() / "data", pending = folder.path() / "data.pending";
  const std::size_t first_end = 8 + 16 + 2;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    if (size == 8 || size == first_end) continue;  // a whole list, of fewer changes
    put(pending, whole.substr(0, size));
    INFO("cut to " << size << " bytes");
    CHECK_THROWS_WITH(record::finish_changes(path), Catch::Contains(pending.string()));
  }
  for (const std::size_t at : {std::size_t{0}, std::size_t{9}, std::size_t{17}, std::size_t{23}}) {
    std::string other = whole;
    other[at] = '\x7f';
    put(pending, other);
    INFO("byte " << at << " is another");
    CHECK_THROWS_AS(record::finish_changes(path), std::runtime_error);
  }
  CHECK(record::read_text(path).value() == "0123456789");
}

TEST_CASE("changes of a writer that lives are left to it") {
  const TemporaryFolder folder;
  left_by_killed(folder);
  const fs::path path = folder.path() / "data", pending = folder.path() / "data.pending";
  const int held = ::open(pending.c_str(), O_RDONLY);
  REQUIRE(::flock(held, LOCK_EX | LOCK_NB) == 0);
  std::thread writer([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    ::unlink(pending.c_str());
    ::close(held);
  });
  record::finish_changes(path);
  writer.join();
  CHECK(record::read_text(path).value() == "0123456789");
}
