#include <sys/mount.h>
#include <sys/resource.h>

#include <cerrno>
#include <cstring>

#include "../runtime/record/python.hpp"
#include "../runtime/record/recording_fixture.hpp"
#include "catch.hpp"
#include "record/data_file.hpp"

using namespace bodeflow;
using namespace bodeflow::record_tests;

namespace {

/// A small disk in memory, mounted for the life of the object where that is permitted.
class SmallDisk {
 public:
  SmallDisk(const fs::path& place, const char* size) : place_(place) {
    fs::create_directories(place);
    mounted_ = ::mount("none", place.c_str(), "tmpfs", 0, size) == 0;
    if (!mounted_) reason_ = std::strerror(errno);
  }
  ~SmallDisk() {
    if (mounted_) ::umount2(place_.c_str(), MNT_DETACH);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;

  bool mounted() const { return mounted_; }
  const std::string& reason() const { return reason_; }

 private:
  fs::path place_;
  bool mounted_ = false;
  std::string reason_;
};

/// The largest file that this process may write, for the life of the object.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    rlimit now = before_;
    now.rlim_cur = bytes;
    ::setrlimit(RLIMIT_FSIZE, &now);
  }
  ~FileSizeLimit() { ::setrlimit(RLIMIT_FSIZE, &before_); }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  rlimit before_{};
};

/// Records until the sink refuses, ends and closes the run; the error.
std::string record_until_refused(const fs::path& folder, std::uint64_t most) {
  const auto phase = source_phase();
  const auto run = make_run(folder, source_graph({phase}));
  execute::Sink& sink = **run->begin_phase(phase, source_facts(), nlohmann::json::object(), 0);
  REQUIRE(sink.record({0, 0}, numbered_record(1), 0.0));
  std::string error;
  for (std::uint64_t n = 0; error.empty() && n < most; n += 1000)
    if (const auto taken = give_real(sink, n, 1000); !taken) error = taken.error();
  const auto ended = run->end_phase({});
  CHECK((ended ? "no error" : ended.error()) == error);
  const auto closed = run->close("failed", error);
  CHECK((closed ? "no error" : closed.error()) == error);
  return error;
}

/// What was recorded before the disk was full is there, right, and at least so much; the closing files are whole.
void check_what_is_left(const fs::path& directory, std::uint64_t least_samples) {
  const auto file = record::DataFile::open(directory / "data.h5");
  INFO((file ? std::string() : file.error()));
  REQUIRE(file);
  const auto* real = (*file)->stream("source.real");
  REQUIRE(real != nullptr);
  CHECK(real->length >= least_samples);
  const auto values = (*file)->read(*real, 0, real->length);
  REQUIRE(values);
  std::uint64_t wrong = 0;
  for (std::uint64_t n = 0; n < real->length; ++n)
    if ((*values)[2 * n] != real_value(n, 0) || (*values)[2 * n + 1] != real_value(n, 1)) ++wrong;
  CHECK(wrong == 0);
  CHECK(read_json(directory / "manifest.json")["status"] == "failed");
  CHECK(read_json(directory / "result.json")["results"]["source"]["attributes"]["number"] == 1);
  if (h5py_present())  // the file is closed in order: it opens in the ordinary way too
    CHECK(output_of(python_with_h5py() + " -c \"import h5py; print(h5py.File('" + (directory / "data.h5").string() +
                    "')['streams/source.real'].shape[0])\"") == std::to_string(real->length) + "\n");
}

}  // namespace

TEST_CASE("a full disk ends the recording with its reason; what was recorded and the closing files are whole") {
  const TemporaryFolder folder;
  const SmallDisk disk(folder.path() / "disk", "size=8m");
  if (!disk.mounted()) {
    WARN("skipped: can't mount a small disk: " + disk.reason());
    return;
  }
  const fs::path directory = folder.path() / "disk" / "run";
  const std::string error = record_until_refused(folder.path() / "disk", 10'000'000);
  CHECK(error == "can't write '" + (directory / "data.h5").string() + "': No space left on device");
  check_what_is_left(directory, 4 * 1024 * 1024 / 16);
}

TEST_CASE("the limit for the size of a file ends the recording in the same way") {
  const TemporaryFolder folder;
  const fs::path directory = folder.path() / "run";
  std::string error;
  {
    const FileSizeLimit limit(6'000'000);
    error = record_until_refused(folder.path(), 10'000'000);
  }
  CHECK(error == "can't write '" + (directory / "data.h5").string() +
                     "': the limit for the size of a file is reached (ulimit -f, 6000000 bytes)");
  check_what_is_left(directory, 1024 * 1024 / 16);
}
