#include <dlfcn.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "catch.hpp"
#include "support.hpp"

using namespace bodeflow;
using namespace bodeflow::test;

namespace {

/// Why the only file in the search path is refused.
std::string reason(const std::filesystem::path& file) {
  const Registry registry(options({file}));
  REQUIRE(registry.plugins().size() == 1);
  CHECK(registry.plugins()[0].file == std::filesystem::canonical(file));
  return registry.plugins()[0].refused;
}

}  // namespace

TEST_CASE("a file that is no plugin is refused before any code of it runs") {
  const Folder folder;
  write(folder / "notes.so", "bearing of the second motor was changed\n");
  CHECK(reason(folder / "notes.so") == "is no bodeflow plugin: no shared library (ELF file)");
  CHECK(reason(fixture("no_note")) == "is no bodeflow plugin: it has no note of the bodeflow SDK");
  Dl_info libm{};
  REQUIRE(dladdr(reinterpret_cast<void*>(static_cast<double (*)(double)>(std::tgamma)), &libm) != 0);
  CHECK(reason(libm.dli_fname) == "is no bodeflow plugin: it has no note of the bodeflow SDK");
}

TEST_CASE("a plugin of another ABI is refused before its constructor could crash") {
  CHECK(reason(fixture("wrong_abi")) == "needs plugin ABI 2.0, this host has 1.0: update bodeflow");
  CHECK(reason(fixture("newer_abi")) == "needs plugin ABI 1.1, this host has 1.0: update bodeflow");
  CHECK(reason(fixture("two_minds_on_abi")) == "needs plugin ABI 3.0, this host has 1.0: update bodeflow");
}

TEST_CASE("a plugin without a usable symbol is refused") {
  CHECK(reason(fixture("no_symbol")) == "exports no symbol 'bodeflow_plugin_v1'");
  CHECK(reason(fixture("wrong_magic")) == "its symbol 'bodeflow_plugin_v1' begins with a wrong magic number");
  CHECK(reason(fixture("undefined")) == "can't be loaded: undefined symbol: this_function_exists_nowhere");
}

TEST_CASE("a plugin that crashes is named with the signal, and the others work") {
  const Registry registry(options({fixture("crash_in_constructor"), fixture("good"), fixture("crash_in_factories"),
                                   fixture("throws_in_static"), fixture("exit_in_constructor")}));
  const auto& found = registry.plugins();
  REQUIRE(found.size() == 5);
  CHECK(found[0].refused == "crashes while loading: SIGSEGV (Segmentation fault)");
  CHECK(found[1].refused.empty());
  CHECK(found[2].refused == "crashes while loading: SIGABRT (Aborted)");
  CHECK(found[3].refused == "crashes while loading: SIGABRT (Aborted):   what():  the table of the sensor is missing");
  CHECK(found[4].refused == "ends the program while loading, with exit code 7: no licence found");
  CHECK(found[2].name == "broken");
  CHECK(registry.ids() == std::vector<std::string>{"fixture.gain", "fixture.thrower"});
}

TEST_CASE("a plugin that hangs while loading is refused after the time limit") {
  Registry::Options limited = options({fixture("hang_in_constructor")});
  limited.probe_timeout_s = 0.25;
  const Registry registry(limited);
  CHECK(registry.plugins().at(0).refused == "does not describe itself within 0.25 s");
}

TEST_CASE("a plugin whose description is wrong is refused with what is wrong") {
  CHECK(reason(fixture("null_id")) == "a block's id is a null pointer");
  CHECK(reason(fixture("null_port_name")) == "block 'broken.block': a port's name is a null pointer");
  CHECK(reason(fixture("other_id")) == "block 'broken.other': its factory is named 'broken.block'");
  CHECK(reason(fixture("twice")) == "gives block 'broken.block' twice");
  CHECK(reason(fixture("many_ports")) == "block 'broken.block': 4000000000 ports, at most 1024 expected");
  CHECK(reason(fixture("factories_fail")) == "has no factories: the licence server does not answer");
}

TEST_CASE("a block id that an earlier plugin gives makes the later one refused, both files named") {
  const Registry registry(options({fixture("good"), fixture("duplicate")}));
  CHECK(registry.plugins().at(0).refused.empty());
  CHECK(registry.plugins().at(1).refused ==
        "gives block 'fixture.gain', which " + std::filesystem::canonical(fixture("good")).string() + " gives already");
  CHECK(registry.plugin_of("fixture.gain") == &registry.plugins()[0]);
  const Registry reversed(options({fixture("duplicate"), fixture("good")}));
  CHECK(reversed.ids() == std::vector<std::string>{"fixture.gain"});
}

TEST_CASE("what a plugin prints while it is loaded does not disturb its description") { CHECK(reason(fixture("noise")).empty()); }

TEST_CASE("a probe command that can't be started is told for every plugin") {
  Registry::Options wrong = options({fixture("good")});
  wrong.probe_command = "/nowhere/bodeflow";
  const Registry registry(wrong);
  CHECK(registry.plugins().at(0).refused == "can't be probed: /nowhere/bodeflow can't be started: No such file or directory");
}

TEST_CASE("plugins are found in folders by name, each file once") {
  const Folder folder;
  std::filesystem::copy_file(fixture("plain"), folder / "b.so");
  std::filesystem::create_symlink(folder / "b.so", folder / "c.so");
  std::filesystem::copy_file(fixture("good"), folder / "a.so");
  write(folder / "README.md", "not looked at");
  std::filesystem::create_directory(folder / "d.so");
  const Registry registry(options({folder / "nowhere", folder / "", folder / "a.so"}));
  REQUIRE(registry.plugins().size() == 2);
  CHECK(std::filesystem::path(registry.plugins()[0].file).filename() == "a.so");
  CHECK(std::filesystem::path(registry.plugins()[1].file).filename() == "b.so");
  CHECK(registry.ids() == std::vector<std::string>{"fixture.gain", "fixture.thrower", "plain.scale"});
}

TEST_CASE("a plugin that changed since its probe is refused when it is first used") {
  Registry registry(options({fixture("changes")}));
  REQUIRE(registry.find("broken.block") != nullptr);
  setenv("BODEFLOW_FIXTURE_CHANGED", "1", 1);
  const auto made = Instance::make(registry, "broken.block", "b", nullptr);
  unsetenv("BODEFLOW_FIXTURE_CHANGED");
  REQUIRE_FALSE(made);
  CHECK(made.error() == "plugin 'broken' (" + std::filesystem::canonical(fixture("changes")).string() +
                            "): describes itself otherwise than when it was probed; was the file replaced?");
}

TEST_CASE("the default search path begins with BODEFLOW_PLUGIN_PATH and goes on beside the executable and at home") {
  const char* home = std::getenv("HOME");
  const std::string old_home = home == nullptr ? "" : home;
  setenv("BODEFLOW_PLUGIN_PATH", "/one::/two:", 1);
  setenv("HOME", "/home/eva", 1);
  const auto path = default_plugin_path();
  unsetenv("BODEFLOW_PLUGIN_PATH");
  if (home == nullptr)
    unsetenv("HOME");
  else
    setenv("HOME", old_home.c_str(), 1);
  const auto prefix = std::filesystem::canonical("/proc/self/exe").parent_path().parent_path();
  REQUIRE(path.size() >= 5);
  CHECK(path[0] == "/one");
  CHECK(path[1] == "/two");
  CHECK(path[2] == prefix / "plugins");
  CHECK(path[3] == prefix / "lib/bodeflow/plugins");
  CHECK(path.back() == "/home/eva/.local/lib/bodeflow/plugins");
}
