// Three hosts as network namespaces, joined by a bridge.
#include <thread>

#include "catch.hpp"
#include "lab.hpp"

using bodeflow::test::TestLab;

namespace {

const std::string kGraphs = BODEFLOW_SOURCE_DIR "/graphs/lab/";

std::vector<std::string> network_options(const std::vector<std::string>& trust) {
  std::vector<std::string> options = {"--domain", std::to_string(test_domain())};
  options.insert(options.end(), trust.begin(), trust.end());
  return options;
}

/// Agents on hosts 1 and 2, the launcher on host 0.
void start_agents(TestLab& lab, const Hosts& hosts) {
  lab.agent("bench", {"--interface", Hosts::address(1)}, hosts.on(1, {}));
  lab.agent("controller", {"--interface", Hosts::address(2)}, hosts.on(2, {}));
}

void require_same(TestLab& lab, const Hosts& hosts, const std::string& graph, const std::function<void()>& meanwhile = {}) {
  Process here(lab.run_here(graph, "here"));
  REQUIRE(here.wait() == 0);
  Process run(hosts.on(0, lab.run(graph, "hosts", {"--interface", Hosts::address(0)})));
  if (meanwhile) meanwhile();
  const int code = run.wait();
  INFO(run.output());
  REQUIRE(code == 0);
  REQUIRE_FALSE(lab.hashes("here").empty());
  CHECK(lab.hashes("hosts") == lab.hashes("here"));
}

bool skipped(const Hosts& hosts) {
  if (!hosts.missing().empty()) WARN("skipped: " << hosts.missing());
  return !hosts.missing().empty();
}

const std::vector<std::string> kOpen = {"--let-anyone-on-the-network-in"};

/// As closed_loop.yaml, paced by the clock, so that the network can fail in the middle.
const char* const kPacedLoop = R"(bodeflow: 1
run: {clock: realtime, duration: 6 s, seed: 1}
blocks:
  reference: {block: generators.square, sample_rate: 100 Hz, frequency: 1 Hz}
  error: {block: filters.sum, weights: [1, -1]}
  pi: {block: plants.linear, domain: discrete, numerator: [0.1, -0.09], denominator: [1, -1]}
  way: {block: filters.delay, samples: 2}
  motor: {block: plants.linear, numerator: [1], denominator: [0.1, 1]}
connections: [reference -> error.a, error -> pi -> way -> motor -> error.b]
record: [motor.out, pi.out]
hosts: {bench: [way, motor], controller: [error, pi]}
)";

}  // namespace

TEST_CASE("lab: a closed loop over three network namespaces is the same bit for bit as in one process") {
  const Hosts hosts(3);
  if (skipped(hosts)) return;
  TestLab lab(network_options(kOpen));
  start_agents(lab, hosts);
  require_same(lab, hosts, kGraphs + "closed_loop.yaml");
}

TEST_CASE("lab: a link that is down for three seconds loses nothing") {
  const Hosts hosts(3);
  if (skipped(hosts)) return;
  TestLab lab(network_options(kOpen));
  start_agents(lab, hosts);
  require_same(lab, hosts, lab.folder().write("paced.yaml", kPacedLoop).string(), [&] {
    std::this_thread::sleep_for(std::chrono::seconds(4));
    hosts.link(1, false);
    std::this_thread::sleep_for(std::chrono::seconds(3));
    hosts.link(1, true);
  });
}

TEST_CASE("lab: hosts with certificates of the lab run together and strangers stay outside") {
  const Hosts hosts(3);
  if (skipped(hosts)) return;
  const bodeflow::test::Folder authority;
  const std::string folder = (authority.path() / "trust").string();
  const std::string trust = std::string(BODEFLOW_COMMAND " trust ");
  REQUIRE(shell(trust + "init --lab test --dir " + folder + " > /dev/null") == 0);
  for (const std::string name : {"bench", "controller", "desk"}) {
    const std::string own = (authority.path() / name).string();
    REQUIRE(shell(trust + "add " + name + " --dir " + folder + " --out " + own + ".tar > /dev/null") == 0);
    REQUIRE(shell("mkdir " + own + " && tar -xf " + own + ".tar -C " + own) == 0);
  }
  const auto of = [&](const std::string& name) {
    return std::vector<std::string>{"--trust", (authority.path() / name).string()};
  };
  TestLab lab(network_options({}));
  const auto with = [](std::vector<std::string> a, const std::vector<std::string>& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
  };
  lab.agent("bench", with(of("bench"), {"--interface", Hosts::address(1)}), hosts.on(1, {}));
  lab.agent("controller", with(of("controller"), {"--interface", Hosts::address(2)}), hosts.on(2, {}));

  Process stranger(
      hosts.on(0, lab.run(kGraphs + "closed_loop.yaml", "stranger", with(kOpen, {"--interface", Hosts::address(0)}))));
  CHECK(stranger.wait() == 5);
  CHECK(stranger.output().find("nobody is in the lab") != std::string::npos);

  Process here(lab.run_here(kGraphs + "closed_loop.yaml", "here"));
  REQUIRE(here.wait() == 0);
  Process run(hosts.on(0, lab.run(kGraphs + "closed_loop.yaml", "hosts", with(of("desk"), {"--interface", Hosts::address(0)}))));
  const int code = run.wait();
  INFO(run.output());
  REQUIRE(code == 0);
  CHECK(lab.hashes("hosts") == lab.hashes("here"));
}

TEST_CASE("lab: a revoked host is kept out once the agents have heard of it") {
  const Hosts hosts(3);
  if (skipped(hosts)) return;
  const bodeflow::test::Folder authority;
  const std::string folder = (authority.path() / "trust").string();
  const std::string trust = std::string(BODEFLOW_COMMAND " trust ");
  REQUIRE(shell(trust + "init --lab test --dir " + folder + " > /dev/null") == 0);
  for (const std::string name : {"bench", "controller", "desk"}) {
    const std::string own = (authority.path() / name).string();
    REQUIRE(shell(trust + "add " + name + " --dir " + folder + " --out " + own + ".tar > /dev/null") == 0);
    REQUIRE(shell("mkdir " + own + " && tar -xf " + own + ".tar -C " + own) == 0);
  }
  TestLab lab(network_options({}));
  const auto agent = [&](const std::string& name, int host) -> Process& {
    return lab.agent(name, {"--trust", (authority.path() / name).string(), "--interface", Hosts::address(host)},
                     hosts.on(host, {}));
  };
  Process& bench = agent("bench", 1);
  Process& controller = agent("controller", 2);

  Process revoke(hosts.on(0, {BODEFLOW_COMMAND, "trust", "revoke", "controller", "--dir", folder, "--tell-as", "desk", "--domain",
                              std::to_string(test_domain()), "--interface", Hosts::address(0)}));
  REQUIRE(revoke.wait() == 0);
  CHECK(revoke.output().find("The agent of 'bench' has been sent the new list") != std::string::npos);
  CHECK(bench.prints("joining anew"));
  CHECK(controller.wait() == 2);
  CHECK(controller.output().find("the certificate of host 'controller' is revoked") != std::string::npos);
}
