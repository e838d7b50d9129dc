#include <csignal>

#include "catch.hpp"
#include "command.hpp"

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

using namespace bodeflow::test;

namespace {

/// Runs a graph with a block that crashes.
Ended run_with(const std::string& plugin, const std::string& command) {
  const Folder folder;
  folder.write("graph.yaml",
               "bodeflow: 1\nrun: {duration: 1 s}\nblocks:\n"
               "  source: {block: generators.noise, sample_rate: 1 kHz, std: 1}\n"
               "  culprit: {block: broken.block}\n"
               "connections: [source -> culprit]\n");
  const std::string file = std::string(BODEFLOW_BUILD_DIR) + "/tests/runtime/plugins/fixtures/" + plugin + ".so";
  return run_bodeflow({"--path", file, command, "graph.yaml"}, folder.path());
}

}  // namespace

TEST_CASE("a block that crashes is named before the process dies of it") {
  const Ended creating = run_with("crash_in_create", "check");
  CHECK(creating.exit_code == 128 + SIGABRT);
  CHECK(creating.err.find("error: crashed (Aborted) in block 'culprit' (broken.block)\n") != std::string::npos);
  const Ended processing = run_with("crash_in_process", "run");
  CHECK(processing.exit_code == 128 + SIGSEGV);
  CHECK(processing.err.find("error: crashed (Segmentation fault) in block 'culprit' (broken.block)\n") != std::string::npos);
}

#endif
