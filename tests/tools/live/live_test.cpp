// A run with its page, asked as a browser would, and as nobody should.
#include <unistd.h>

#include <sstream>

#include "catch.hpp"
#include "tools/live/live_run.hpp"

using namespace bodeflow::test;
using Catch::Matchers::Contains;
using nlohmann::json;

namespace {

/// A sine through a gain, in real time.
std::string graph_text(const std::string& duration, const std::string& more = "") {
  return "bodeflow: 1\n"
         "title: A gain by hand\n"
         "run: {clock: realtime, duration: " +
         duration +
         ", chunk: 20}\n"
         "blocks:\n"
         "  sine: {block: generators.sine, sample_rate: 1 kHz, frequency: 5 Hz, unit: V}\n"
         "  gain: {block: filters.gain, gain: 1}\n"
         "  response: {block: spectrum.welch, segment: 256, every: 1}\n"
         "connections:\n"
         "  - sine -> gain -> response.output\n"
         "  - sine -> response.input\n"
         "record: [gain]\n" +
         more;
}

json read_json(const Folder& folder, const std::string& file) { return json::parse(folder.read(file)); }

std::vector<json> events(const Folder& folder, const std::string& run, const std::string& what) {
  std::vector<json> found;
  std::istringstream lines(folder.read(run + "/events.jsonl"));
  for (std::string line; std::getline(lines, line);)
    if (const auto event = json::parse(line); event["event"] == what) found.push_back(event);
  return found;
}

std::function<bool(const json&)> runs_since(double seconds) {
  return [seconds](const json& state) { return state.contains("progress") && state["progress"]["time_s"] > seconds; };
}

}  // namespace

TEST_CASE("live: a change by hand holds from the sample that it is stamped with, as a schedule's would, and rerun repeats it") {
  const Folder folder;
  const auto graph = folder.write("graph.yaml", graph_text("2 s")).string();
  LiveRun run(folder, graph, "run");
  REQUIRE_FALSE(run.state_when(runs_since(0.2)).is_null());
  REQUIRE(run.change("gain", "gain", "2.5").status == 200);
  const json state =
      run.state_when([](const json& now) { return !now["changes"].empty() && now["changes"][0]["status"] == "taken"; });
  REQUIRE(state.is_object());
  const auto position = state["changes"][0]["position"].get<std::int64_t>();
  CHECK(position >= 200);
  CHECK(position % 20 == 0);
  for (const auto& parameter : state["parameters"])
    if (parameter["block"] == "gain") CHECK(parameter["value"] == 2.5);
  REQUIRE(run.process().wait() == 0);

  const auto changes = events(folder, "run", "parameter changed");
  REQUIRE(changes.size() == 1);
  CHECK(changes[0]["by"] == "live");
  CHECK(changes[0]["block"] == "gain");
  CHECK(changes[0]["value"] == 2.5);
  CHECK(changes[0]["position"] == position);
  CHECK_THAT(run.process().output(), Contains("live: gain.gain = 2.5 from sample " + std::to_string(position) + " on"));
  CHECK_THAT(folder.read("run/log.txt"), Contains("gain.gain = 2.5 from sample"));

  const auto again = run_bodeflow({"rerun", "run", "--out", "again"}, folder.path());
  INFO(again.err);
  CHECK(again.exit_code == 0);
  const auto third = run_bodeflow({"rerun", "again", "--out", "third"}, folder.path());
  INFO(third.err);
  CHECK(third.exit_code == 0);
  CHECK(events(folder, "third", "parameter changed").size() == 1);

  const std::string schedule = "schedule: [{at: " + std::to_string(position) + " ms, block: gain, set: {gain: 2.5}}]\n";
  folder.write("scheduled.yaml", graph_text("2 s", schedule));
  REQUIRE(
      run_bodeflow({"run", "scheduled.yaml", "--set", "run.clock=simulated", "--out", "scheduled"}, folder.path()).exit_code ==
      0);
  const json hashes = read_json(folder, "run/manifest.json")["hashes"];
  CHECK(hashes.size() >= 2);
  CHECK(read_json(folder, "scheduled/manifest.json")["hashes"] == hashes);
  folder.write("plain.yaml", graph_text("2 s"));
  REQUIRE(run_bodeflow({"run", "plain.yaml", "--set", "run.clock=simulated", "--out", "plain"}, folder.path()).exit_code == 0);
  CHECK(read_json(folder, "plain/manifest.json")["hashes"] != hashes);
}

TEST_CASE("live: the state tells what runs") {
  const Folder folder;
  const auto graph = folder.write("graph.yaml", graph_text("1.5 s")).string();
  LiveRun run(folder, graph, "run");
  const json state = run.state_when([](const json& now) { return now["records"].size() == 1 && now["lateness"].is_object(); });
  INFO(run.process().output());
  REQUIRE(state.is_object());
  CHECK(state["title"] == "A gain by hand");
  CHECK(state["status"] == "running");
  CHECK(state["clock"] == "realtime");
  CHECK(state["progress"]["total_s"] == 1.5);
  CHECK(state["chunk_s"] == 0.02);
  REQUIRE(state["blocks"].size() == 3);
  CHECK(state["blocks"][1]["name"] == "gain");
  CHECK(state["blocks"][1]["type"] == "filters.gain");
  CHECK(state["blocks"][1]["rate_hz"] == 1000.0);
  CHECK(state["blocks"][1]["firings"].get<int>() >= 256);
  REQUIRE(state["streams"].size() == 3);
  CHECK(state["streams"][0]["from"] == "sine.out");
  CHECK(state["streams"][0]["to"] == "gain.in");
  CHECK(state["streams"][0]["unit"] == "V");
  CHECK(state["records"][0]["key"] == "response");
  CHECK(state["records"][0]["type"] == "frequency_response");
  CHECK(state["lateness"]["chunks"].get<int>() > 0);
  CHECK(state["lateness"]["bins"].size() == 22);
  std::vector<std::string> live;
  for (const auto& parameter : state["parameters"])
    live.push_back(parameter["block"].get<std::string>() + "." + parameter["parameter"].get<std::string>());
  CHECK(live == std::vector<std::string>{"sine.frequency", "sine.amplitude", "sine.offset", "gain.gain"});
  CHECK_THAT(run.get("/record?key=response").body, Contains("<svg") && Contains("Coherence") && Contains("Magnitude [dB]"));
  CHECK_THAT(run.get("/graph").body, Contains("data-block=\"1\""));
  CHECK_THAT(run.get("/").body, Contains("A gain by hand") && !Contains(run.token()));
  CHECK(run.process().wait() == 0);
}

TEST_CASE("live: the end is told before the process ends, and a run that nobody watches waits for nobody") {
  const Folder folder;
  const auto graph = folder.write("graph.yaml", graph_text("1 s")).string();
  LiveRun run(folder, graph, "run");
  const json end = run.state_when([](const json& now) { return now["ended"] == true; });
  REQUIRE(end.is_object());
  CHECK(end["status"] == "complete");
  CHECK(end["progress"]["time_s"] == 1.0);
  CHECK(run.get("/state?key=seen").status == 200);
  CHECK(run.process().wait() == 0);

  folder.write("quick.yaml", graph_text("1 s"));
  const auto quick =
      run_bodeflow({"run", "quick.yaml", "--set", "run.clock=simulated", "--live", "--out", "quick"}, folder.path());
  CHECK(quick.exit_code == 0);
  CHECK_THAT(quick.err, Contains("Live: http://127.0.0.1:"));
}

TEST_CASE("live: what can't be changed is refused with its reason, and the run goes on") {
  const Folder folder;
  const auto graph = folder.write("graph.yaml", graph_text("2 s")).string();
  LiveRun run(folder, graph, "run");
  REQUIRE_FALSE(run.state_when(runs_since(0.1)).is_null());
  const auto refused = [&](const std::string& block, const std::string& parameter, const std::string& value,
                           const std::string& why) {
    const Answer answer = run.change(block, parameter, value);
    CHECK(answer.status == 409);
    CHECK_THAT(answer.json().value("error", ""), Contains(why));
  };
  refused("gian", "gain", "2", "unknown block 'gian' (did you mean 'gain'?)");
  refused("gain", "gian", "2", "unknown parameter 'gian'");
  refused("sine", "sample_rate", "2 kHz", "can't change while the graph runs; live parameters: frequency, amplitude, offset");
  refused("gain", "gain", "much", "'much' is not a number");
  refused("sine", "frequency", "5 V", "parameter 'frequency'");
  refused("sine", "frequency", "-1", "at least 0");
  REQUIRE(run.change("sine", "frequency", "700 Hz").status == 200);  // within the range, but the block knows its rate
  const json state =
      run.state_when([](const json& now) { return !now["changes"].empty() && now["changes"][0]["status"] != "waiting"; });
  REQUIRE(state.is_object());
  CHECK(state["changes"][0]["status"] == "refused");
  CHECK(run.process().wait() == 0);
  CHECK(events(folder, "run", "parameter changed").empty());
  CHECK(events(folder, "run", "parameter not changed").size() == 1);
}

TEST_CASE("live: only who has the address of the command may change, and only from this machine's own page") {
  const Folder folder;
  const auto graph = folder.write("graph.yaml", graph_text("3 s")).string();
  LiveRun run(folder, graph, "run");
  REQUIRE_FALSE(run.state_when(runs_since(0.1)).is_null());
  const std::string here = "Host: 127.0.0.1:" + std::to_string(run.port()), token = "X-Bodeflow-Token: " + run.token();
  const std::string type = "Content-Type: application/json", origin = "Origin: http://127.0.0.1:" + std::to_string(run.port());
  const std::string body = json{{"generation", 1}, {"block", "gain"}, {"parameter", "gain"}, {"value", "9"}}.dump();
  CHECK(run.request("POST", "/change", {here, type}, body).status == 403);
  CHECK(run.request("POST", "/change", {here, type, "X-Bodeflow-Token: " + std::string(32, '0')}, body).status == 403);
  CHECK(run.request("POST", "/change", {here, type, token, "Origin: http://evil.example"}, body).status == 403);
  CHECK(run.request("POST", "/change", {here, type, token, "Origin: null"}, body).status == 403);
  CHECK(run.request("POST", "/change", {"Host: evil.example:" + std::to_string(run.port()), type, token}, body).status == 403);
  CHECK(run.request("GET", "/state", {"Host: evil.example"}).status == 403);
  CHECK(run.request("GET", "/state", {}).status == 403);
  CHECK(run.request("GET", "/state", {here, here}).status == 403);
  CHECK(run.request("POST", "/change", {here, "Content-Type: text/plain", token}, body).status == 415);
  CHECK(run.request("POST", "/change", {here, type, token, "Content-Encoding: gzip"}, body).status == 415);
  CHECK(run.request("GET", "/change", {here, token}).status == 404);
  for (const char* method : {"PUT", "DELETE", "PATCH", "OPTIONS", "HEAD"})
    CHECK(run.request(method, "/change", {here, type, token}, body).status == 405);
  for (const char* wrong : {"", "{", "[]", "7", "{\"generation\": 1}",
                            "{\"generation\": -1, \"block\": \"gain\", \"parameter\": \"gain\", \"value\": \"9\"}",
                            "{\"generation\": 1, \"block\": \"gain\", \"parameter\": \"gain\", \"value\": 9}"})
    CHECK(run.request("POST", "/change", {here, type, token}, wrong).status == 400);
  CHECK(run.request("POST", "/change", {here, type, token}, "{\"value\": \"" + std::string(20'000, '9') + "\"}").status != 200);
  CHECK(run.state()["changes"].empty());
  CHECK(run.request("POST", "/change", {here, type, token, origin}, body).status == 200);
  CHECK(run.process().wait() == 0);
  CHECK(events(folder, "run", "parameter changed").size() == 1);
}

TEST_CASE("live: nothing that is sent disturbs the run or keeps its process") {
  const Folder folder;
  const auto graph = folder.write("graph.yaml", graph_text("8 s")).string();
  LiveRun run(folder, graph, "run");
  REQUIRE_FALSE(run.state_when(runs_since(0.1)).is_null());
  const std::string host = "Host: 127.0.0.1:" + std::to_string(run.port()) + "\r\n", get = "GET / HTTP/1.1\r\n";
  std::string many;
  for (int i = 0; i < 3000; ++i) many += "X" + std::to_string(i) + ": y\r\n";
  std::string ranges = "Range: bytes=0-1";
  for (int i = 0; i < 1500; ++i) ranges += ",0-1";
  for (const std::string& bytes :
       {std::string("\0\0\0\0", 4), std::string(60'000, 'A'), "GET " + std::string(9'000, '/') + " HTTP/1.1\r\n\r\n",
        get + many + "\r\n", get + host + ranges + "\r\n\r\n", get + host + "Content-Length: 18446744073709551615\r\n\r\n",
        get + "Host\r\n\r\n",
        "POST /change HTTP/1.1\r\n" + host +
            "Content-Type: application/json\r\nTransfer-Encoding: chunked\r\n\r\nffffffffffff\r\n" + std::string(30'000, '{'),
        "POST /change HTTP/1.1\r\n" + host + "Content-Type: multipart/form-data; boundary=x\r\nContent-Length: 5\r\n\r\n--x--",
        "POST /change HTTP/1.1\r\n" + host + "Content-Type: application/json\r\nContent-Length: 400\r\n\r\n" +
            std::string(400, '['),
        get + host + "Expect: 100-continue\r\n\r\n", std::string("GET /record?key=%zz%00%ff HTTP/1.1\r\n") + host + "\r\n"})
    run.raw(bytes);
  CHECK(run.get("/").status == 200);
  std::vector<int> held;  // half a request each, never more
  for (int i = 0; i < 40; ++i) {
    held.push_back(run.hold("GET /state HTT"));
    REQUIRE(held.back() >= 0);
  }
  CHECK(run.process().wait() == 0);
  for (const int one : held) close(one);
  CHECK(read_json(folder, "run/manifest.json")["status"] == "complete");
}

TEST_CASE("live: a port that is taken is refused before the run begins") {
  const Folder folder;
  const auto graph = folder.write("graph.yaml", graph_text("2 s")).string();
  LiveRun run(folder, graph, "run");
  const std::string port = std::to_string(run.port());
  const auto second = run_bodeflow({"run", "graph.yaml", "--live=" + port, "--out", "second"}, folder.path());
  CHECK(second.exit_code == 5);
  CHECK_THAT(second.err, Contains("--live: port " + port + " of 127.0.0.1 is taken"));
  CHECK_FALSE(std::filesystem::exists(folder.path() / "second"));
  CHECK(run.process().wait() == 0);
  for (const char* wrong : {"0", "70000", "http", "-1"}) {
    const auto ended = run_bodeflow({"run", "graph.yaml", std::string("--live=") + wrong, "--out", "third"}, folder.path());
    CHECK(ended.exit_code == 2);
  }
}

TEST_CASE("live: over the machines of a lab it is refused by name; phases and sweeps are shown") {
  const Folder folder;
  folder.write("lab.yaml", graph_text("1 s", "hosts: {bench: [sine]}\n"));
  const auto lab = run_bodeflow({"run", "lab.yaml", "--live", "--loopback"}, folder.path());
  CHECK(lab.exit_code == 2);
  CHECK_THAT(lab.err, Contains("--live shows what this process runs") && Contains("--here"));

  LiveRun run(folder, BODEFLOW_SOURCE_DIR "/graphs/first_steps/phases.yaml", "phases");
  json last;
  const json end = run.state_when([&](const json& now) {
    last = now;
    return now["ended"] == true;
  });
  REQUIRE(end.is_object());
  CHECK(end["status"] == "complete");
  CHECK(end["records"].size() > 2);
  for (const auto& record : end["records"]) CHECK(run.get("/record?key=" + record["key"].get<std::string>()).status == 200);
  CHECK(run.process().wait() == 0);
}
