#include "plugins/cache.hpp"

#include <algorithm>
#include <cstdlib>

#include "catch.hpp"
#include "support.hpp"

using namespace bodeflow;
using namespace bodeflow::test;

namespace {

/// A folder with two plugins and a cache; counts the children that probe.
class Lab {
 public:
  Lab() {
    std::filesystem::create_directory(folder_ / "plugins");
    std::filesystem::copy_file(fixture("good"), plugin("good"));
    std::filesystem::copy_file(fixture("plain"), plugin("plain"));
    setenv("BODEFLOW_PROBE_LOG", (folder_ / "log").c_str(), 1);
    options_ = options({folder_ / "plugins"});
    options_.cache = folder_ / "cache/probe.json";
  }
  ~Lab() { unsetenv("BODEFLOW_PROBE_LOG"); }

  std::filesystem::path plugin(const std::string& name) const { return folder_ / ("plugins/" + name + ".so"); }
  const std::filesystem::path& cache() const { return options_.cache; }

  /// Children that one look at the folder started; all plugins must be usable.
  long probes() {
    std::filesystem::remove(folder_ / "log");
    const Registry registry(options_);
    CHECK(registry.ids() == std::vector<std::string>{"fixture.gain", "fixture.thrower", "plain.scale"});
    for (const PluginDescription& p : registry.plugins()) {
      CHECK(p.refused.empty());
      CHECK(p.sha256.size() == 64);
    }
    const std::string log = text_of(folder_ / "log");
    return std::count(log.begin(), log.end(), '\n');
  }

 private:
  Folder folder_;
  Registry::Options options_;

 public:
  Registry::Options& change() { return options_; }
};

}  // namespace

TEST_CASE("a known plugin is probed once") {
  Lab lab;
  CHECK(lab.probes() == 2);
  CHECK(lab.probes() == 0);
}

TEST_CASE("the description from the cache equals the probed one") {
  Lab lab;
  const Registry fresh(lab.change());
  const Registry cached(lab.change());
  REQUIRE(fresh.plugins().size() == cached.plugins().size());
  for (std::size_t i = 0; i < fresh.plugins().size(); ++i) {
    CHECK(fresh.plugins()[i].file == cached.plugins()[i].file);
    CHECK(fresh.plugins()[i].sha256 == cached.plugins()[i].sha256);
    CHECK(fresh.plugins()[i].build == cached.plugins()[i].build);
    CHECK(fresh.plugins()[i].blocks == cached.plugins()[i].blocks);
  }
}

TEST_CASE("a plugin that was only touched is hashed, not probed, one with other bytes is probed") {
  Lab lab;
  CHECK(lab.probes() == 2);
  const auto time = std::filesystem::last_write_time(lab.plugin("good"));
  std::filesystem::last_write_time(lab.plugin("good"), time + std::chrono::seconds(5));
  CHECK(lab.probes() == 0);
  write(lab.plugin("plain"), text_of(lab.plugin("plain")) + "more");
  CHECK(lab.probes() == 1);
  CHECK(lab.probes() == 0);
}

TEST_CASE("a broken cache is an empty one, and is replaced") {
  Lab lab;
  CHECK(lab.probes() == 2);
  const std::string good = text_of(lab.cache());
  std::string other_host = good;
  other_host.replace(other_host.find("abi"), 3, "ABI");
  std::string other_sums = good;
  for (std::size_t at = 0; (at = other_sums.find("\"blocks\"", at)) != std::string::npos; ++at)
    other_sums.replace(at, 8, "\"stolen\"");
  for (const std::string& text :
       {std::string(), std::string("{"), std::string("[1, 2]"), std::string("{\"host\": 3, \"files\": []}"),
        std::string("\xFF\xFE\0\0", 4), good.substr(0, good.size() / 2), other_host, other_sums}) {
    write(lab.cache(), text);
    CHECK(lab.probes() == 2);
    CHECK(lab.probes() == 0);
  }
}

TEST_CASE("without a cache, or with one that can't be written, every start probes") {
  Lab lab;
  lab.change().cache = lab.plugin("good") / "cache.json";  // below a file
  CHECK(lab.probes() == 2);
  CHECK(lab.probes() == 2);
  lab.change().cache.clear();
  CHECK(lab.probes() == 2);
}

TEST_CASE("a refused plugin is probed again: what it lacked may be there next time") {
  Lab lab;
  CHECK(lab.probes() == 2);
  std::filesystem::copy_file(fixture("undefined"), lab.plugin("undefined"));
  for (int i = 0; i < 2; ++i) {
    const Registry registry(lab.change());
    REQUIRE(registry.plugins().size() == 3);
    CHECK(registry.plugins()[2].refused == "can't be loaded: undefined symbol: this_function_exists_nowhere");
  }
}

TEST_CASE("a cache keeps the plugins of other search paths, and forgets files that are gone") {
  Lab lab;
  CHECK(lab.probes() == 2);
  Registry::Options one = lab.change();
  one.path = {lab.plugin("good")};
  std::filesystem::remove(lab.plugin("plain"));
  std::filesystem::last_write_time(lab.plugin("good"),
                                   std::filesystem::last_write_time(lab.plugin("good")) + std::chrono::seconds(5));
  CHECK(Registry(one).plugins().size() == 1);
  CHECK(text_of(lab.cache()).find("good.so") != std::string::npos);
  CHECK(text_of(lab.cache()).find("plain.so") == std::string::npos);
}
