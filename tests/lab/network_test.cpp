// Three hosts as network namespaces, joined by a bridge.
#include "catch.hpp"
#include "lab.hpp"

using namespace bodeflow::test;

namespace {

const std::string kGraphs = BODEFLOW_SOURCE_DIR "/graphs/lab/";

void require_same(TestLab& lab, const Hosts& hosts, const std::string& graph) {
  Process here(lab.run_here(graph, "here"));
  REQUIRE(here.wait() == 0);
  Process run(lab.run_on(hosts, graph, "hosts"));
  const int code = run.wait();
  INFO(run.output());
  REQUIRE(code == 0);
  REQUIRE_FALSE(lab.hashes("here").empty());
  CHECK(lab.hashes("hosts") == lab.hashes("here"));
}

/// A lab's authority with certificates of bench, controller and desk.
class Authority {
 public:
  Authority() {
    const std::string trust = std::string(BODEFLOW_COMMAND " trust ");
    REQUIRE(shell(trust + "init --lab test --dir " + folder() + " > /dev/null") == 0);
    for (const std::string name : {"bench", "controller", "desk"}) {
      const std::string own = of(name);
      REQUIRE(shell(trust + "add " + name + " --dir " + folder() + " --out " + own + ".tar > /dev/null") == 0);
      REQUIRE(shell("mkdir " + own + " && tar -xf " + own + ".tar -C " + own) == 0);
    }
  }
  std::string folder() const { return of("trust"); }
  /// Options of a command that runs under that name on that host.
  std::vector<std::string> options(const std::string& name, int host) const {
    return {"--trust", of(name), "--interface", Hosts::address(host)};
  }

 private:
  std::string of(const std::string& name) const { return (files_.path() / name).string(); }
  Folder files_;
};

}  // namespace

TEST_CASE("lab: a closed loop over three network namespaces is the same bit for bit as in one process") {
  const Hosts hosts(3);
  if (skipped(hosts)) return;
  TestLab lab(network_options());
  lab.agents_on(hosts);
  require_same(lab, hosts, kGraphs + "closed_loop.yaml");
}

TEST_CASE("lab: hosts with certificates of the lab run together and strangers stay outside") {
  const Hosts hosts(3);
  if (skipped(hosts)) return;
  const Authority authority;
  TestLab lab(network_options({}));
  lab.agent("bench", authority.options("bench", 1), hosts.on(1, {}));
  lab.agent("controller", authority.options("controller", 2), hosts.on(2, {}));

  Process stranger(hosts.on(0, lab.run(kGraphs + "closed_loop.yaml", "stranger",
                                       {"--let-anyone-on-the-network-in", "--interface", Hosts::address(0)})));
  CHECK(stranger.wait() == 5);
  CHECK(stranger.output().find("nobody is in the lab") != std::string::npos);

  Process here(lab.run_here(kGraphs + "closed_loop.yaml", "here"));
  REQUIRE(here.wait() == 0);
  Process run(hosts.on(0, lab.run(kGraphs + "closed_loop.yaml", "hosts", authority.options("desk", 0))));
  const int code = run.wait();
  INFO(run.output());
  REQUIRE(code == 0);
  CHECK(lab.hashes("hosts") == lab.hashes("here"));
}

TEST_CASE("lab: a revoked host is kept out once the agents have heard of it") {
  const Hosts hosts(3);
  if (skipped(hosts)) return;
  const Authority authority;
  TestLab lab(network_options({}));
  Process& bench = lab.agent("bench", authority.options("bench", 1), hosts.on(1, {}));
  Process& controller = lab.agent("controller", authority.options("controller", 2), hosts.on(2, {}));

  Process revoke(hosts.on(0, {BODEFLOW_COMMAND, "trust", "revoke", "controller", "--dir", authority.folder(), "--tell-as", "desk",
                              "--domain", std::to_string(test_domain()), "--interface", Hosts::address(0)}));
  REQUIRE(revoke.wait() == 0);
  CHECK(revoke.output().find("The agent of 'bench' has been sent the new list") != std::string::npos);
  CHECK(bench.prints("joining anew"));
  CHECK(controller.wait() == 2);
  CHECK(controller.output().find("the certificate of host 'controller' is revoked") != std::string::npos);
}
