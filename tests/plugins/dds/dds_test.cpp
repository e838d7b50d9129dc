// Topics between running graphs, and between graphs and other programs.
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <sstream>

#include "catch.hpp"
#include "system/command.hpp"
#include "transport/processes.hpp"

using bodeflow::test::Folder;
namespace fs = std::filesystem;

namespace {

std::vector<std::string> graph(const std::string& file, const fs::path& out, std::vector<std::string> settings) {
  std::vector<std::string> command = {BODEFLOW_BUILD_DIR "/bin/bodeflow", "run", file, "--out", out.string()};
  settings.push_back("domain=" + std::to_string(test_domain()));
  for (const auto& setting : settings) command.insert(command.end(), {"--set", setting});
  return command;
}

std::string ours(const std::string& name) { return BODEFLOW_SOURCE_DIR "/graphs/dds/" + name; }

/// What a run logged or why it failed: its standard error.
std::vector<std::string> with_errors(std::vector<std::string> command) {
  std::string line = "exec";
  for (const auto& word : command) line += " '" + word + "'";
  return {"sh", "-c", line + " 2>&1"};
}

/// Waits until a run's phase has begun.
bool begins(const fs::path& run) {
  return shell("for i in $(seq 400); do grep -qs 'phase begins' " + (run / "events.jsonl").string() +
               " && exit 0; sleep 0.02; done; exit 1") == 0;
}

}  // namespace

TEST_CASE("a topic is recorded and its recording replayed bit for bit") {
  const Folder folder;
  const auto& path = folder.path();
  {
    Process record(graph(ours("record_topic.yaml"), path / "a", {"topic=speed"}));
    Process publish(graph(ours("publish.yaml"), path / "b", {"topic=speed"}));
    CHECK(publish.wait() == 0);
    CHECK(record.wait() == 0);
  }
  const auto recorded = folder.read("a/topic.csv");
  CHECK(std::count(recorded.begin(), recorded.end(), '\n') == 10001);
  Process record(graph(ours("record_topic.yaml"), path / "c", {"topic=again"}));
  Process replay(graph(ours("replay_topic.yaml"), path / "d", {"topic=again", "file=" + (path / "a/topic.csv").string()}));
  CHECK(replay.wait() == 0);
  CHECK(record.wait() == 0);
  CHECK(folder.read("c/topic.csv") == recorded);
}

TEST_CASE("a topic that carries something else than stated is refused by name") {
  const Folder folder;
  Process subscribe(with_errors(graph(ours("record_topic.yaml"), folder.path() / "a", {"topic=other", "rate=2 kHz"})));
  Process publish(graph(ours("publish.yaml"), folder.path() / "b", {"topic=other"}));
  CHECK(subscribe.wait() == 5);
  CHECK(subscribe.output().find("block 'subscribe': topic 'other' carries 1000.000000 samples/s; stated here: 2000.000000 Hz") !=
        std::string::npos);
}

TEST_CASE("a stream that a program outside publishes becomes a stream of a graph") {
  const Folder folder;
  Process subscribe(graph(ours("record_topic.yaml"), folder.path() / "a", {"topic=outside"}));
  Process outside(peer("send", {"topic=outside", "open=1", "count=10", "bytes=8000"}));
  CHECK(outside.wait() == 0);
  CHECK(subscribe.wait() == 0);
  const auto csv = folder.read("a/topic.csv");
  CHECK(csv.find("\n0.001,1\n") != std::string::npos);
  CHECK(csv.find("\n9.999,9999\n") != std::string::npos);
}

TEST_CASE("a subscriber that waits ends at an interrupt") {
  const Folder folder;
  Process subscribe(with_errors(graph(ours("record_topic.yaml"), folder.path() / "a", {"topic=silent"})));
  REQUIRE(shell("for i in $(seq 200); do [ -e " + (folder.path() / "a/events.jsonl").string() +
                " ] && exit 0; sleep 0.02; done; exit 1") == 0);
  shell("sleep 0.3");
  subscribe.interrupt();
  CHECK(subscribe.prints("interrupted"));
  CHECK(subscribe.wait() == 130);
}

TEST_CASE("nobody on a topic within the tolerance ends the run with the topic's name") {
  const Folder folder;
  folder.write("graph.yaml", R"(bodeflow: 1
title: nobody
run: {clock: simulated, duration: 1 s}
variables: {domain: 0}
blocks:
  subscribe: {block: dds.subscribe, topic: nobody, rate: 1 kHz, tolerance: 0.3 s, domain: "${domain}"}
record: [subscribe.out]
)");
  Process run(with_errors(graph((folder.path() / "graph.yaml").string(), folder.path() / "a", {})));
  CHECK(run.wait() == 5);
  CHECK(run.output().find("block 'subscribe': topic 'nobody': no writer came within 0.3 s") != std::string::npos);
}

TEST_CASE("a subscriber that joins a running publisher says where it begins and has every sample from there on") {
  const Folder folder;
  const auto& path = folder.path();
  const std::vector<std::string> joined = {"topic=running"};
  Process first(graph(ours("record_topic.yaml"), path / "first", joined));
  Process publish(graph(ours("publish.yaml"), path / "publish", {"topic=running", "run.clock=realtime", "run.duration=6 s"}));
  REQUIRE(begins(path / "publish"));
  shell("sleep 1.5");
  Process late(with_errors(graph(ours("record_topic.yaml"), path / "late", joined)));
  for (Process* process : {&publish, &first, &late}) CHECK(process->wait() == 0);
  const auto values = [&](const std::string& csv) {  // without the times: those of a recording begin at zero
    std::istringstream lines(folder.read(csv));
    std::vector<std::string> found;
    for (std::string line; std::getline(lines, line);) found.push_back(line.substr(line.find(',')));
    found.erase(found.begin());
    return found;
  };
  const auto all = values("first/topic.csv"), rest = values("late/topic.csv");
  CHECK(all.size() == 6000);
  const std::string said = late.output(), words = "topic 'running': joined a stream that runs, at its sample ";
  INFO(said);
  REQUIRE(said.find(words) != std::string::npos);
  const auto begin = std::stoul(said.substr(said.find(words) + words.size()));
  CHECK(begin > 0);
  CHECK(said.find("stands still") == std::string::npos);  // a message a second is what it brings
  REQUIRE(begin + rest.size() == all.size());
  CHECK(std::equal(rest.begin(), rest.end(), all.begin() + static_cast<std::ptrdiff_t>(begin)));
}

TEST_CASE("a subscriber that joins late gets the record that the topic keeps, at once") {
  const Folder folder;
  const auto& path = folder.path();
  folder.write("publish.yaml", R"(bodeflow: 1
run: {clock: realtime, duration: 7.4 s, seed: 4, chunk: 50}
variables: {domain: 0}
blocks:
  sines: {block: generators.multisine, sample_rate: 1 kHz, period: 100, lines: {first: 1, last: 9, step: 2}}
  response: {block: spectrum.averaging_dft, period: 100, every: 25, form: known_input}
  publish: {block: dds.publish_records, topic: state, keep_last: true, readers: 0, domain: "${domain}"}
  keep: {block: output.records, file: sent.jsonl}
connections: [sines -> response.input, sines -> response.output, response -> publish, response -> keep]
)");
  folder.write("subscribe.yaml", R"(bodeflow: 1
run: {clock: simulated, duration: 1 s}
variables: {domain: 0}
blocks:
  subscribe: {block: dds.subscribe_records, topic: state, keep_last: true, count: 1, domain: "${domain}"}
  keep: {block: output.records, file: got.jsonl}
connections: [subscribe -> keep]
)");
  Process publish(with_errors(graph((path / "publish.yaml").string(), path / "a", {})));
  REQUIRE(begins(path / "a"));
  shell("sleep 2.7");  // the first record is sent after 2.5 s, the second after 5 s
  const auto joins = std::chrono::steady_clock::now();
  Process late(with_errors(graph((path / "subscribe.yaml").string(), path / "b", {})));
  const int subscribed = late.wait();
  const auto joined = std::chrono::steady_clock::now();
  const int published = publish.wait();
  INFO(publish.output() << late.output());
  REQUIRE(subscribed == 0);
  CHECK(published == 0);
  const std::string sent = folder.read("a/sent.jsonl"), got = folder.read("b/got.jsonl");
  const auto body = [](const std::string& line) { return line.substr(line.find("\"type\"")); };
  const bool first = body(got) == body(sent.substr(0, sent.find('\n') + 1));
  CHECK((first || joined - joins > std::chrono::seconds(2)));
}

TEST_CASE("a topic whose writer is dead is told within a second, before the tolerance ends the run") {
  for (const std::string latest : {"false", "true"}) {
    const Folder folder;
    folder.write("graph.yaml", R"(bodeflow: 1
run: {clock: simulated, duration: 100 s}
variables: {domain: 0, latest: false}
blocks:
  subscribe: {block: dds.subscribe, topic: dying, rate: 1 kHz, tolerance: 4 s, latest: "${latest}", domain: "${domain}"}
record: [subscribe.out]
)");
    Process run(with_errors(graph((folder.path() / "graph.yaml").string(), folder.path() / "a", {"latest=" + latest})));
    Process writer(peer("send", {"topic=dying", "open=1", "count=100000", "bytes=800", "pause_us=100000",
                                 latest == "true" ? "lossless=0" : "lossless=1"}));
    REQUIRE(begins(folder.path() / "a"));
    REQUIRE(writer.prints("connected"));
    shell("sleep 1.5");
    writer.signal(9);
    CHECK(run.prints("topic 'dying' stands still: nothing came for 0.8 s", 3.5));
    CHECK(run.wait() == 5);
    INFO(run.output());
    CHECK(run.output().find("block 'subscribe': topic 'dying': ") != std::string::npos);
  }
}

TEST_CASE("records travel whole from graph to graph") {
  const Folder folder;
  folder.write("publish.yaml", R"(bodeflow: 1
title: records out
run: {clock: simulated, duration: 3 s, seed: 4}
variables: {domain: 0}
blocks:
  noise: {block: generators.noise, sample_rate: 1 kHz}
  record: {block: acquisition.recording}
  publish: {block: dds.publish_records, topic: experiments, domain: "${domain}"}
  keep: {block: output.records, file: sent.jsonl}
connections:
  - noise -> record.input
  - noise -> record.output
  - record -> publish
  - record -> keep
)");
  folder.write("subscribe.yaml", R"(bodeflow: 1
title: records in
run: {clock: simulated, duration: 1 s}
variables: {domain: 0}
blocks:
  subscribe: {block: dds.subscribe_records, topic: experiments, domain: "${domain}"}
  keep: {block: output.records, file: got.jsonl}
connections:
  - subscribe -> keep
)");
  Process subscribe(with_errors(graph((folder.path() / "subscribe.yaml").string(), folder.path() / "a", {})));
  Process publish(with_errors(graph((folder.path() / "publish.yaml").string(), folder.path() / "b", {})));
  const int published = publish.wait(), subscribed = subscribe.wait();
  INFO(publish.output() << subscribe.output());
  CHECK(published == 0);
  REQUIRE(subscribed == 0);
  const auto body = [](const std::string& line) { return line.substr(line.find("\"type\"")); };
  CHECK(folder.read("b/sent.jsonl").size() > 10000);
  CHECK(body(folder.read("a/got.jsonl")) == body(folder.read("b/sent.jsonl")));
}
