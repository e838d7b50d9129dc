#include <cmath>
#include <filesystem>
#include <map>
#include <set>

#include "catch.hpp"
#include "common/json.hpp"
#include "common/sha256.hpp"
#include "generate/case.hpp"
#include "generate/write.hpp"
#include "system/command.hpp"

using namespace battery;
using bodeflow::test::Folder;
using bodeflow::test::run_program;
namespace fs = std::filesystem;

namespace {

bodeflow::test::Ended generate(const Folder& folder, std::vector<std::string> options) {
  options.insert(options.begin(), BATTERY_GENERATE);
  return run_program(options, folder.path());
}

/// All files of a battery by their names.
std::map<std::string, std::string> files_of(const Folder& folder, const std::string& battery) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder.path() / battery)) {
    if (entry.is_regular_file())
      files[fs::relative(entry.path(), folder.path() / battery).string()] =
          folder.read(fs::relative(entry.path(), folder.path()).string());
  }
  return files;
}

}  // namespace

TEST_CASE("battery: the digest is that of the standard") {
  CHECK(sha256_hex("") == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  CHECK(sha256_hex("abc") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  CHECK(sha256_hex(std::string(1000000, 'a')) == "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST_CASE("battery: a seed gives the same files whatever the threads, another seed others") {
  const Folder folder;
  const std::vector<std::string> what{"--clean", "1", "--single", "1", "--outside", "1", "--only", "offset,gain_wobble"};
  const auto with = [&](std::vector<std::string> options) {
    options.insert(options.end(), what.begin(), what.end());
    const auto ended = generate(folder, options);
    INFO(ended.err);
    CHECK(ended.exit_code == 0);
  };
  with({"--seed", "a", "--out", "one", "--threads", "1"});
  with({"--seed", "a", "--out", "two", "--threads", "3"});
  with({"--seed", "b", "--out", "other"});
  const auto one = files_of(folder, "one");
  CHECK(one.size() == 3 * 5 + 3);
  CHECK((one == files_of(folder, "two")));
  CHECK(one.at("cases/0001/E1.csv") != files_of(folder, "other").at("cases/0001/E1.csv"));
}

TEST_CASE("battery: nothing outside of the sealed folder tells what a case hides") {
  const Folder folder;
  const auto ended = generate(folder, {"--seed", "s", "--clean", "1", "--single", "2", "--outside", "1", "--only",
                                       "offset,hum,gain_wobble", "--plants", "mechanical", "--out", "b"});
  REQUIRE(ended.exit_code == 0);
  const auto files = files_of(folder, "b");
  std::set<std::size_t> csv_sizes;
  std::set<std::string> json_keys;
  for (const auto& [name, text] : files) {
    if (name.find("sealed") == 0) continue;
    INFO(name);
    CHECK(fs::last_write_time(folder.path() / "b" / name) == std::chrono::file_clock::from_sys(std::chrono::sys_seconds{}));
    if (name.size() > 4 && name.substr(name.size() - 4) == ".csv") csv_sizes.insert(text.size());
    if (name.find("case.json") == std::string::npos) continue;
    std::string keys;
    const Json json = Json::parse(text);
    for (const auto& [key, value] : json.object()) keys += key + " ";
    json_keys.insert(keys);
    for (const Kind kind : {Kind::single, Kind::outside}) {
      CHECK(text.find(word(kind)) == std::string::npos);
      for (const auto& effect : effects_of("mechanical", kind)) CHECK(text.find(effect) == std::string::npos);
    }
  }
  CHECK(csv_sizes.size() == 1);
  CHECK(json_keys == std::set<std::string>{"case levels lines period periods plant rate_hz skip units "});
}

TEST_CASE("battery: the manifest has the digest of every file and of the salted truth") {
  const Folder folder;
  REQUIRE(generate(folder, {"--seed", "s", "--single", "2", "--only", "offset,hum", "--out", "b"}).exit_code == 0);
  const Json manifest = Json::parse(folder.read("b/manifest.json"));
  const std::string truth = folder.read("b/sealed/truth.json");
  CHECK(manifest["truth_sha256"].text() == sha256_hex(folder.read("b/sealed/salt") + truth));
  CHECK(manifest["files_sha256"].object().size() == 2 * 5);
  for (const auto& [name, digest] : manifest["files_sha256"].object())
    CHECK(digest.text() == sha256_hex(folder.read("b/cases/" + name)));
  const Json opened = Json::parse(truth);
  REQUIRE(opened["cases"].list().size() == 2);
  for (const Json& c : opened["cases"].list()) CHECK((c["effect"].text() == "offset" || c["effect"].text() == "hum"));
}

TEST_CASE("battery: all classes have the same noise, and sizes are in their range") {
  for (const Kind kind : {Kind::clean, Kind::single, Kind::outside}) {
    const Case c = draw_case({kind, "mechanical",
                              kind == Kind::clean    ? ""
                              : kind == Kind::single ? "offset"
                                                     : "gain_wobble",
                              "noise"});
    INFO(word(kind));
    // Same seed: the same plant, noise level and phases, whatever is hidden.
    CHECK(c.signal_to_noise == draw_case({Kind::clean, "mechanical", "", "noise"}).signal_to_noise);
    if (kind == Kind::single) CHECK((c.size > 0.018 && c.size < 10.6));
    if (kind == Kind::outside) CHECK((c.size > 0.27 && c.size < 10.6));
    if (kind == Kind::clean) CHECK(c.size == 0.0);
  }
}

TEST_CASE("battery: the noise of a record is what the truth says, and the periods differ by it alone") {
  const Case c = draw_case({Kind::clean, "motor", "", "periods"});
  const auto& y = c.records[0].output;
  const std::size_t n = c.records[0].drive.period;
  double sum = 0.0;
  for (std::size_t k = n; k + n < y.size(); ++k) sum += (y[k + n] - y[k]) * (y[k + n] - y[k]);
  CHECK(std::sqrt(0.5 * sum / static_cast<double>(y.size() - 2 * n)) == Approx(c.noise).epsilon(0.05));
  const auto& u = c.records[0].input;
  CHECK(std::equal(u.begin(), u.end() - static_cast<std::ptrdiff_t>(n), u.begin() + static_cast<std::ptrdiff_t>(n)));
}

TEST_CASE("battery: usage errors are named and leave nothing behind") {
  const Folder folder;
  const auto refused = [&](const std::vector<std::string>& options, const std::string& message) {
    const auto ended = generate(folder, options);
    CHECK(ended.exit_code == 2);
    CHECK(ended.err.find("battery_generate: " + message) == 0);
  };
  refused({"--seed", "a", "--out", "b"}, "no cases: --clean, --single or --outside is needed");
  refused({"--clean", "1", "--out", "b"}, "--seed and --out are needed");
  refused({"--clean", "many", "--out", "b"}, "--clean must be a number from 0 to 9999, not 'many'");
  refused({"--plants", "pump", "--seed", "a", "--out", "b", "--clean", "1"}, "unknown plant 'pump'; motor, mechanical");
  refused({"--only", "magic", "--seed", "a", "--out", "b", "--single", "1"}, "no plant has any of these effects");
  CHECK(!fs::exists(folder.path() / "b"));
}
