#include <csignal>
#include <thread>

#include "catch.hpp"
#include "lab.hpp"

using bodeflow::test::TestLab;

namespace {

const std::string kGraphs = BODEFLOW_SOURCE_DIR "/graphs/lab/";

/// A run that is paced by the clock, so that something can happen to it, with its motor on the bench.
const char* const kPaced = R"(bodeflow: 1
run: {clock: realtime, duration: 20 s, seed: 1, tolerance: 1.5 s}
blocks:
  excitation: {block: generators.sine, sample_rate: 1 kHz, frequency: 10 Hz}
  motor: {block: plants.linear, numerator: [1], denominator: [0.1, 1]}
  gain: {block: filters.gain, gain: 2}
connections: [excitation -> motor -> gain]
record: [excitation.out, gain.out]
hosts: {bench: [motor]}
)";

void require_same(TestLab& lab, const std::string& graph) {
  const auto before = lab.runs_of("bench");
  Process here(lab.run_here(graph, "here"));
  INFO(here.output());
  REQUIRE(here.wait() == 0);
  Process over_hosts(lab.run(graph, "hosts"));
  const int code = over_hosts.wait();
  INFO(over_hosts.output());
  REQUIRE(code == 0);
  REQUIRE_FALSE(lab.hashes("here").empty());
  CHECK(lab.hashes("hosts") == lab.hashes("here"));
  const auto results = [&](const std::string& out) {
    return nlohmann::json::parse(lab.folder().read(out + "/result.json"))["results"];
  };
  CHECK(results("hosts") == results("here"));
  INFO("what the parts kept while they ran is gone once it was fetched");
  CHECK_FALSE(std::filesystem::exists(lab.path("hosts/own_part")));
  for (int i = 0; i < 100 && lab.runs_of("bench") != before; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(50));
  CHECK(lab.runs_of("bench") == before);
}

}  // namespace

TEST_CASE("lab: a response measured over two machines is the same bit for bit as in one process") {
  TestLab lab;
  lab.agent("bench");
  require_same(lab, kGraphs + "frequency_response.yaml");
}

TEST_CASE("lab: a closed loop over three machines is the same bit for bit as in one process") {
  TestLab lab;
  lab.agent("bench");
  lab.agent("controller");
  require_same(lab, kGraphs + "closed_loop.yaml");
}

TEST_CASE("lab: a limit is enforced on the machine of its block and ends the run of all") {
  TestLab lab;
  lab.agent("bench");
  const std::string limited = kPaced + std::string("limits: [{signal: motor.in, max: 0.5}, {signal: motor.out, max: 0.05}]\n");
  Process run(lab.run(lab.folder().write("limited.yaml", limited).string(), "out"));
  const int code = run.wait();
  INFO(run.output());
  CHECK(code == 7);
  CHECK(run.output().find("host 'bench': limit violated: motor.out is ") != std::string::npos);
  CHECK(run.output().find("motor.in is 0.53") != std::string::npos);  // told by the bench: held within
  CHECK(nlohmann::json::parse(lab.folder().read("out/manifest.json"))["status"] == "limit");
}

TEST_CASE("lab: phases over machines hand records on as in one process") {
  TestLab lab;
  lab.agent("bench");
  lab.agent("desk");
  lab.folder().write("phases.yaml", R"(bodeflow: 1
run: {clock: simulated, duration: 4 s, seed: 3}
phases:
  - name: measure
    blocks:
      excitation: {block: generators.multisine, sample_rate: 500 Hz, period: 500, lines: {first: 1, last: 99, step: 2}, amplitude: 1 V, unit: V}
      plant: {block: plants.linear, domain: discrete, numerator: [0.1, 0.05], denominator: [1, -1.5, 0.7]}
      response: {block: spectrum.averaging_dft, period: 500, skip: 1, form: known_input, lines: {first: 1, last: 99, step: 2}}
    connections: [excitation -> plant -> response.output, excitation -> response.input]
  - name: identify
    blocks:
      model: {block: sanathanan_koerner.model, order: 2}
    connections: [$measure.response -> model.response]
hosts: {bench: [excitation, plant], desk: [model]}
)");
  require_same(lab, lab.path("phases.yaml"));
}

TEST_CASE("lab: a host that is not there is named and nothing starts") {
  TestLab lab;
  lab.agent("controller");
  Process run(lab.run(kGraphs + "closed_loop.yaml", "out"));
  CHECK(run.wait() == 5);
  CHECK(run.output().find("no agent of host bench is there; in the lab: controller: start 'bodeflow agent --name bench' there") !=
        std::string::npos);
}

TEST_CASE("lab: a second agent of the same name is refused") {
  TestLab lab;
  lab.agent("bench");
  Process second(lab.agent_command("bench"));
  CHECK(second.wait() == 5);
  CHECK(second.output().find("the lab has an agent called 'bench' already") != std::string::npos);
}

TEST_CASE("lab: another build of a plugin is refused before anything starts") {
  TestLab lab;
  REQUIRE(shell("mkdir " + lab.path("plugins") + " && cp " BODEFLOW_PLUGINS "/*.so " + lab.path("plugins") + " && printf x >> " +
                lab.path("plugins") + "/plants.so") == 0);
  lab.agent("bench", {"--path", lab.path("plugins")});
  Process run(lab.run(kGraphs + "frequency_response.yaml", "out"));
  CHECK(run.wait() == 5);
  CHECK(run.output().find(
            "host 'bench' does not fit this machine, nothing was started: plugin 'plants' 0.1.0 is another build there") !=
        std::string::npos);
}

TEST_CASE("lab: a failing block on another machine ends the run with its words and keeps what there was") {
  TestLab lab;
  lab.agent("bench");
  lab.folder().write("failing.yaml", R"(bodeflow: 1
run: {clock: simulated, duration: 1 s}
blocks:
  excitation: {block: generators.sine, sample_rate: 1 kHz, frequency: 10 Hz}
  unstable: {block: plants.linear, domain: discrete, numerator: [1], denominator: [1, -9]}
  dft: {block: spectrum.averaging_dft, period: 100, form: known_input}
connections: [excitation -> unstable -> dft.output, excitation -> dft.input]
record: [excitation.out]
hosts: {bench: [unstable, dft]}
)");
  Process run(lab.run(lab.path("failing.yaml"), "out"));
  const int code = run.wait();
  INFO(run.output());
  CHECK(code == 1);
  CHECK(run.output().find("error: block 'dft': host 'bench': ") != std::string::npos);
  CHECK(nlohmann::json::parse(lab.folder().read("out/manifest.json"))["status"] == "failed");
}

TEST_CASE("lab: a device that fails on another machine gives the exit code of a device") {
  TestLab lab;
  lab.agent("bench");
  lab.folder().write("device.yaml", R"(bodeflow: 1
run: {clock: realtime, duration: 1 s}
blocks:
  adc: {block: acquisition.alsa_capture, device: nowhere, rate: 48 kHz}
  gain: {block: filters.gain, gain: 2}
connections: [adc -> gain]
hosts: {bench: [adc]}
)");
  Process run(lab.run(lab.path("device.yaml"), "out"));
  const int code = run.wait();
  INFO(run.output());
  CHECK(code == 5);
  CHECK(run.output().find("block 'adc': host 'bench': sound device 'nowhere' (capture) can't be opened") != std::string::npos);
}

TEST_CASE("lab: a paced run tells how each host kept time") {
  TestLab lab;
  lab.agent("bench");
  const auto graph = lab.folder().write("paced.yaml", kPaced).string();
  Process run(lab.run(graph, "out", {"--set", "run.duration=1 s", "--set", "run.chunk=10"}));
  const int code = run.wait();
  INFO(run.output());
  REQUIRE(code == 0);
  CHECK(run.output().find("bench: clock: 99 chunks began late by ") != std::string::npos);
  const auto hosts = nlohmann::json::parse(lab.folder().read("out/manifest.json"))["hosts"];
  REQUIRE(hosts.size() == 2);
  for (const auto& host : hosts) {
    CHECK(host["status"] == "complete");
    CHECK(host["pacing"]["clock"] == "realtime");
    CHECK(host["pacing"]["chunks"] == 99);
  }
  CHECK(hosts[0]["host"] == "launcher");
  CHECK(hosts[1]["host"] == "bench");
  CHECK(lab.folder().read("out/report.html").find("id=\"Pacing\"") != std::string::npos);
}

TEST_CASE("lab: Ctrl-C ends all parts and the agent serves the next run") {
  TestLab lab;
  Process& bench = lab.agent("bench");
  const auto graph = lab.folder().write("paced.yaml", kPaced).string();
  {
    Process run(lab.run(graph, "out"));
    REQUIRE(bench.prints("begins"));
    std::this_thread::sleep_for(std::chrono::seconds(2));
    (void)shell("pkill -INT -f -- '^" BODEFLOW_COMMAND " run .*--out " + lab.path("out") + " '");
    CHECK(run.wait() == 130);
    CHECK(run.output().find("interrupted; what was recorded is kept") != std::string::npos);
  }
  CHECK(bench.prints("ends with exit code 0"));
  CHECK(lab.hashes("out").contains("gain.out"));
  require_same(lab, kGraphs + "frequency_response.yaml");
}

TEST_CASE("lab: an agent killed in a run ends it by name and keeps what the others recorded") {
  TestLab lab;
  Process& bench = lab.agent("bench");
  Process run(lab.run(lab.folder().write("paced.yaml", kPaced).string(), "out"));
  REQUIRE(bench.prints("begins"));
  std::this_thread::sleep_for(std::chrono::seconds(2));
  lab.crash("bench");
  const int code = run.wait();
  INFO(run.output());
  CHECK(code == 1);
  CHECK(run.output().find("bench") != std::string::npos);
  CHECK(lab.hashes("out").contains("excitation.out"));
}

TEST_CASE("lab: a killed launcher ends the parts of its run and the agent serves the next one") {
  TestLab lab;
  Process& bench = lab.agent("bench");
  {
    Process run(lab.run(lab.folder().write("paced.yaml", kPaced).string(), "out"));
    REQUIRE(lab.has_graph("bench"));
    std::this_thread::sleep_for(std::chrono::seconds(1));
    (void)shell("pkill -9 -f -- '^" BODEFLOW_COMMAND " run .*--out " + lab.path("out") + " '");
  }
  CHECK(bench.prints("nothing was heard of the launcher for 1.5 s; what was recorded is in"));
  CHECK(bench.prints("ends with exit code 1"));
  require_same(lab, kGraphs + "frequency_response.yaml");
}

TEST_CASE("lab: an agent without certificates refuses to listen to the network unless it is told in plain words") {
  const bodeflow::test::Folder folder;
  const auto ended =
      bodeflow::test::run_bodeflow({"agent", "--name", "bench", "--trust", (folder.path() / "none").string()}, folder.path());
  CHECK(ended.exit_code == 2);
  CHECK(ended.err.find("--let-anyone-on-the-network-in (no protection at all)") != std::string::npos);
}

TEST_CASE("lab: hosts tells who is there and how far their clocks are") {
  TestLab lab;
  lab.agent("bench");
  Process hosts(
      {"sh", "-c",
       std::string("exec " BODEFLOW_COMMAND " hosts --json --wait 1 --loopback --domain ") + std::to_string(test_domain())});
  REQUIRE(hosts.wait() == 0);
  const auto list = nlohmann::json::parse(hosts.output());
  REQUIRE(list.size() == 1);
  CHECK(list[0]["agent"] == "bench");
  CHECK(list[0]["differs"] == "");
  CHECK(std::abs(list[0]["clock_offset_s"].get<double>()) <= list[0]["clock_uncertainty_s"].get<double>());
}
