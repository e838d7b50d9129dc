#include "catch.hpp"
#include "system/command.hpp"

using bodeflow::test::Folder;
using bodeflow::test::run_bodeflow;
using bodeflow::test::run_program;
using Catch::Matchers::Contains;

TEST_CASE("a new plugin outside the tree builds against the installed SDK alone, passes its tests and runs in a graph") {
  const Folder folder;
  const std::string prefix = (folder.path() / "prefix").string();
  const auto installed = run_program({"cmake", "--install", BODEFLOW_BUILD_DIR, "--prefix", prefix}, folder.path());
  INFO(installed.err);
  REQUIRE(installed.exit_code == 0);
  const std::string command = prefix + "/bin/bodeflow";

  const auto made = run_program({command, "new", "plugin", "friction"}, folder.path());
  INFO(made.err);
  REQUIRE(made.exit_code == 0);
  const auto plugin = folder.path() / "friction";
  const auto configured = run_program({"cmake", "-B", "build", "-G", "Ninja", "-DCMAKE_PREFIX_PATH=" + prefix}, plugin);
  INFO(configured.out + configured.err);
  REQUIRE(configured.exit_code == 0);
  const auto built = run_program({"cmake", "--build", "build"}, plugin);
  INFO(built.out + built.err);
  REQUIRE(built.exit_code == 0);
  const auto tested = run_program({"ctest", "--test-dir", "build", "--output-on-failure"}, plugin);
  INFO(tested.out);
  CHECK(tested.exit_code == 0);

  const auto conforms = run_program({command, "test-plugin", "build/friction.so"}, plugin);
  INFO(conforms.out + conforms.err);
  CHECK(conforms.exit_code == 0);
  const auto ran = run_program({command, "--path", "build", "run", "example.yaml", "--out", "out"}, plugin);
  INFO(ran.err);
  CHECK(ran.exit_code == 0);
}

TEST_CASE("new plugin refuses a name that is no identifier and a folder that exists") {
  const Folder folder;
  const auto name = run_bodeflow({"new", "plugin", "Bad-Name"}, folder.path());
  CHECK(name.exit_code == 2);
  CHECK_THAT(name.err, Contains("allowed are lower-case letters, digits and _, a letter first"));
  std::filesystem::create_directory(folder.path() / "taken");
  CHECK(run_bodeflow({"new", "plugin", "taken"}, folder.path()).exit_code == 2);
}

TEST_CASE("test-plugin refuses a file that is no plugin with exit code 4") {
  const Folder folder;
  folder.write("not_a_plugin.so", "text");
  const auto ended = run_bodeflow({"test-plugin", "not_a_plugin.so"}, folder.path());
  CHECK(ended.exit_code == 4);
  CHECK_THAT(ended.err, Contains("not_a_plugin.so"));
}
