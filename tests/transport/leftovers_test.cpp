// What crashed processes leave in shared memory.
#include "transport/leftovers.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "catch.hpp"

namespace fs = std::filesystem;

namespace {

class Folder {
 public:
  Folder() {
    std::string name = "/tmp/bodeflow_leftovers_XXXXXX";
    path_ = mkdtemp(name.data());
  }
  ~Folder() { fs::remove_all(path_); }
  void add(const std::string& name, std::time_t age = 60) const {
    std::ofstream(path_ / name) << "x";
    const timespec then[2] = {{std::time(nullptr) - age, 0}, {std::time(nullptr) - age, 0}};
    utimensat(AT_FDCWD, (path_ / name).c_str(), then, 0);
  }
  bool has(const std::string& name) const { return fs::exists(path_ / name); }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

}  // namespace

TEST_CASE("files of dead owners go with their locks and mutexes") {
  const Folder folder;
  for (const auto* name : {"fastrtps_0123456789abcdef", "fastrtps_0123456789abcdef_el", "fastrtps_port7411",
                           "fastrtps_port7411_el", "sem.fastrtps_port7411_mutex", "fastrtps_port7400", "fastrtps_port7400_sl"}) {
    folder.add(name);
  }
  CHECK(bodeflow::transport::remove_leftovers(folder.path()) == 7);
  CHECK(fs::is_empty(folder.path()));
}

TEST_CASE("files of living owners and files of others stay") {
  const Folder folder;
  for (const auto* name : {"fastrtps_0123456789abcdef", "fastrtps_0123456789abcdef_el", "fastrtps_0123", "fastrtps_portal",
                           "other", "fastrtps_port123456", "fastrtps_datasharing_0123456789abcdef"}) {
    folder.add(name);
  }
  folder.add("fastrtps_port7411", 0);  // young
  const int lock = open((folder.path() / "fastrtps_0123456789abcdef_el").c_str(), O_RDONLY);
  REQUIRE(flock(lock, LOCK_SH) == 0);
  CHECK(bodeflow::transport::remove_leftovers(folder.path()) == 0);
  close(lock);
  CHECK(bodeflow::transport::remove_leftovers(folder.path()) == 2);
  CHECK(folder.has("other"));
  CHECK(folder.has("fastrtps_port7411"));
}

TEST_CASE("a folder that is not there has no leftovers") { CHECK(bodeflow::transport::remove_leftovers("/nowhere/at/all") == 0); }
