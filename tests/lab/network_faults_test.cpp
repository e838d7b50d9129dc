// Faults of the network in the middle of a run: nothing is lost within the tolerance.
#include <csignal>

#include "catch.hpp"
#include "lab.hpp"
#include "processes_of.hpp"

using namespace bodeflow::test;
using nlohmann::json;

namespace {

const std::string kLoop = closed_loop("clock: realtime, duration: 4 s, seed: 1");

}  // namespace

TEST_CASE("lab: a closed loop over hosts is the same bit for bit where one datagram in twenty is lost") {
  const Hosts hosts(3);
  if (skipped(hosts)) return;
  TestLab lab(network_options());
  lab.agents_on(hosts);
  const auto graph = lab.folder().write("loop.yaml", kLoop).string();
  const json hashes = lab.hashes_here(kLoop);
  Process run(lab.run_on(hosts, graph, "hosts"));
  REQUIRE(lab.part_of("bench") > 0);
  REQUIRE(lab.part_of("controller") > 0);
  sleep_s(0.3);
  const auto processes = processes_with({lab.folder().path().string()});
  CHECK(processes.size() == 6);  // two agents, the launcher, three parts
  for (const int process : processes) CHECK(bodeflow::test::lose(process, 0.05) > 0);
  lab.require_complete(run, "hosts", hashes);
}

TEST_CASE("lab: a link that is down for five seconds loses nothing") {
  const Hosts hosts(3);
  if (skipped(hosts)) return;
  TestLab lab(network_options());
  lab.agents_on(hosts);
  const std::string text = closed_loop("clock: realtime, duration: 7 s, seed: 1, tolerance: 10 s");
  const json hashes = lab.hashes_here(text);
  Process run(lab.run_on(hosts, lab.folder().write("loop.yaml", text).string(), "hosts"));
  lab.begun("bench");
  sleep_s(1.0);
  hosts.link(1, false);
  const bool told = run.prints("stands still", 4.5);
  sleep_s(5.0);
  hosts.link(1, true);
  CHECK(told);
  lab.require_complete(run, "hosts", hashes);
  const auto links = lab.links("hosts");
  CHECK(links.size() == 8);
  for (const json& link : links) {
    INFO(link.dump());
    CHECK(link["samples"] == loop_samples(link, 700));
    CHECK(link["gaps"] == 0);
  }
}

TEST_CASE("lab: a run goes on when the discovery server is killed") {
  if (shell("command -v fast-discovery-server > /dev/null") != 0) {
    WARN("skipped: fast-discovery-server is not installed (fastdds-tools)");
    return;
  }
  const Hosts hosts(3);
  if (skipped(hosts)) return;
  Process server(hosts.on(0, {"fast-discovery-server", "-i", "0", "-l", Hosts::address(0), "-p", "11811"}));
  std::vector<std::string> options = network_options();
  options.insert(options.end(), {"--discovery-server", Hosts::address(0) + ":11811"});
  TestLab lab(options);
  lab.agents_on(hosts);
  const auto graph = lab.folder().write("loop.yaml", kLoop).string();
  const json hashes = lab.hashes_here(kLoop);
  Process run(lab.run_on(hosts, graph, "hosts"));
  REQUIRE(lab.has_graph("bench"));
  sleep_s(3.0);
  server.signal(SIGKILL);
  lab.require_complete(run, "hosts", hashes);
}
